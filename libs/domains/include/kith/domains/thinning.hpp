#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kith/domains/family_map.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith::detail {

// Reads [family]: how many of the worlds are built, and how many starts each has.
[[nodiscard]] Thinning read_thinning(TomlReader& file);

// [[family.world]]: the worlds that are built, in place of all.
void list_worlds(FamilyMap& family_map, TomlReport& report);

// Which groups are on in each MDP of a thinned family: none, each kind of
// optional thing alone, each pair of kinds, then random subsets until there are
// enough, and all in the last one. Nothing is repeated. A kind is what the
// things are called. Apart from its end, a longer list begins with a shorter one.
// @pre num_worlds <= 2^groups.
[[nodiscard]] std::vector<std::uint64_t> choose_masks(const FamilyMap& family_map, std::size_t num_worlds,
                                                      std::uint64_t seed);

// At most `most` states spread over the process, ascending: the first one, then always the state that is farthest, in
// transitions taken either way, from those chosen before (of several the first). @pre every state is connected to
// state 0 through others, and most >= 1.
[[nodiscard]] std::vector<StateIndex> spread_states(const Mdp& mdp, std::size_t most);

}  // namespace kith::detail
