#pragma once

#include "kith/domains/domain.hpp"

namespace kith {

/// A return or regret, which is with weights of the domain's length 1, with the weights as they stand in the file: how
/// people read it. To the 15 digits that a double keeps of any decimal. Without weights, `value`.
[[nodiscard]] double in_file_units(const RewardWeights& weights, double value);

}  // namespace kith
