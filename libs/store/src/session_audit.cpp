#include "kith/store/session_audit.hpp"

#include <set>
#include <utility>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/live/room_audit.hpp"
#include "kith/store/session_review.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/audit_people.hpp"

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
  auto left = file.count_events(stored.number);
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

}  // namespace

SessionAudit audit_session(EventFile file, const SessionAuditOptions& options) {
  SessionAudit result{restore_session_study(file.identity().inputs).study, {}};
  auto judged = *result.study;  // rooms replay as they were
  auto& teaching = judged.spec.teaching;
  if (auto known = options.known ? options.known(*judged.atlas) : std::nullopt) teaching.known = std::move(known);
  auto& report = result.report;
  report.source = options.source;
  report.options = audit_options(teaching, options.forgetting);

  TeachingCache cache{result.study->atlas};
  const auto withdrawn = withdrawn_seats(file);
  const auto rooms = options.room.empty() ? file.rooms() : std::vector{find_room(file, options.room)};
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (options.on_progress) options.on_progress(i, rooms.size());
    auto room = taught_in(file, rooms[i], result.study, cache);
    for (auto& person : audit_room(cache, judged, room.setup, std::move(room.people), options.forgetting)) {
      if (withdrawn.count({rooms[i].number, person.seat}) != 0) continue;
      report.people.push_back(std::move(person));
    }
  }
  if (report.people.empty()) {
    throw refusal(ErrorKind::kInfeasible, "E1115", "no room of " + options.source + " has had a lesson yet",
                  "kith session list shows how far the rooms are");
  }
  return result;
}

}  // namespace kith
