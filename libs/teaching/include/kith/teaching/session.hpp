#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kith/belief/team_belief.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/session_event.hpp"
#include "kith/teaching/strategy.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "kith/teaching/team_bank.hpp"

namespace kith {

/// How a session stands or ended; of several sessions of a team, the last of theirs counts.
enum class SessionStatus : std::uint8_t {
  kRunning,
  kComplete,    ///< Every component was learned, or is implied by the lessons of others or left out by Scaffold::kNone.
  kSkipped,     ///< Of some components something is open that nothing could show; the others were learned.
  kMaxPeriods,  ///< TeachingOptions::max_periods came before.
};
/// "running", "complete", "skipped" or "max_periods".
[[nodiscard]] std::string_view name_of(SessionStatus status) noexcept;

/// What a session waits for.
enum class SessionPhase {
  kProposal,  ///< propose()
  kLesson,    ///< show()
  kTests,     ///< answer(), discuss(), close_tests()
  kFeedback,  ///< give_feedback()
  kFinished,  ///< nothing
};

enum class ComponentStatus { kOpen, kLearned, kSkipped };

/// One group being taught: a pure state machine. It does no input or output and
/// never waits; whoever drives it brings the answers of simulated learners or of
/// people. An interaction period:
///
///   while (session.propose(cache)) {                        // chooses the lesson; false: nothing is left to teach
///     session.show();                                       // lesson().demonstrations were watched
///     for each member: session.answer(member, answers);     // to lesson().tests
///     session.discuss(revised);                             // only in groups that talk about their answers
///     session.close_tests();
///     session.give_feedback();
///   }
///
/// Each of these is an event. An event is accepted as a whole or, if it throws, changes nothing: kith::Error
/// (kInvalidInput) for what people can get wrong, such as an answer of the wrong length, and kith::Error (kUsage) for
/// an event that the phase does not allow. events() lists what was accepted; apply() repeats it. Equal streams and
/// events give equal sessions, bit for bit, whatever cache is used and whatever that has served before.
///
/// A value: a copy goes on independently, which is how to look ahead. Between calls it may move to another thread. It
/// keeps the atlas alive if the cache does.
///
/// Each knowledge component is taught until all members present answer all tests of a
/// period correctly, or as TeachingOptions::mastery says; a component is skipped if nothing that could be shown cuts
/// the taught region any further (UnitSelector::complete()); another one is never left early before max_periods. Seats
/// do not matter: members are told apart by their streams only.
///
/// What an answer tells the teacher. A wrong one: the half-space of weights under which its path is better than the
/// robot's. A right one with the feature counts of the robot's path: the taught constraints that the test covers. A
/// right one with other feature counts (the robot is indifferent between the two) may be taken for any reason, so it
/// tells nothing.
///
/// Groups that talk. Once everybody has answered, discuss() tells what members answer after they saw the answers of
/// the others. What ends a component, the rules of aggregation, the bank of hypotheses and PastPeriod::answers go by
/// the first answers, which members gave on their own. What a revised answer shows beyond the member's own first
/// answers is evidence about this member only: whoever was copied is not believed the more for it.
///
/// A member who leaves during a period has no more part in it, except that answers already given count; who returns
/// takes part from the next lesson on, and so does whoever takes the place of a member who left: then the teacher's
/// belief about the member, and about what all members know, is the prior again. While everybody is away nothing can be
/// proposed. TeachingOptions::release may
/// send members away until the next component begins; that is part of the session and no event.
class Session {
 public:
  /// @param cache  of the session's atlas; only its cover of the prior is used here.
  /// @param persons  one stream per member: the root of what the teacher draws for that person.
  /// @param teacher  the root of all else the teacher draws.
  /// @throws std::invalid_argument if there are no members or more than 30, the strategy is the baseline and
  /// there are several members, an option is out of range, or the strategy needs a rule that is not among the options'.
  Session(TeachingCache& cache, TeachingOptions options, StrategyChoice strategy, std::vector<RandomStream> persons,
          RandomStream teacher);

  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }
  [[nodiscard]] const TeachingOptions& options() const noexcept { return options_; }
  [[nodiscard]] std::size_t num_members() const noexcept { return persons_.size(); }
  [[nodiscard]] const StrategyChoice& strategy() const noexcept { return choice_; }
  [[nodiscard]] SessionStatus status() const noexcept { return status_; }
  [[nodiscard]] SessionPhase phase() const noexcept { return phase_; }
  [[nodiscard]] bool finished() const noexcept { return phase_ == SessionPhase::kFinished; }
  /// Completed periods.
  [[nodiscard]] std::size_t periods() const noexcept { return history_.size(); }
  [[nodiscard]] const PastPeriods& history() const noexcept { return history_; }
  [[nodiscard]] std::span<const ComponentStatus> components() const noexcept { return components_; }

