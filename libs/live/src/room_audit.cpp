#include "kith/live/room_audit.hpp"

#include <algorithm>
#include <utility>

#include "kith/explain/curriculum.hpp"
#include "kith/explain/examination.hpp"
#include "kith/study/audit_people.hpp"
#include "message_json.hpp"
#include "views.hpp"

namespace kith {
namespace {

// The misconception that is most probable; null if none is named.
const LikelyMisconception* likeliest(const PersonAudit& audit) {
  const LikelyMisconception* most = nullptr;
  for (const auto& one : audit.components) {
    if (one.misconception && (most == nullptr || one.misconception->probability > most->probability)) {
      most = &*one.misconception;
    }
  }
  return most;
}

view::KnownPerson known_person(const Atlas& atlas, const AuditedPerson& person) {
  const auto& audit = person.audit;
  view::KnownPerson known;
  known.at<"seat">() = person.seat;
  known.at<"tests">() = audit.agreement.tests;
  known.at<"right">() = audit.agreement.right;
  known.at<"knows">() = *audit.knowledge();
  std::size_t boards = 0;
  for (const auto& one : audit.components) {
    const bool is_taught = one.understanding != Understanding::kNotTaught;
    known.at<"components">().push_back({component_in_words(atlas, one.component), verdict_in_words(one),
                                        is_taught ? std::optional{one.level.mean} : std::nullopt});
    boards = std::max(boards, one.examined);
  }
  if (boards > 0) known.at<"exam">() = name_of(exam_result(audit));
  if (!person.simulated) known.at<"needs_help">() = need_in_words(audit);
  if (const auto* misconception = likeliest(audit)) {
    known.at<"thinks">() = misconception->thinks;
    known.at<"probability">() = misconception->probability;
  }
  if (!person.kinds.empty()) known.at<"kind">() = kind_word(person.kinds);
  for (const auto& [kind, probability] : person.kinds) known.at<"kinds">()[kind] = probability;
  return known;
}

}  // namespace

std::vector<AuditedPerson> audit_room(TeachingCache& cache, const LiveStudy& study, const RoomSetup& setup,
                                      std::vector<TaughtPerson> people, double forgetting) {
  std::vector<ObservedPerson> group;
  for (auto& taught : people) {
    AuditedPerson person;
    person.room = setup.id;
    person.group = "room " + setup.id + " (" + setup.strategy + ", " + setup.composition + ")";
    person.member = taught.member + 1;
    person.seat = taught.seat;
    person.type = setup.composition.at(taught.member);
    person.simulated = !taught.is_person;
    group.push_back({std::move(person), std::move(taught.periods)});
  }
  return audit_people(cache, study.spec.teaching, forgetting, std::move(group));
}

Json people_json(const Atlas& atlas, const std::vector<AuditedPerson>& people) {
  Json list = Json::array();
  for (const auto& person : people) {
    if (person.audit.knowledge()) list.push_back(written(known_person(atlas, person)));
  }
  return list;
}

}  // namespace kith
