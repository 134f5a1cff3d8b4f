#pragma once

#include <cstddef>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// How well somebody predicts the robot on a set of starts.
struct Grade {
  double share_right = 0.0;  ///< Share of the starts where the path is as good as the robot's, in [0, 1].
  double regret = 0.0;       ///< Mean of the robot's return minus that of the path, >= 0, in the units of the weights
                             ///< that the domain file states.
  friend bool operator==(const Grade&, const Grade&) = default;
};

/// What people with the weights of each policy cell predict right, over all candidate starts of a domain with tables:
/// all of them together and those of every knowledge component. A start without a finite optimum is predicted wrong,
/// and its regret is that of the worst policy of its coverage set.
///
/// Immutable; needs no more than the atlas while it is made.
class GradeTable {
 public:
  /// @throws kith::Error (kInfeasible) unless the atlas has tables.
  explicit GradeTable(const Atlas& atlas);

  [[nodiscard]] std::size_t num_components() const noexcept { return num_components_; }
  /// Over all starts.
  [[nodiscard]] const Grade& all(PolicyCellIndex cell) const { return row(cell)[num_components_]; }
  /// Over the starts in MDPs of a component.
  [[nodiscard]] const Grade& component(PolicyCellIndex cell, std::size_t component) const {
    return row(cell)[component];
  }
  /// A start that tests the component, as learners see it, and its share of the component's tests.
  struct ComponentTest {
    HullIndex hull;
    double weight = 0.0;  ///< Those of a component sum to 1.
  };
  /// The tests of a component, spread evenly over the facets of its region; ascending by hull.
  [[nodiscard]] const std::vector<ComponentTest>& tests(std::size_t component) const { return tests_[component]; }
  /// Whether people of this cell answer rightly from this start.
  [[nodiscard]] bool is_right(PolicyCellIndex cell, HullIndex hull) const {
    return right_[cell.value() * num_hulls_ + hull.value()] != 0;
  }

 private:
  [[nodiscard]] const Grade* row(PolicyCellIndex cell) const {
    return grades_.data() + cell.value() * (num_components_ + 1);
  }
  void grade_starts(const Atlas& atlas);
  void grade_tests(const Atlas& atlas);

  std::size_t num_components_;
  std::size_t num_hulls_;
  std::vector<char> right_;                        // shape [num_cells, num_hulls]
  std::vector<Grade> grades_;                      // shape [num_cells, num_components + 1], the last of all starts
  std::vector<std::vector<ComponentTest>> tests_;  // per component
};

}  // namespace kith
