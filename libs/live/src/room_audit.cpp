#include "kith/live/room_audit.hpp"

#include <algorithm>
#include <utility>

#include "kith/explain/curriculum.hpp"
#include "kith/explain/examination.hpp"
#include "kith/study/audit_people.hpp"

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

Json person_json(const Atlas& atlas, const AuditedPerson& person) {
  const auto& audit = person.audit;
  Json json{{"seat", person.seat},
            {"member", person.member},
            {"tests", audit.agreement.tests},
            {"right", audit.agreement.right},
            {"knows", *audit.knowledge()},
            {"components", Json::array()}};
  for (const auto& one : audit.components) {
    json["components"].push_back(
        {{"name", component_in_words(atlas, one.component)},
         {"understanding", name_of(one.understanding)},
         {"verdict", verdict_in_words(one)},
         {"level", one.understanding == Understanding::kNotTaught ? Json{} : Json(one.level.mean)}});
  }
  std::size_t boards = 0;
  for (const auto& one : audit.components) boards = std::max(boards, one.examined);
  if (boards > 0) json["exam"] = name_of(exam_result(audit));
  const auto need = person.simulated ? std::string{} : need_in_words(audit);
  if (!need.empty()) json["needs_help"] = need;
  if (const auto* misconception = likeliest(audit)) {
    json["thinks"] = misconception->thinks;
    json["probability"] = misconception->probability;
  }
  if (person.kinds.empty()) return json;
  json["kind"] = kind_word(person.kinds);
  for (const auto& [kind, probability] : person.kinds) json["kinds"][kind] = probability;
  return json;
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
    if (person.audit.knowledge()) list.push_back(person_json(atlas, person));
  }
  return list;
}

}  // namespace kith
