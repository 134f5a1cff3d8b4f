#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/belief/team_belief.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/lesson.hpp"

namespace kith {

/// How a group is taught; every field is a key of the study file.
struct TeachingOptions {
  FilterOptions filter{};           ///< particles, eta, resampling threshold of the teacher's beliefs
  std::size_t counterfactuals = 8;  ///< N
  CounterfactualSampling sampling = CounterfactualSampling::kSystematic;
  double assumed_ability = 0.80;  ///< the beta that the teacher ascribes to everybody
  LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
  double response_noise = 0.05;  ///< nu, radians
  bool reduce_before_update = false;
  std::size_t max_periods = 50;         ///< >= 1
  std::size_t consecutive_correct = 1;  ///< periods in a row that everybody must answer all right, >= 1
  std::size_t duplicate_sets = 1;       ///< test sets per period, >= 1
  TeamBeliefParts also_record{
      .members = false, .common = false, .joint = false};  ///< beliefs kept though the strategy does not read them
};

/// How a session stands or ended.
enum class SessionStatus { kRunning, kComplete, kMaxPeriods };

enum class ComponentStatus { kOpen, kLearned, kSkipped };

/// One group being taught: a pure state machine. It does no input or output and
/// never waits; whoever drives it brings the answers of simulated learners or of
/// people. Equal streams and answers give equal sessions, bit for bit.
///
/// A period: lesson() tells what to show and ask; submit() takes everybody's
/// answers, returns the feedback and prepares the next lesson.
///
/// Each knowledge component is taught until all members answer all tests of a
/// period correctly; a component for which no demonstration has gain at the outset is
/// skipped; an unlearned one is never left before max_periods. Seats do not
/// matter: members are told apart by their streams only.
class Session {
 public:
  /// @param atlas, cache  must outlive the session; `cache` influences nothing.
  /// @param persons  one stream per member: the root of what the teacher draws for that person.
  /// @param teacher  the root of all else the teacher draws.
  /// @throws std::invalid_argument if there are no members or more than 30, the strategy is the baseline and
  /// there are several members, or an option is out of range.
  Session(const Atlas& atlas, TeachingCache& cache, const TeachingOptions& options, Strategy strategy,
          std::vector<RandomStream> persons, RandomStream teacher);

  [[nodiscard]] std::size_t num_members() const noexcept { return persons_.size(); }
  [[nodiscard]] Strategy strategy() const noexcept { return strategy_; }
  [[nodiscard]] SessionStatus status() const noexcept { return status_; }
  [[nodiscard]] bool finished() const noexcept { return status_ != SessionStatus::kRunning; }
  /// Completed periods.
  [[nodiscard]] std::size_t periods() const noexcept { return periods_; }
  [[nodiscard]] std::span<const ComponentStatus> components() const noexcept { return components_; }

  /// What to show and ask now. @throws std::logic_error if finished().
  [[nodiscard]] const Lesson& lesson() const;

  /// Takes the answers, one list per member with one answer per test of lesson(), in order.
  /// @throws std::invalid_argument if the shape is wrong, std::logic_error if finished().
  Feedback submit(std::span<const std::vector<Answer>> answers);

  /// What the teacher believes about the team.
  [[nodiscard]] const TeamBelief& belief() const noexcept { return belief_; }
  /// R_n at the end of the last learned component, minimal, with the prior.
  [[nodiscard]] const ConstraintSet& taught_region() const noexcept { return taught_before_; }

 private:
  void prepare_lesson();
  [[nodiscard]] std::optional<Unit> choose_unit(SourceBelief source, const RandomStream& random);
  [[nodiscard]] SourceBelief choose_source() const;
  [[nodiscard]] const ParticleBelief& belief_of(SourceBelief source) const;
  void describe_lesson(const ConstraintSet& taught_region);
  void choose_tests(const RandomStream& random);
  [[nodiscard]] Verdict judge(const Test& test, const Answer& answer) const;
  void conclude_period(bool all_correct);

  const Atlas* atlas_;
  TeachingCache* cache_;
  TeachingOptions options_;
  Strategy strategy_;
  std::vector<RandomStream> persons_;
  std::vector<std::uint64_t> tie_breaks_;
  RandomStream teacher_;
  TeamBelief belief_;

  SessionStatus status_ = SessionStatus::kRunning;
  std::size_t periods_ = 0;
  std::size_t component_ = 0;
  std::size_t correct_in_a_row_ = 0;
  std::vector<ComponentStatus> components_;
  VisitedDemos visited_;
  ConstraintSet taught_before_;              // R_n at the end of the last learned component
  ConstraintSet taught_with_unit_;           // R_n with the current unit
  std::optional<Lesson> last_of_component_;  // the last lesson of the current component
  Lesson lesson_;
};

}  // namespace kith
