#pragma once

#include <optional>
#include <vector>

#include "kith/core/integer_vector.hpp"

namespace kith::detail {

// The primitive integer vector in the direction of `numbers`, each taken as the
// decimal fraction that its shortest text shows (3.5 = 7/2, 0.1 = 1/10). Nothing
// if an entry of it would reach 2^31. Zeros give zero.
// @pre all finite, at most 8.
[[nodiscard]] std::optional<IntegerVector> exact_direction(const std::vector<double>& numbers);

}  // namespace kith::detail
