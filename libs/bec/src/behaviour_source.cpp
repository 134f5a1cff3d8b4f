#include "behaviour_source.hpp"

#include <algorithm>

#include "kith/mdp/coverage_set.hpp"

namespace kith {
namespace {

// Coverage sets of a thousand states take some tenths of a second, and twice as many states several times as long.
constexpr std::size_t kMostStatesOfTables = 1'500;
constexpr std::size_t kMostStatesOfTablesInAll = 50'000;

struct Sizes {
  std::size_t states = 0;
  std::size_t most = 0;  // of one MDP
  bool small_counts = true;
};

Sizes sizes_of(const Domain& domain) {
  Sizes sizes;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    sizes.small_counts = sizes.small_counts && has_small_counts(domain.mdp(m));
    sizes.most = std::max(sizes.most, domain.mdp(m).num_states());
    sizes.states += domain.mdp(m).num_states();
  }
  return sizes;
}

bool can_be_tabulated(const Domain& domain, const Sizes& sizes) {
  return domain.is_exact() && sizes.small_counts && domain.num_features() == 3 && domain.num_starts() == sizes.states;
}

}  // namespace

bool can_be_tabulated(const Domain& domain) { return can_be_tabulated(domain, sizes_of(domain)); }

bool is_cheap_to_tabulate(const Domain& domain) {
  const auto sizes = sizes_of(domain);
  return can_be_tabulated(domain, sizes) && sizes.most <= kMostStatesOfTables &&
         sizes.states <= kMostStatesOfTablesInAll;
}

}  // namespace kith
