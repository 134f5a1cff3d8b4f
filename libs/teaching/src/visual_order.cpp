#include "visual_order.hpp"

#include <optional>

namespace kith {
namespace {

// To the last demonstration, or to its world if it opens the unit: what is typical comes first.
int dissimilarity(const Atlas& atlas, StartIndex start, const std::vector<Demonstration>& unit) {
  if (unit.empty()) return atlas.mean_dissimilarity(start);
  return atlas.domain().dissimilarity(atlas.id(start), atlas.id(unit.back().start));
}

}  // namespace

bool has_unvisited(const Atlas& atlas, StartClassIndex c, const VisitedStarts& visited) {
  const auto members = atlas.members(c);
  return std::any_of(members.begin(), members.end(), [&](StartIndex d) { return !visited.contains(d); });
}

StartIndex simplest_of(const Atlas& atlas, std::span<const StartClassIndex> classes, const VisitedStarts& visited,
                       const std::vector<Demonstration>& unit, const RandomStream& random) {
  std::optional<VisualKey> best_key;
  StartIndex best;
  for (const auto c : classes) {
    for (const auto start : atlas.members(c)) {
      if (visited.contains(start)) continue;
      VisualKey key{atlas.complexity(start), 0, 0};
      if (best_key && key.complexity > best_key->complexity) continue;
      key.dissimilarity = dissimilarity(atlas, start, unit);
      if (best_key && key > *best_key) continue;
      // Hashing is the costly part: only when everything else is equal.
      key.chance = chance_of(start, random);
      if (best_key && key >= *best_key) continue;
      best_key = key;
      best = start;
    }
  }
  return best;
}

}  // namespace kith
