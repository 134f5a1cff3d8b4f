#pragma once

#include "kith/domains/domain.hpp"

namespace kith {

// Whether behaviours can be tabulated: that takes exact behaviours in three dimensions, and every state as a start.
[[nodiscard]] bool can_be_tabulated(const Domain& domain);

// Whether tables are worth it, too: they grow fast with the number of states.
[[nodiscard]] bool is_cheap_to_tabulate(const Domain& domain);

}  // namespace kith