  // --- events ---------------------------------------------------------------
  /// Chooses the next lesson of the current component, or of the first later one that has anything to teach.
  /// @param cache  of the same atlas; makes it faster and changes no result.
  /// @param truth  the members as they are, which only simulations know, for strategies that ask for it; may be empty.
  /// A session that was proposed to with a truth is repeated by apply() only if the strategy does not ask for it.
  /// @return false: nothing is left to teach; the session is finished. Also if it was finished before.
  bool propose(TeachingCache& cache, std::span<const MemberTruth> truth = {});
  void show();
  /// @throws kith::Error (kInvalidInput) unless there is one answer per test, the member takes part and has not
  /// answered yet, and no answer earns more than the robot's optimal behaviour, which no path can.
  void answer(std::size_t member, std::vector<Answer> answers);
  /// What members answer after they have seen each other's answers; no first answers are taken any more.
  /// @param revised  per member: one answer per test, or none at all for who keeps all answers.
  /// @throws kith::Error (kInvalidInput) unless whoever revises answers has given some, and as answer(); (kUsage)
  /// unless at least two members have answered and nothing was discussed yet.
  void discuss(std::vector<std::vector<Answer>> revised);
  /// Whether the answers to the current tests have been discussed.
  [[nodiscard]] bool has_discussed() const noexcept { return !revised_.empty(); }
  /// @return what give_feedback() will tell.
  const Feedback& close_tests();
  const Feedback& give_feedback();
  void leave(std::size_t member);
  void come_back(std::size_t member);
  /// Somebody else takes the place of a member who is away.
  void replace(std::size_t member);
  /// Lessons are chosen by another strategy from now on, which begins anew: what the one before remembered is lost.
  /// @throws kith::Error (kUsage) unless the next lesson is to be proposed; std::invalid_argument as the constructor,
  /// also if beliefs that the strategy reads were not kept from the beginning (TeachingOptions::keep_members and
  /// keep_rules).
  void change_strategy(StrategyChoice strategy);
  /// Repeats an event.
  void apply(const SessionEvent& event, TeachingCache& cache);
  /// What was accepted so far, in order.
  [[nodiscard]] const SessionEvents& events() const noexcept { return events_; }

  /// A whole period at once: show(), everybody's answers, close_tests(), give_feedback(). One list per member with one
  /// answer per test of lesson(), in order; lists of members who are away are ignored.
  const Feedback& submit(std::span<const std::vector<Answer>> answers);

  // --- state ----------------------------------------------------------------
  /// What to show and ask now. @throws kith::Error (kUsage) in the phases kProposal and kFinished.
  [[nodiscard]] const Lesson& lesson() const;
  /// Whether a member takes part in the current period.
  [[nodiscard]] bool takes_part(std::size_t member) const { return attendance_.at(member) == Attendance::kPresent; }
  /// Whether a member has answered the current tests.
  [[nodiscard]] bool has_answered(std::size_t member) const { return pending_.at(member).has_value(); }
  /// The first answers of a member to the current tests. @pre has_answered(member)
  [[nodiscard]] const std::vector<Answer>& answers(std::size_t member) const {
    return pending_.at(member).value().answers;
  }
  /// What the teacher believes about the team.
  [[nodiscard]] const TeamBelief& belief() const noexcept { return belief_; }
  /// Who the members may be, if the options, the strategy or the stopping rule ask for it; null otherwise.
  [[nodiscard]] const TeamBank* bank() const noexcept { return bank_ ? &*bank_ : nullptr; }
  /// What TeachingOptions::mastery went by when tests were closed last, StopVerdict::level; 0 before.
  [[nodiscard]] double level_of_mastery() const noexcept { return level_; }
  /// R_n at the end of the last learned component: minimal, with the prior; sorted.
  [[nodiscard]] const std::vector<HalfSpace>& taught_region() const noexcept { return taught_before_; }

