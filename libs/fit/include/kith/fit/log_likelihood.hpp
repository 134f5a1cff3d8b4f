#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kith/core/parallel.hpp"
#include "kith/fit/person_log.hpp"

namespace kith {

/// One setting of the parameters of a learner.
struct ParameterPoint {
  double ability = 0.7;
  double confirm_gain = 0.0;
  double correct_gain = 0.0;
  friend bool operator==(const ParameterPoint&, const ParameterPoint&) = default;
};

/// All combinations of some abilities and gains, the abilities slowest and the correct gains fastest.
struct ParameterGrid {
  std::vector<double> abilities;      ///< Ascending, equally spaced, in [0.5, 1].
  std::vector<double> confirm_gains;  ///< Ascending from 0, equally spaced.
  std::vector<double> correct_gains;  ///< The same values.

  [[nodiscard]] std::size_t size() const noexcept {
    return abilities.size() * confirm_gains.size() * correct_gains.size();
  }
  [[nodiscard]] ParameterPoint point(std::size_t i) const;
  friend bool operator==(const ParameterGrid&, const ParameterGrid&) = default;
};

/// From first to last, `n` values each; gains from 0.
/// @throws std::invalid_argument unless 0.5 <= first < last <= 1, gain_last > 0 and there are at least 2 values of
/// each.
[[nodiscard]] ParameterGrid make_grid(double first, double last, std::size_t num_abilities, double gain_last,
                                      std::size_t num_gains);

struct LikelihoodOptions {
  std::size_t replicates = 2;  ///< R: runs of the filter per person whose probabilities are averaged.
  std::uint64_t seed = 1;
  double slip = 0.01;  ///< Probability that a period is answered by guessing.
  ParallelOptions parallel{};
};

/// log p(all answers of a person | parameters) on a grid.
struct LikelihoodTable {
  ParameterGrid grid;
  std::vector<std::vector<double>> log_likelihood;  ///< Shape [people][grid].
  /// Monte-Carlo error of the same, from the spread over runs of the filter; 0 with a single run. Same shape.
  std::vector<std::vector<double>> standard_error;
  bool complete = true;  ///< False: stopped by on_progress; the rest is then unusable.
};

/// Replays every person's sequence for every point of the grid, by the rules of the simulated learner:
/// the ability returns to its start when the component changes; demonstrations are watched at the current, scaled
/// ability; a period is answered with
///   p = (1 - slip) * mass(weights that give exactly these answers) / mass(possible weights) + slip * chance;
/// the feedback is learned with the changed ability. A period without an answer or without a possible weight says
/// nothing. The probability of the whole sequence is averaged over R runs of the filter with different noise; the
/// same noise at every point of the grid makes the surface smooth.
///
/// Points of the grid that lead to the same abilities so far share the filter, so that 500 points cost about 100 times
/// one. Results do not depend on the number of threads.
/// @throws std::invalid_argument unless replicates >= 1 and 0 <= slip <= 1, or if answers still need
/// find_answer_regions().
[[nodiscard]] LikelihoodTable log_likelihoods(const ResponseLogs& logs, const ParameterGrid& grid,
                                              const LikelihoodOptions& options);

}  // namespace kith
