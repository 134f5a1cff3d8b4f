#pragma once

#include <cstdint>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith::detail {

// The strongly connected components of the graph of all transitions between non-terminal states.
struct Components {
  std::vector<StateIndex> states;     // component by component; transitions never lead to a later one; ascending within
  std::vector<std::uint32_t> starts;  // shape [components + 1]
};

// Tarjan's algorithm with an explicit stack: components come out after those they lead to [tarjan1972].
// @pre choices and outcomes are complete.
[[nodiscard]] Components strong_components(const Mdp& mdp);

}  // namespace kith::detail
