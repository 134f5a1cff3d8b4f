#include "kith/teaching/older_robot.hpp"

#include <algorithm>
#include <utility>

#include "kith/core/assert.hpp"

namespace kith {

OlderRobot older_robot(const Atlas& atlas) {
  auto region = atlas.prior_cone();
  const bool has_room = region.clip(atlas.policy_bec_half_spaces());
  KITH_ASSERT(has_room);  // the robot's weights lie inside
  return {atlas.domain().id(), region.minimal_set()};
}

std::optional<Cone> known_within(Cone prior, std::span<const HalfSpace> region) {
  if (!prior.clip(region)) return std::nullopt;
  return prior;
}

std::string why_incomparable(const Domain& older, const Domain& newer) {
  const bool is_same = older.feature_names() == newer.feature_names();
  return is_same ? "" : "'" + older.id() + "' weighs other features than '" + newer.id() + "', or in another order";
}

RobotUpdate update_of(const Atlas& atlas, const Cone& known) {
  RobotUpdate update;
  for (const auto& component : atlas.knowledge_components()) {
    for (const auto& facet : atlas.constraints().half_spaces(component.constraints)) {
      if (!atlas.prior_cone().implies(facet)) (known.implies(facet) ? update.still : update.now).push_back(facet);
    }
  }
  for (auto* list : {&update.now, &update.still}) {
    std::ranges::sort(*list);
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  return update;
}

}  // namespace kith
