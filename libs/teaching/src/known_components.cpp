#include "kith/teaching/known_components.hpp"

#include <algorithm>

namespace kith {

std::vector<std::vector<HalfSpace>> constraints_of_components(const Atlas& atlas) {
  std::vector<std::vector<HalfSpace>> components;
  for (const auto& component : atlas.knowledge_components()) {
    components.push_back(atlas.constraints().half_spaces(component.constraints.without(atlas.prior())));
  }
  return components;
}

std::vector<HalfSpace> known_half_spaces(std::span<const std::vector<HalfSpace>> components, std::uint32_t known) {
  std::vector<HalfSpace> all;
  for (std::size_t k = 0; k < components.size(); ++k) {
    if ((known >> k & 1u) == 0u) continue;
    for (const auto& half_space : components[k]) {
      if (std::find(all.begin(), all.end(), half_space) == all.end()) all.push_back(half_space);
    }
  }
  return all;
}

}  // namespace kith
