#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kith/geometry/half_space.hpp"
#include "kith/live/room.hpp"
#include "kith/live/world_json.hpp"
#include "kith/teaching/observed_period.hpp"
#include "views.hpp"

namespace kith {

/// How far a person has come on the way to the lobby.
enum class Readiness { kConsent, kCheck, kScreening, kReady };

enum class SeatStatus {
  kEmpty,    ///< Nobody came yet.
  kActive,   ///< The group counts on them.
  kDropped,  ///< Away for too long; they take part again when they return.
  kGone,     ///< For good, unless a facilitator readmits them.
};

/// A person's path in answer to one test.
struct GivenPath {
  std::vector<std::size_t> actions;
  bool for_ever = false;
  bool is_finished = false;
  Answer counts{};
  std::int64_t ms = 0;
};

/// A prediction on the board of a discussion: what one or several members answered.
struct BoardAnswer {
  GivenPath path;
  std::vector<std::size_t> members;
};

/// What somebody does about their answer in a discussion: takes that of the board, or keeps the own one.
struct BoardChoice {
  std::optional<std::size_t> entry{};
  friend bool operator==(const BoardChoice&, const BoardChoice&) = default;
};

/// A person or a stand-in.
struct LiveSeat {
  bool is_person = true;
  char type = 'N';
  std::optional<std::size_t> member;  ///< Whose place they have or had; none: on a waiting list.
  SeatStatus status = SeatStatus::kEmpty;
  Readiness readiness = Readiness::kConsent;
  std::string last_page;     ///< Of who is gone: declined, ended, replaced or full.
  std::string why;           ///< Of who is gone: a stable word.
  bool had_dropped = false;  ///< Of who is gone: the group went on without them before.
  bool gets_code = false;
  bool is_here = false;
  std::int64_t presence_us = 0;  ///< Since when they are here or away.
  std::int64_t joined_us = 0;
  std::int64_t ready_us = 0;
  std::int64_t since_us = 0;  ///< When they last finished something.
  std::string name;
  Json query;
  std::vector<bool> screened;  ///< Whether each answer so far was right.

  // Of the current period.
  bool in_period = false;       ///< Takes part in it.
  bool has_taken_part = false;  ///< In this period or an earlier one.
  std::size_t watched = 0;
  std::vector<std::optional<GivenPath>> paths;  ///< Per test.
  bool has_answered = false;                    ///< All tests, or the time is over.
  std::vector<std::size_t> draft;               ///< Of the first test without a path.
  bool has_continued = false;
  std::vector<std::optional<BoardChoice>> choices;    ///< Per test; none: undecided. Empty before a discussion.
  std::shared_ptr<const view::Explored> exploration;  ///< What was explored last; null: nothing yet.

  std::vector<HalfSpace> explored;  ///< What all explorations conveyed, each once.
  std::size_t explorations = 0;

  std::vector<ObservedPeriod> exam;    ///< Boards that were answered.
  std::optional<StartIndex> examined;  ///< The board that is asked now; none: no exam, or it is over.
  bool has_answered_questions = false;
  std::size_t right = 0;
  std::size_t tests = 0;
};

/// A place of the session.
struct LiveMember {
  std::optional<std::size_t> seat;         ///< Index into the seats; none: nobody has the place.
  bool is_away = false;                    ///< As the session sees it.
  bool is_new = false;                     ///< Taken over by somebody who takes part from the next lesson on.
  bool is_newcomer = false;                ///< And who has not been taught before.
  std::shared_ptr<const Learner> learner;  ///< Of a stand-in.
  Learner::Response response;              ///< To the tests of the current lesson.
  std::vector<Answer> revised;             ///< Of a stand-in, after the discussion of these; empty: keeps all.
};

struct LiveNotice {
  std::string text;
  std::int64_t at_us = 0;
  std::optional<std::size_t> seat;  ///< Index; none: everybody.
};

/// What a facilitator sees of an answer.
struct LiveAnswer {
  std::size_t seat = 0;  ///< Index.
  std::size_t period = 0;
  std::size_t test = 0;
  bool right = false;
  double regret = 0.0;
  std::int64_t ms = 0;
  bool stopped_short = false;
  std::optional<bool> right_in_the_end{};  ///< After a discussion.
  bool changed = false;                    ///< Whether it was given up in a discussion.
};

/// Knowledge at the end of a period.
struct LiveCurvePoint {
  std::size_t period = 0;
  std::vector<std::pair<std::string, double>> p_bec;  ///< By belief.
  std::vector<std::pair<std::size_t, double>> right;  ///< By seat (index).
};

struct SessionSummary;

struct Room::State {
  std::uint64_t seq = 0;
  std::int64_t last_us = 0;
  RoomPhase phase = RoomPhase::kLobby;
  std::int64_t phase_us = 0;
  std::vector<LiveSeat> seats;
  std::vector<LiveMember> members;

  std::shared_ptr<const Session> session;
  std::shared_ptr<const SessionSummary> summary;  ///< In place of the session, once that was released.
  // From the proposal of a lesson until its feedback: what was before, should the lesson be of no use any more.
  std::shared_ptr<const Session> before;
  std::vector<LiveMember> members_before;
  std::optional<StrategyChoice> next_strategy;  ///< From the next component on.

