#pragma once

#include <Eigen/Core>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/teaching/demonstration_selection.hpp"

namespace kith::rivals {

/// A team's belief after a first lesson that conveyed the first knowledge component; the next lesson imagines eight
/// people of it.
struct Interaction {
  /// The atlas must outlive it.
  explicit Interaction(const Atlas& made);

  /// Weights of the people who are imagined at a turn.
  [[nodiscard]] std::vector<Eigen::Vector3d> people(std::uint64_t turn) const;
  /// Where the weights lie, each cell once.
  [[nodiscard]] std::vector<PolicyCellIndex> cells(std::uint64_t turn) const;

  const Atlas& atlas;
  ParticleBelief belief;
  SelectionOptions options;
};

}  // namespace kith::rivals
