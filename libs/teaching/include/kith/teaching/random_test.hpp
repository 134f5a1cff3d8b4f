#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/teaching/exam.hpp"
#include "kith/teaching/learner_bank.hpp"

namespace kith {

/// A test of a component drawn at random, and how probably people answer it correctly. The tests are spread evenly over
/// the facets of the component (GradeTable::tests). Where behaviours are not tabulated, a facet itself is the test, and
/// the weights that satisfy it answer it correctly.
class RandomTest {
 public:
  /// @param exam  of the same atlas; both have to outlive this.
  RandomTest(const Atlas& atlas, const Exam& exam, std::size_t component);

  /// The probability of answering each of the tests correctly, in [0, 1], under a belief, or under the mixture of a
  /// bank's hypotheses, which is changed in what it caches only.
  [[nodiscard]] std::vector<double> right(const ParticleBelief& belief) const;
  /// @param stopping  see NonLearners::shares(); only where behaviours are tabulated.
  [[nodiscard]] std::vector<double> right(LearnerBank& bank, double stopping = 1.0) const;

  /// E_t prod_i P_i(right on t): the probability that all of these people answer the test correctly.
  /// @param people  what right() says of each; their order changes nothing.
  [[nodiscard]] double all_right(std::span<const std::vector<double>> people) const;

 private:
  [[nodiscard]] std::vector<double> right_in_cells(std::span<const double> masses) const;

  const Atlas* atlas_;
  const GradeTable* table_;  // the exam's
  std::size_t component_;
  std::vector<HalfSpace> facets_;  // the tests where there is no table
  std::vector<double> weights_;    // of the tests; they sum to 1
};

}  // namespace kith
