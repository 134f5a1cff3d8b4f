#include "naive_counterfactuals.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "value_iteration.hpp"

namespace kith::rivals {
namespace {

// Feature counts of the greedy path from every state; nothing for states whose greedy path does not end.
std::vector<std::optional<IntegerVector>> path_counts(const Mdp& mdp, std::span<const std::uint32_t> choice) {
  std::vector<std::optional<IntegerVector>> counts(mdp.num_states() + mdp.num_terminals());
  for (std::size_t t = mdp.num_states(); t < counts.size(); ++t) counts[t] = IntegerVector(mdp.num_features());
  std::vector<std::size_t> path;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    path.clear();
    std::size_t at = s;
    while (!counts[at] && path.size() <= mdp.num_states()) {
      path.push_back(at);
      at = mdp.outcomes(mdp.choices(StateIndex{at})[choice[at]]).front().next.value();
    }
    if (!counts[at]) continue;
    for (; !path.empty(); path.pop_back()) {
      const auto& outcome = mdp.outcomes(mdp.choices(StateIndex{path.back()})[choice[path.back()]]).front();
      counts[path.back()] = mdp.integer_features(outcome) + *counts[outcome.next.value()];
    }
  }
  return counts;
}

}  // namespace

NaiveCounterfactuals::NaiveCounterfactuals(const Atlas& atlas) : atlas_{atlas} {
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    const auto mdp = atlas.id(start).mdp;
    auto& path = paths_.emplace_back();
    for (const auto state : atlas.trajectory(start).states) {
      if (!atlas.domain().mdp(mdp).is_terminal(state)) path.push_back(atlas.index({mdp, state}));
    }
  }
}

void NaiveCounterfactuals::add_conveyed(MdpIndex m, const Eigen::Vector3d& weights,
                                        std::vector<std::vector<IntegerVector>>& by_demo) const {
  const auto& mdp = atlas_.domain().mdp(m);
  const auto plan = testing::value_iteration(mdp, std::array{weights.x(), weights.y(), weights.z()});
  if (!plan.converged) return;
  const auto counts = path_counts(mdp, plan.greedy_choice);
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    const auto start = atlas_.index({m, StateIndex{s}});
    for (const auto state : paths_[start.value()]) {
      const auto& expected = counts[atlas_.id(state).start.value()];
      if (!expected) continue;
      const auto loss = atlas_.feature_counts(state) - *expected;
      if (!loss.is_zero()) by_demo[start.value()].push_back(primitive(loss));
    }
  }
}

std::vector<std::vector<HalfSpace>> NaiveCounterfactuals::conveyed(std::span<const Eigen::Vector3d> persons) const {
  std::vector<std::vector<IntegerVector>> normals(atlas_.num_states());
  for (const auto& weights : persons) {
    for (MdpIndex m{0}; m.value() < atlas_.domain().num_mdps(); ++m) add_conveyed(m, weights, normals);
  }
  std::vector<std::vector<HalfSpace>> half_spaces(normals.size());
  for (std::size_t d = 0; d < normals.size(); ++d) {
    std::sort(normals[d].begin(), normals[d].end());
    normals[d].erase(std::unique(normals[d].begin(), normals[d].end()), normals[d].end());
    for (const auto& normal : normals[d]) half_spaces[d].emplace_back(normal);
  }
  return half_spaces;
}

std::size_t NaiveCounterfactuals::plans(std::span<const Eigen::Vector3d> persons) const {
  std::size_t converged = 0;
  for (const auto& weights : persons) {
    for (MdpIndex m{0}; m.value() < atlas_.domain().num_mdps(); ++m) {
      const std::array w{weights.x(), weights.y(), weights.z()};
      converged += testing::value_iteration(atlas_.domain().mdp(m), w).converged ? 1u : 0u;
    }
  }
  return converged;
}

}  // namespace kith::rivals
