#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith {

/// A trajectory of the robot that is shown, and what it conveys.
struct Demonstration {
  DemoIndex demo;
  ConstraintSet constraints;                     ///< D: minimal set of what it conveys to the sampled counterfactuals.
  std::vector<HalfSpace> half_spaces;            ///< The same, sorted.
  double gain = 1.0;                             ///< area of the taught region before / after, > 1 when chosen for it.
  std::size_t num_new = 0;                       ///< New facets of the taught region.
  std::vector<PolicyCellIndex> counterfactuals;  ///< Cells of the beliefs it was chosen for, ascending.
};

/// A start state for which people are asked what the robot would do.
struct Test {
  DemoIndex demo;
  std::vector<HalfSpace> covered;  ///< The taught constraints that a right answer shows and that its feedback teaches.
  bool exact = true;               ///< False: no start tests the constraint itself; this one tests the nearest.
};

/// The demonstrations of one interaction period with the tests that follow.
struct Lesson {
  std::size_t period = 0;     ///< 1, 2, ...
  std::size_t component = 0;  ///< Index into Atlas::knowledge_components().
  SourceBelief source;
  std::vector<PolicyCellIndex> counterfactuals;  ///< Cells of the first demonstration's sampled beliefs, ascending.
  std::vector<Demonstration> demonstrations;
  std::vector<HalfSpace> taught;  ///< T: minimal set of the prior and all D, without the prior's own; sorted.
  std::vector<Test> tests;
  std::size_t untested = 0;      ///< Constraints of T that no start can test.
  bool repeats = false;          ///< Nothing had gain: the last unit of this component is shown again.
  double area_sr = 0.0;          ///< Solid angle of T with the prior.
  double running_area_sr = 0.0;  ///< Solid angle of the taught region after the unit.
  double gain = 0.0;             ///< log(area of the taught region before / after the unit); 0 for a repeated unit.
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
  std::vector<HalfSpace>
      half_spaces;  ///< Evidence: the test's constraints if correct, else the half-space in which the answer wins.
};

/// What the team hears after its answers.
struct Feedback {
  std::vector<std::vector<Verdict>> verdicts;  ///< Per member, per test.
  std::vector<bool> all_correct;               ///< Per member.
  std::vector<HalfSpace> half_spaces;  ///< The true constraints of all tests, in test order: what feedback teaches.
  std::vector<std::size_t> excluded;   ///< Members left out of the common belief; empty if that is not kept.
  bool component_learned = false;
};

}  // namespace kith
