#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// The belief that a lesson was chosen for.
struct SourceBelief {
  /// Name of the rule of aggregation, such as "common"; "everybody": the beliefs about all members; empty: a member's
  /// belief.
  std::string rule;
  std::size_t member = 0;  ///< Seat, if it is a member's belief.

  [[nodiscard]] static SourceBelief of_member(std::size_t seat) { return {{}, seat}; }
  [[nodiscard]] static SourceBelief of_team(std::string_view rule) { return {std::string{rule}, 0}; }
  [[nodiscard]] static SourceBelief of_everybody() { return {std::string{kEverybody}, 0}; }
  [[nodiscard]] bool is_everybody() const noexcept { return rule == kEverybody; }
  [[nodiscard]] bool is_member() const noexcept { return rule.empty(); }
  friend bool operator==(const SourceBelief&, const SourceBelief&) = default;

  static constexpr std::string_view kEverybody = "everybody";
};

/// A trajectory of the robot that is shown, and what it conveys.
struct Demonstration {
  StartIndex start;
  std::vector<HalfSpace> half_spaces;      ///< D: minimal set of what it conveys to the counterfactuals; sorted.
  double gain = 1.0;                       ///< Area of the taught region before / after, > 1 when chosen for it.
  std::size_t num_new = 0;                 ///< New facets of the taught region.
  std::vector<Direction> counterfactuals;  ///< The beliefs it was chosen for: one weight per distinct behaviour, in the
                                           ///< order of the draws.
  bool completes = false;  ///< Chosen for people who miss what was still open, whatever is believed; see UnitSelector.
  friend bool operator==(const Demonstration&, const Demonstration&) = default;
};

/// Demonstrations that are shown together.
struct Unit {
  std::vector<Demonstration> demonstrations;
  std::vector<HalfSpace> taught_region;  ///< R_n after the unit: minimal, with the prior; sorted.
};

/// A start state for which people are asked what the robot would do.
struct Test {
  StartIndex start;
  std::vector<HalfSpace>
      covered;        ///< The examined constraints that the robot's path shows and that its feedback teaches.
  bool exact = true;  ///< False: no start tests the constraint itself; this one tests the nearest.
  /// Whether people who only take the shortest path get it wrong: else a right answer tells nobody what they know.
  bool is_shortest_wrong = false;
  friend bool operator==(const Test&, const Test&) = default;
};

/// The demonstrations of one interaction period with the tests that follow. A value: it means the same whatever cache
/// it was made with.
struct Lesson {
  std::size_t period = 0;     ///< 1, 2, ...
  std::size_t component = 0;  ///< Index into Atlas::knowledge_components().
  SourceBelief source;
  std::vector<Demonstration> demonstrations;
  std::vector<HalfSpace> taught;  ///< T: minimal set of the prior and all D, without the prior's own; sorted.
  std::vector<Test> tests;
  std::size_t untested = 0;            ///< Constraints of T that no start can test.
  std::size_t tests_demonstrated = 0;  ///< Tests whose start was demonstrated in this lesson or before.
  bool repeats = false;                ///< Nothing had gain: the last unit of this component is shown again.
  double area_sr = 0.0;                ///< Solid angle of T with the prior.
  double running_area_sr = 0.0;        ///< Solid angle of the taught region after the unit.
  double gain = 0.0;  ///< log(area of the taught region before / after the unit); 0 for a repeated unit.
  friend bool operator==(const Lesson&, const Lesson&) = default;
};

/// One person's answer to one test: feature counts of the path, or nothing if
/// no path was given.
using Answer = std::optional<IntegerVector>;

/// What an answer showed.
struct Verdict {
  bool correct = false;  ///< As good as the robot's path under the robot's weights.
  double regret = 0.0;   ///< Return of the robot's path minus that of the answer, >= 0; weights at length 1. NaN never:
                         ///< 0 without answer.
  bool answered = true;
  std::vector<HalfSpace> half_spaces;  ///< Evidence about what the person believes; see Session.
  friend bool operator==(const Verdict&, const Verdict&) = default;
};

/// What the team hears after its answers.
struct Feedback {
  std::vector<std::vector<Verdict>> verdicts;  ///< Per member, per test; empty for a member who was away.
  std::vector<bool> all_correct;               ///< Per member; false for a member who was away.
  std::vector<HalfSpace> half_spaces;  ///< The true constraints of all tests, in test order: what feedback teaches.
  std::vector<std::size_t> excluded;   ///< Members whom a rule of aggregation left out, such as the common belief's.
  bool component_learned = false;
  std::vector<std::size_t> released{};  ///< Members who are done with the component before the others; ascending.
  /// After a discussion, as `verdicts`; empty for members who kept all answers. Empty without a discussion.
  std::vector<std::vector<Verdict>> revised{};

  /// What the member answered in the end; as `verdicts` without a discussion.
  [[nodiscard]] const std::vector<Verdict>& final_verdicts(std::size_t member) const {
    return member < revised.size() && !revised[member].empty() ? revised[member] : verdicts.at(member);
  }
  /// Whether all answers of the member were right in the end: what the member hears.
  [[nodiscard]] bool all_right_in_the_end(std::size_t member) const;
  friend bool operator==(const Feedback&, const Feedback&) = default;
};

}  // namespace kith
