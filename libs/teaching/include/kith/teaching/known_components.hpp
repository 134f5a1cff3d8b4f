#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// The constraints of every knowledge component, without the prior's.
[[nodiscard]] std::vector<std::vector<HalfSpace>> constraints_of_components(const Atlas& atlas);
/// What somebody knows who knows some of these components: their constraints, each once.
/// @param known  bit k is component k.
[[nodiscard]] std::vector<HalfSpace> known_half_spaces(std::span<const std::vector<HalfSpace>> components,
                                                       std::uint32_t known);

/// The ability with which hypotheses take in what people know beforehand.
inline constexpr double kAbilityOfKnowing = 0.95;

}  // namespace kith
