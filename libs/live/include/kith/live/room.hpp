#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/live/live_study.hpp"
#include "kith/live/room_event.hpp"
#include "kith/live/room_phase.hpp"
#include "kith/live/teaching_task.hpp"
#include "kith/teaching/observed_period.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// How a room is set up. It never changes.
struct RoomSetup {
  std::string id{};               ///< Unique among the rooms of a server.
  std::string code{};             ///< Typed in by people to join.
  std::string strategy{};         ///< A strategy of the study.
  std::string composition{};      ///< One letter of a learner type per member.
  std::vector<bool> simulated{};  ///< Per member; empty: all are people, or as `group.people` says.
  std::size_t replicate = 1;      ///< Streams are those of this replicate of the cell, see team_streams.hpp.
  std::string salt{};             ///< Secret of the server, for completion codes.
  /// Nobody is taught here: people are screened and wait until a group can be formed of them, see Room::next_group().
  /// Strategy and composition say nothing then.
  bool is_waiting_list = false;
  /// By which rules lessons are chosen, so that a room that was set up by older ones is replayed as it was: before 1
  /// starts were shown again (TeachingOptions::avoids_repeats); before 2 `plan` was another strategy and before 3
  /// `exam` another stop rule, so that rooms with them are refused, and members had banks of their own
  /// (TeachingOptions::shares_bank).
  std::size_t lessons = kLessonRules;
  static constexpr std::size_t kLessonRules = 3;

  friend bool operator==(const RoomSetup&, const RoomSetup&) = default;
};

[[nodiscard]] Json to_json(const RoomSetup& setup);
/// @throws kith::Error (kInvalidInput).
[[nodiscard]] RoomSetup room_setup(const Json& json);

/// A group that can be formed of people on a waiting list.
struct PlannedGroup {
  LiveCell cell;
  std::vector<bool> simulated;                    ///< By member: whether a simulated learner takes the place.
  std::vector<std::optional<std::size_t>> seats;  ///< By member: the seat of the person on the waiting list.
  friend bool operator==(const PlannedGroup&, const PlannedGroup&) = default;
};

/// {strategy, composition, simulated, seats}.
[[nodiscard]] Json to_json(const PlannedGroup& group);

/// Who is looking at a room.
struct Viewer {
  enum class Role { kParticipant, kObserver, kFacilitator };
  Role role = Role::kParticipant;
  std::size_t seat = 0;  ///< Of a participant, from 1.
};

/// One group of people and stand-ins being taught: a pure state machine without clock, input or output.
///
/// decide() says which events a command leads to, due() which events the clock demands; apply() makes them happen. The
/// state is that of the applied events and nothing else. Copies are cheap and independent. A room is not synchronised:
/// use it on one thread at a time.
///
/// Seats. Members are the places of the session, one per letter of the composition. Seats are people (or stand-ins),
/// numbered in the order of members and then of arrival: somebody who leaves keeps their number, and whoever takes over
/// gets a new one.
///
/// A period. Everybody watches the demonstrations at their own pace; once all active people have, the tests are asked;
/// once all of them have answered, everybody sees the feedback, while the teacher chooses the next lesson; once all
/// have continued and the lesson is there, the next period begins. Only active people are waited for: those who are
/// neither gone nor dropped.
class Room {
 public:
  /// @throws kith::Error (kInvalidInput) if the study has no such strategy or letter, the composition and the list of
  /// simulated members differ in length, or the baseline, which teaches one person, is to teach several.
  /// @param cache  of the study's atlas.
  Room(std::shared_ptr<const LiveStudy> study, RoomSetup setup, TeachingCache& cache);

  [[nodiscard]] const RoomSetup& setup() const noexcept;
  [[nodiscard]] const LiveStudy& study() const noexcept;
  [[nodiscard]] RoomStage stage() const noexcept;
  /// Number of the last applied event; 0: none.
  [[nodiscard]] std::uint64_t seq() const noexcept;
  /// The session as it is now. @pre holds_session()
  [[nodiscard]] const Session& session() const noexcept;
  /// Whether the session is in memory: until release().
  [[nodiscard]] bool holds_session() const noexcept;
  /// Gives back the memory of what only teaching needs, which is most of it: the session with its beliefs and the
  /// simulated learners. Views, the digest, and what commands and events lead to stay the same. Does nothing while the
  /// group may still be taught.
  void release();
  [[nodiscard]] std::size_t num_seats() const noexcept;
  [[nodiscard]] bool is_person(std::size_t seat) const;
  /// The boards of an exam that the person of a seat has answered.
  [[nodiscard]] const std::vector<ObservedPeriod>& exam_of(std::size_t seat) const;
  /// Who has a place of the session, from 0; nothing while nobody does.
  [[nodiscard]] std::optional<std::size_t> seat_of(std::size_t member) const;
  /// Whether somebody could join now.
  [[nodiscard]] bool has_free_seat() const;
  /// Whether the person has reached a last page: nothing more is expected of them.
  [[nodiscard]] bool is_done(std::size_t seat) const;
  /// The stage in docs/live-protocol.md: "consent", "check", "screening", "lobby", "watch", "predict", "wait",
  /// "feedback", "questions", "debrief", "declined", "ended", "replaced", "full". Empty for stand-ins.
  [[nodiscard]] std::string stage_of(std::size_t seat) const;
  /// Whether somebody still takes part, and how it ended for them: "empty", "active", "finished", "left", "dropped"
  /// (was away for too long), "replaced", "withdrawn", "ended" (with the room, before its time), "declined", "full" or
  /// "moved" (from the waiting list to a group); "simulated" for stand-ins.
  [[nodiscard]] std::string status_of(std::size_t seat) const;
  /// Whether the person's page has a completion code.
  [[nodiscard]] bool shows_code(std::size_t seat) const;

