#pragma once

#include <optional>

#include "kith/bec/atlas.hpp"

namespace kith::detail {

// Where an action leads, if the state has it. Only for deterministic MDPs.
[[nodiscard]] std::optional<Outcome> step_by(const Mdp& mdp, StateIndex s, ActionIndex action);

// What the robot's best path from a state is worth; 0 at the end.
[[nodiscard]] Int128 value_of(const Atlas& atlas, MdpIndex world, StateIndex s);

}  // namespace kith::detail
