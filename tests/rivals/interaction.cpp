#include "interaction.hpp"

#include <algorithm>

namespace kith::rivals {

Interaction::Interaction(const Atlas& made) : atlas{made}, belief{made.prior_cone(), FilterOptions{}} {
  const auto& component = atlas.knowledge_components().front();
  belief.observe(atlas.constraints().half_spaces(component.constraints), options.likelihood, RandomStream{5});
}

std::vector<Eigen::Vector3d> Interaction::people(std::uint64_t turn) const {
  std::vector<Eigen::Vector3d> points;
  for (const auto& draw : belief.systematic_draws(options.counterfactuals, RandomStream{6}.split(turn)))
    points.emplace_back(belief.point(draw.index));
  return points;
}

std::vector<PolicyCellIndex> Interaction::cells(std::uint64_t turn) const {
  std::vector<PolicyCellIndex> cells;
  for (const auto& weights : people(turn)) cells.push_back(atlas.tables().cells().locate(weights));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

}  // namespace kith::rivals