  /// The same state, bit for bit, of sessions with the same atlas, options, strategy and streams.
  friend bool operator==(const Session& a, const Session& b);

 private:
  enum class Attendance : std::uint8_t { kPresent, kAway, kReturning, kReleased };
  struct Given {
    std::vector<Answer> answers;
    std::vector<Verdict> verdicts;
    friend bool operator==(const Given&, const Given&) = default;
  };
  struct Prepared;

  [[nodiscard]] bool teaches_whole() const noexcept;
  void require_phase(SessionPhase phase, std::string_view what) const;
  void require_away(std::size_t member, std::string_view what) const;
  void require_seat(std::size_t member) const;
  [[nodiscard]] Given judged(std::size_t member, std::vector<Answer> answers) const;
  [[nodiscard]] Given judged_answers(std::size_t member, std::vector<Answer> answers) const;
  [[nodiscard]] Verdict judge(const Test& test, const Answer& answer) const;
  [[nodiscard]] std::optional<Prepared> prepare(TeachingCache& cache, std::size_t component, const TeamBelief& belief,
                                                std::span<const MemberTruth> truth) const;
  void describe(Lesson& lesson, const Unit& unit, TeachingCache& cache) const;
  [[nodiscard]] std::vector<HalfSpace> to_examine(const Lesson& lesson, TeachingCache& cache) const;
  [[nodiscard]] const Lesson* last_of_component(std::size_t component) const;
  [[nodiscard]] bool awaits_newcomer() const;
  void admit_newcomers(TeachingCache& cache);
  void make_rules(TeachingCache& cache);
  [[nodiscard]] bool is_anything_open(TeachingCache& cache, std::size_t component) const;
  void inform_bank(const Feedback& feedback, const std::vector<bool>& present);
  void decide(Feedback& feedback, const std::vector<bool>& counted, std::span<const std::size_t> rows);
  [[nodiscard]] TeachingView view(const TeamBelief& belief, std::size_t component) const;
  void conclude_period(const Feedback& feedback);

  std::shared_ptr<const Atlas> atlas_;
  TeachingOptions options_;
  StrategyChoice choice_;
  std::shared_ptr<const Strategy> strategy_;  // never changed in place, so copies may share it
  std::vector<RandomStream> persons_;
  std::vector<std::uint64_t> tie_breaks_;
  RandomStream teacher_;
  TeamBelief belief_;
  // About every member, without response noise, if a rule reads it; and what ends components and releases members.
  std::optional<TeamBelief> judged_;
  std::shared_ptr<const StopRule> mastery_;
  std::shared_ptr<const StopRule> release_;  // null: nobody is released
  double level_ = 0.0;
  std::optional<TeamBank> bank_;

  SessionStatus status_ = SessionStatus::kRunning;
  SessionPhase phase_ = SessionPhase::kProposal;
  std::size_t component_ = 0;
  std::vector<std::size_t> right_in_a_row_;  // of every member
  std::vector<ComponentStatus> components_;
  std::vector<Attendance> attendance_;
  std::vector<bool> is_new_;  // members who have not been taught yet, since somebody else had their place before
  VisitedStarts visited_;
  std::vector<HalfSpace> taught_before_;     // R_n at the end of the last learned component
  std::vector<HalfSpace> taught_with_unit_;  // R_n with the current unit
  Lesson lesson_;
  std::vector<std::optional<Given>> pending_;  // answers to the current tests
  std::vector<Given> revised_;                 // the same once discussed, per member; no answers: kept all
  Feedback feedback_;
  PastPeriods history_;
  SessionEvents events_;
};

}  // namespace kith