  std::optional<std::int64_t> lobby_us;  ///< When the first person was ready.
  std::optional<std::int64_t> started_us;
  std::optional<std::int64_t> ended_us;
  std::optional<std::int64_t> deadline_us;  ///< Of the phase.
  std::optional<std::int64_t> session_deadline_us;
  std::optional<std::int64_t> paused_us;   ///< By the facilitator.
  std::int64_t period_us = 0;              ///< When the period began.
  std::vector<std::int64_t> durations_us;  ///< Of the periods so far.
  std::string
      end_reason;  ///< Once teaching is over: complete, skipped, max-periods, time-limit, or why it ended early.
  std::string end_text;
  bool has_extra = false;                     ///< Whether a time limit was extended.
  std::map<std::string, std::size_t> groups;  ///< Of a waiting list, how many were formed: by "strategy/composition".

  std::vector<std::vector<BoardAnswer>> board;  ///< Of a discussion: per test, in the order of the paths.

  std::vector<LiveNotice> notices;
  std::vector<LiveAnswer> answers;
  std::vector<LiveCurvePoint> curves;
  std::shared_ptr<const std::vector<RunnerUp>> runners_up;
};

/// A room as its parts see it.
struct RoomParts {
  const LiveStudy& study;
  const RoomSetup& setup;
  const Room::State& state;
};

inline constexpr std::int64_t kSecond = 1'000'000;  // microseconds

// --- what holds in a state -------------------------------------------------------------------------------------------

/// Whether the group waits for the person in the current period.
[[nodiscard]] bool gates(const LiveSeat& seat) noexcept;
/// Whether the person has done their part of the current phase.
[[nodiscard]] bool has_done_phase(const Room::State& state, const LiveSeat& seat) noexcept;
/// People with a place who are neither gone nor dropped.
[[nodiscard]] std::size_t num_active_people(const Room::State& state) noexcept;
/// Whether the place has somebody whom the next lesson is for.
[[nodiscard]] bool is_taken(const Room::State& state, const LiveMember& member) noexcept;
[[nodiscard]] bool is_running(const Room::State& state) noexcept;
/// The word of a person's page, see Room::stage_of().
[[nodiscard]] std::string stage_of_seat(const RoomParts& room, const LiveSeat& seat);
/// The word of Room::status_of().
[[nodiscard]] std::string status_of_seat(const RoomParts& room, const LiveSeat& seat);
/// The test that a person works on: the first without a path. @pre not all are given.
[[nodiscard]] std::size_t current_test(const LiveSeat& seat) noexcept;
/// In a discussion, the test that a person is asked about: the first without a choice. @pre not all have one.
[[nodiscard]] std::size_t current_choice(const LiveSeat& seat) noexcept;
/// Which prediction of the board is that of a member; none if it is not there.
[[nodiscard]] std::optional<std::size_t> own_entry(const Room::State& state, std::size_t test, std::size_t member);
/// What the members answer if those who have not decided keep their answers, as Session::discuss() takes it.
[[nodiscard]] std::vector<std::vector<Answer>> revised_answers(const Room::State& state);
/// The address of the room's streams.
[[nodiscard]] TeamAddress address_of(const RoomSetup& setup);
/// Which members of a group of that size are simulated, as `group.people` says.
[[nodiscard]] std::vector<bool> simulated_members(const LiveStudy& study, std::size_t members);

// --- the waiting list ------------------------------------------------------------------------------------------------

/// Whether the estimate of a person's ability is high. @pre they have finished the screening.
[[nodiscard]] bool has_high_estimate(const RoomParts& room, const LiveSeat& seat);
/// Whether groups of a cell have a place for people of high or of low ability.
[[nodiscard]] bool has_place_for(const LiveStudy& study, const LiveCell& cell, bool high);
/// See Room::next_group().
[[nodiscard]] std::optional<PlannedGroup> next_group_in(const RoomParts& room, std::int64_t now_us);
/// When the time of whoever has waited for longest is over: more groups are possible from then on. Nothing if waiting
/// has no limit.
[[nodiscard]] std::optional<std::int64_t> last_call_in(const RoomParts& room);
/// For how long anybody waits on the list, in microseconds; 0: without limit.
[[nodiscard]] std::int64_t longest_wait_us(const RoomParts& room);

// --- what may happen -------------------------------------------------------------------------------------------------

/// See Room::decide().
[[nodiscard]] Decision decide_in(const RoomParts& room, const RoomCommand& command, std::int64_t now_us);
/// The part of facilitators.
[[nodiscard]] Decision decide_facilitator(const RoomParts& room, const RoomCommand& command, std::int64_t now_us);

/// An event that the clock demands from a moment on.
struct ClockEvent {
  std::int64_t at_us = 0;
  RoomEvent event;
};
/// All of them, in the order in which they are dealt with if several are due.
[[nodiscard]] std::vector<ClockEvent> clock_events(const RoomParts& room);

// --- what happens ----------------------------------------------------------------------------------------------------

/// The state after an event that decide(), due() or taught() led to. @param lesson  of a "lesson" event.
[[nodiscard]] Room::State state_after(const RoomParts& room, const RoomEvent& event, TeachingCache& cache,
                                      const TaughtLesson* lesson);
/// See Room::teaching().
[[nodiscard]] std::optional<TeachingTask> next_task(const std::shared_ptr<const LiveStudy>& study,
                                                    const RoomSetup& setup, const Room::State& state,
                                                    std::vector<SessionEvent> ahead);

}  // namespace kith
