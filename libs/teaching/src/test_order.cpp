#include "test_order.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "visual_order.hpp"

namespace kith {

StartIndex test_to_ask(const Atlas& atlas, std::span<const StartIndex> starts, const std::vector<Demonstration>& unit,
                       const RandomStream& random, const TestPreferences* preferences) {
  std::vector<StartIndex> telling;
  if (preferences != nullptr && preferences->avoids_shortest) {
    std::ranges::copy_if(starts, std::back_inserter(telling),
                         [&](StartIndex start) { return preferences->cache.is_shortest_wrong(start); });
  }
  StartIndex best;
  std::optional<VisualKey> best_key;
  for (const auto start : telling.empty() ? starts : std::span<const StartIndex>{telling}) {
    const auto id = atlas.id(start);
    VisualKey key{-atlas.complexity(start), 0, 0};
    if (best_key && key.complexity > best_key->complexity) continue;
    for (const auto& shown : unit) key.dissimilarity -= atlas.domain().dissimilarity(id, atlas.id(shown.start));
    if (best_key && key > *best_key) continue;
    key.chance = chance_of(start, random);
    if (best_key && key >= *best_key) continue;
    best_key = key;
    best = start;
  }
  return best;
}

}  // namespace kith