  /// Which events a command leads to. Changes nothing. A command that was accepted before in the same state (the same
  /// answer again) gives neither events nor a refusal. Never throws for what people send.
  [[nodiscard]] Decision decide(const RoomCommand& command, std::int64_t now_us) const;
  /// What is due by the clock, at most one step: call again after applying it.
  [[nodiscard]] std::vector<RoomEvent> due(std::int64_t now_us) const;
  /// When something will be due if nothing happens before.
  [[nodiscard]] std::optional<std::int64_t> next_due() const;

  /// The lesson that the room waits for, or will need next. While there is a task nothing else advances the period.
  [[nodiscard]] std::optional<TeachingTask> teaching() const;
  /// Lessons that are likely to be needed soon.
  [[nodiscard]] std::vector<TeachingTask> likely_teaching() const;
  /// The event that a lesson was chosen. @throws std::invalid_argument unless its key is that of teaching().
  [[nodiscard]] RoomEvent taught(const TaughtLesson& lesson, std::int64_t now_us) const;

  /// Makes an event happen, as a whole or, if this throws, not at all.
  /// @param cache  of the study's atlas; changes no result.
  /// @param lesson  of a "lesson" event, if it is at hand; otherwise it is computed again, and its digest compared.
  /// @throws kith::Error (kMismatch) if the event is not one that this state can have led to: a wrong number, a time
  /// before the last event, an unknown type, a refused command, another digest.
  void apply(const RoomEvent& event, TeachingCache& cache, const TaughtLesson* lesson = nullptr);

  /// The group that the waiting list forms next; nothing if this room is none, or none can be formed.
  ///
  /// A place of a type in `group.screening.high` is for people whose estimate of ability is at least
  /// `group.screening.cut`, every other place for the others; of those who fit, whoever has waited for longest takes
  /// it. Groups are of the cells of the design, live_cells(), that have the fewest groups so far. Once somebody has
  /// waited for `group.time.lobby_s` they may be of any cell with a place for that person and, with the policy
  /// "simulate", simulated learners take the places that nobody fits. Without a limit on waiting, groups may always be
  /// of any cell, those with the fewest groups first.
  [[nodiscard]] std::optional<PlannedGroup> next_group(std::int64_t now_us) const;
  /// When more groups are possible on the waiting list because somebody has waited for too long; nothing if nobody
  /// waits or waiting has no limit.
  [[nodiscard]] std::optional<std::int64_t> last_call() const;
  /// What a room has to know of a person on this waiting list who is given a place there: the body of a command "seat",
  /// without the member. @param seat  from 1.
  [[nodiscard]] Json person_for(std::size_t seat) const;

  /// What somebody sees. Participants: ParticipantView. Facilitators and observers: {"row": RoomRow, "room":
  /// RoomDetail}, without links, and for observers without names and codes.
  [[nodiscard]] Json view(const Viewer& viewer, std::int64_t now_us) const;
  /// The facilitator's row of this room: {id, code, stage, strategy, seats, period, component, ...}.
  [[nodiscard]] Json row(const Viewer& viewer) const;

  /// Digest of the whole state, to compare a replay with the original.
  [[nodiscard]] std::string digest() const;

  struct State;

 private:
  std::shared_ptr<const LiveStudy> study_;
  std::shared_ptr<const RoomSetup> setup_;
  std::shared_ptr<const State> state_;  // never changed in place, so copies share it
};

/// The state that events lead to. @throws kith::Error as Room::apply().
[[nodiscard]] Room replay(std::shared_ptr<const LiveStudy> study, RoomSetup setup, std::span<const RoomEvent> events,
                          TeachingCache& cache);

}  // namespace kith
