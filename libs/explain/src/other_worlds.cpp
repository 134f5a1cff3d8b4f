// The same start in another world, and how worlds differ.
#include <algorithm>

#include "kith/explain/contrast.hpp"
#include "kith/explain/words.hpp"

namespace kith {

std::optional<StartIndex> same_start(const Atlas& atlas, StartIndex start_index, MdpIndex world) {
  const auto& domain = atlas.domain();
  const auto map = domain.map();
  if (!map) return std::nullopt;
  const auto [from, start] = atlas.id(start_index);
  const auto before = map->state(from, start);
  const auto fresh_there = map->state(world, domain.initial_state(world));
  const auto fresh_here = map->state(from, domain.initial_state(from));
  const auto has = [](const auto& list, const auto& entry) {
    return std::find(list.begin(), list.end(), entry) != list.end();
  };
  GridState state;
  state.robot = before.robot;
  const auto items_here = map->items_in(from);
  const auto items_there = map->items_in(world);
  for (std::size_t i = 0; i < items_there.size(); ++i) {
    const auto place = std::find(items_here.begin(), items_here.end(), items_there[i]);
    const auto j = static_cast<std::size_t>(place - items_here.begin());
    const bool known = place != items_here.end();
    state.items.push_back(known ? before.items[j] : fresh_there.items[i]);
    state.carried.push_back(known && before.carried[j]);
  }
  // A robot that carries something only here would start there with empty hands: another start.
  for (std::size_t j = 0; j < items_here.size(); ++j) {
    if (before.carried[j] && !has(items_there, items_here[j])) return std::nullopt;
  }
  for (const auto& station : fresh_there.stations) {
    if (!has(fresh_here.stations, station) || has(before.stations, station)) state.stations.push_back(station);
  }
  const auto found = map->find_state(world, state);
  if (!found || domain.mdp(world).is_terminal(*found)) return std::nullopt;
  return atlas.index({world, *found});
}

namespace {

std::string thing_in_words(const GridMap& map, const OptionalGroup& group) {
  constexpr std::size_t kFew = 2;
  const auto& cells = group.cells;
  if (cells.size() > kFew) {
    return "the " + group.name + " from " + cell_text(map, cells.front()) + " to " + cell_text(map, cells.back());
  }
  std::vector<std::string> places;
  places.reserve(cells.size());
  for (const auto& cell : cells) places.push_back(cell_text(map, cell));
  return "the " + group.name + " at " + listed(places);
}

}  // namespace

std::vector<std::size_t> toggled_groups(const Domain& domain, MdpIndex a, MdpIndex b) {
  const auto here = domain.present_things(a);
  const auto there = domain.present_things(b);
  std::vector<std::size_t> toggled;
  for (std::size_t g = 0; g < here.size(); ++g) {
    if (here[g] != there[g]) toggled.push_back(g);
  }
  return toggled;
}

std::string difference_in_words(const Domain& domain, MdpIndex world, std::span<const std::size_t> toggled) {
  const auto map = domain.map();
  if (!map) return {};
  const auto groups = domain.optional_groups();
  const auto there = domain.present_things(world);
  std::vector<std::string> added, removed;
  for (const auto g : toggled) (there[g] ? added : removed).push_back(thing_in_words(*map, groups[g]));
  std::string text;
  if (!added.empty()) text = "with " + listed(added);
  if (!removed.empty()) text += (text.empty() ? "" : " and ") + ("without " + listed(removed));
  return text;
}

}  // namespace kith
