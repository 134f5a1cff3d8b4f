#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/analysis/cell_design.hpp"

namespace kith {

// A response that is centred and scaled by a power of two, so that sums of squares of any data neither overflow nor
// lose digits: original value = centre + ldexp(values[i], exponent).
struct StandardizedResponse {
  std::vector<double> values;  // Largest size in [1/2, 1], or all 0.
  double centre = 0.0;
  int exponent = 0;
  double rounding = 0.0;  // What a value may be off by, being a rounded number; in units of `values`.
};
// The values must be finite and may be none.
[[nodiscard]] StandardizedResponse standardize(std::span<const double> response);

// Means and spread of the cells, all that a model of factors asks of a response.
struct CellMoments {
  std::vector<double> means;  // [cells]
  double within = 0.0;        // Sum of squares of the differences from the cells' means.
};
// Two passes that keep all digits of a standardised response.
[[nodiscard]] CellMoments moments_of(std::span<const double> values, const CellDesign& design);

// The squared length of what a term of the design adds to the cells' means, every observation counted.
[[nodiscard]] double term_sum_of_squares(const CellDesign& design, std::size_t term, const std::vector<double>& means);

// Squared length of what values say between the groups of each level, within those of the level before, and within the
// smallest groups. @param groups  nested in one another, from the largest to the smallest, of equal sizes.
[[nodiscard]] std::vector<double> squares_in_strata(std::span<const double> values, std::span<const Factor> groups);

}  // namespace kith
