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

bool Walk::is_over() const { return atlas_.domain().mdp(world_).is_terminal(path_.states.back()); }

bool Walk::is_best(ActionIndex action) const {
  const auto& mdp = atlas_.domain().mdp(world_);
  const auto s = path_.states.back();
  const auto step = step_by(mdp, s, action);
  if (!step) return false;
  const auto reward = dot(atlas_.domain().weights().integer, mdp.integer_features(*step));
  return reward + value_of(atlas_, world_, step->next) == value_of(atlas_, world_, s);
}

bool Walk::take_if_best(ActionIndex action) {
  if (!is_best(action)) return false;
  path_.states.push_back(step_by(atlas_.domain().mdp(world_), path_.states.back(), action)->next);
  path_.actions.push_back(action);
  return true;
}

Trajectory Walk::finished() const {
  auto path = path_;
  if (is_over()) return path;
  const auto rest = atlas_.trajectory(atlas_.index({world_, path_.states.back()}));
  path.states.insert(path.states.end(), rest.states.begin() + 1, rest.states.end());
  path.actions.insert(path.actions.end(), rest.actions.begin(), rest.actions.end());
  return path;
}

}  // namespace kith::detail
