#pragma once

#include <cstddef>
#include <vector>

#include "kith/analysis/fixed_effects.hpp"

namespace kith {

// The level of every factor in a cell of the reference grid.
[[nodiscard]] std::vector<std::size_t> levels_of_cell(const FactorDesign& design, std::size_t cell);

}  // namespace kith
