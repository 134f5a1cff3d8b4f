#include "walk.hpp"

namespace kith::detail {

std::optional<Outcome> step_by(const Mdp& mdp, StateIndex s, ActionIndex action) {
  if (mdp.is_terminal(s)) return std::nullopt;
  for (const auto& choice : mdp.choices(s)) {
    if (choice.action == action) return mdp.outcomes(choice).front();
  }
  return std::nullopt;
}

Int128 value_of(const Atlas& atlas, MdpIndex world, StateIndex s) {
  const auto& domain = atlas.domain();
  if (domain.mdp(world).is_terminal(s)) return 0;
  return dot(domain.weights().integer, atlas.feature_counts(atlas.index({world, s})));
}

}  // namespace kith::detail
