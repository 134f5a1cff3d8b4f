#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/fit/log_likelihood.hpp"

namespace kith {

/// What a grid search keeps, per group of people.
struct GridSearchGroup {
  std::string name;
  std::size_t people = 0;
  std::size_t points = 0;  ///< Points of the grid with a confirm gain below the correct gain.
  std::size_t kept = 0;    ///< Of these, with an error of at most epsilon.
  double least_error = 0.0;
  ParameterPoint best{};
  // Fits to the points that were kept; all 0 if none were.
  double ability_mean = 0.0;
  double ability_sd = 0.0;
  double confirm_scale = 0.0;  ///< Half-normal: the root mean square.
  double correct_scale = 0.0;
};

/// The grid of [jayaraman2024]: abilities 0.55 to 0.85 by 0.05, gains 0 to 0.18 by 0.02.
[[nodiscard]] ParameterGrid published_grid();

/// The published way of fitting, for comparison: for every point of the grid the mean over people of
/// |mass of the final belief in the policy's class - share of final tests answered rightly|; the points with an error
/// of at most `epsilon` are kept, and a normal and two half-normals are fitted to them as if they were people. There is
/// no likelihood and no uncertainty in it: the spread of the result is that of the grid, and a wider epsilon
/// gives wider "populations". Without its undocumented shift of abilities by -0.04.
/// @throws std::invalid_argument unless the table is complete and epsilon > 0; kith::Error (kInvalidInput, E0709) if
/// the logs do not name the policy's class or nobody has final tests.
[[nodiscard]] std::vector<GridSearchGroup> grid_search(const ResponseLogs& logs, const LikelihoodTable& table,
                                                       double epsilon = 0.2);

}  // namespace kith
