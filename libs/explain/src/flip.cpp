// The nearest world in which the robot decides otherwise.
#include <algorithm>

#include "kith/explain/contrast.hpp"
#include "kith/explain/words.hpp"
#include "walk.hpp"

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

// The robot's path in the other world, if it decides there as the alternative does.
std::optional<Trajectory> flipped_path(const Atlas& atlas, const Contrast& contrast, StartIndex start) {
  const auto [world, first] = atlas.id(start);
  detail::Walk walk{atlas, world, first};
  for (std::size_t t = 0; t < contrast.decisive; ++t) {
    if (!walk.take_if_best(contrast.robot.actions[t])) return std::nullopt;
  }
  if (walk.is_over() || walk.is_best(contrast.robot.actions[contrast.decisive])) return std::nullopt;
  if (!walk.take_if_best(contrast.alternative.actions[contrast.decisive])) return std::nullopt;
  for (auto t = contrast.decisive + 1; t < contrast.alternative.actions.size(); ++t) {
    if (!walk.take_if_best(contrast.alternative.actions[t])) break;
  }
  return walk.finished();
}

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

// "going up".
std::string doing_instead(const std::string& action) {
  for (const char* move : {"up", "down", "left", "right"}) {
    if (action == move) return "going " + action;
  }
  if (action == "pickup") return "picking it up";
  if (action == "dropoff") return "putting it down";
  if (action == "exit") return "leaving";
  return "'" + action + "'";
}

}  // namespace

std::optional<Flip> nearest_flip(const Atlas& atlas, const Contrast& contrast) {
  const auto& domain = atlas.domain();
  if (!domain.map() || !domain.is_exact()) return std::nullopt;  // without a map nothing says which worlds are alike
  const auto here = atlas.id(contrast.start).mdp;
  const auto groups = domain.optional_groups();
  struct Candidate {
    std::size_t num_groups, num_cells, world;
    auto operator<=>(const Candidate&) const = default;
  };
  std::vector<Candidate> candidates;
  for (std::size_t m = 0; m < domain.num_mdps(); ++m) {
    if (m == here.value()) continue;
    std::size_t cells = 0;
    const auto toggled = toggled_groups(domain, here, MdpIndex{m});
    for (const auto g : toggled) cells += groups[g].cells.size();
    candidates.push_back({toggled.size(), cells, m});
  }
  std::sort(candidates.begin(), candidates.end());
  for (const auto& candidate : candidates) {
    const MdpIndex world{candidate.world};
    const auto start = same_start(atlas, contrast.start, world);
    if (!start) continue;
    if (auto path = flipped_path(atlas, contrast, *start)) {
      return Flip{*start, *std::move(path), toggled_groups(domain, here, world)};
    }
  }
  return std::nullopt;
}

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

std::string flip_in_words(const Atlas& atlas, const Contrast& contrast, const Flip& flip) {
  const auto& domain = atlas.domain();
  const auto [world, start] = atlas.id(flip.start);
  const auto& names = domain.action_names();
  const auto map = domain.map().value();  // otherwise nothing flips
  const auto cell = map.state(world, flip.robot.states[contrast.decisive]).robot;
  return difference_in_words(domain, world, flip.toggled) + " it " +
         action_words(names[flip.robot.actions[contrast.decisive].value()]) + " at " + cell_text(map, cell) +
         " rather than " + doing_instead(names[contrast.robot.actions[contrast.decisive].value()]);
}

}  // namespace kith
