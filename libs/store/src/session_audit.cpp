#include "kith/store/session_audit.hpp"

#include <utility>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/live/taught_people.hpp"
#include "kith/store/session_review.hpp"
#include "kith/store/session_study.hpp"
#include "kith/teaching/kind_of_person.hpp"

namespace kith {
namespace {

Error refusal(ErrorKind kind, const std::string& id, const std::string& message, const std::string& hint) {
  return Error{
      kind, message, {{.id = id, .message = message, .hint = hint, .infeasible = kind == ErrorKind::kInfeasible}}};
}

struct TaughtRoom {
  RoomSetup setup;
  std::vector<TaughtPerson> people;  // nobody as long as there was no lesson
};

TaughtRoom taught_in(EventFile& file, const StoredRoom& stored, const std::shared_ptr<const LiveStudy>& study,
                     TeachingCache& cache) {
  std::size_t left = 0;
  file.for_each_event([&](const StoredEvent&) { ++left; }, stored.number);
  TaughtRoom result;
  TaughtPeople taught;
  const auto replayed = replay_room(file, stored, study, cache, [&](const Room& room, const RoomEvent&) {
    taught.see(room);
    if (--left == 0 && !room.session().history().empty()) result = {room.setup(), taught.all(room)};
  });
  if (!replayed.problem.empty()) {
    throw refusal(ErrorKind::kMismatch, "E1614",
                  "room " + replayed.id + " does not replay to what it was: " + replayed.problem,
                  "use the version of kith and the kind of machine that the session was run with");
  }
  return result;
}

std::vector<AuditedPerson> judged(const TaughtRoom& room, TeachingCache& cache, const AuditOptions& options,
                                  const TeachingOptions& teaching) {
  const auto& [setup, taught] = room;
  const auto random = RandomStream{1}.split("audit").split(std::uint64_t{0}).split(setup.id);
  std::vector<std::vector<ObservedPeriod>> periods;
  for (const auto& one : taught) periods.push_back(one.periods);
  auto audits = Auditor{cache, options}.audit_group(periods, random);
  std::vector<AuditedPerson> people;
  for (std::size_t i = 0; i < taught.size(); ++i) {
    AuditedPerson person;
    person.room = setup.id;
    person.group = "room " + setup.id + " (" + setup.strategy + ", " + setup.composition + ")";
    person.member = taught[i].member + 1;
    person.seat = taught[i].seat;
    person.type = setup.composition.at(taught[i].member);
    person.simulated = !taught[i].is_person;
    person.audit = std::move(audits[i]);
    if (teaching.hypotheses_about == HypothesesAbout::kKinds) {
      person.kinds = kinds_after(cache, teaching, taught[i].periods, random.split("kinds").split(i));
    }
    people.push_back(std::move(person));
  }
  return people;
}

}  // namespace

SessionAudit audit_session(EventFile file, const SessionAuditOptions& options) {
  SessionAudit result{restore_session_study(file.identity().inputs).study, {}};
  const auto& teaching = result.study->spec.teaching;
  auto& report = result.report;
  report.source = options.source;
  report.options.bank.filter = teaching.filter;
  report.options.bank.likelihood = teaching.likelihood;
  report.options.forgetting = options.forgetting;

  TeachingCache cache{result.study->atlas};
  const auto rooms = options.room.empty() ? file.rooms() : std::vector{find_room(file, options.room)};
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (options.on_progress) options.on_progress(i, rooms.size());
    const auto room = taught_in(file, rooms[i], result.study, cache);
    if (room.people.empty()) continue;
    for (auto& person : judged(room, cache, report.options, teaching)) report.people.push_back(std::move(person));
  }
  if (report.people.empty()) {
    throw refusal(ErrorKind::kInfeasible, "E1115", "no room of " + options.source + " has had a lesson yet",
                  "kith session list shows how far the rooms are");
  }
  return result;
}

}  // namespace kith
