#include "kith/explain/legend.hpp"
#include "kith/explain/wrapped.hpp"

#include <fmt/format.h>
#include <vector>

#include <algorithm>

namespace kith {
namespace {

// What one cell shows apart from the robot.
struct Shown {
  CellContent content;
  bool station = false;
  std::vector<std::size_t> items;  // by number in GridMap::item_names()
  [[nodiscard]] bool is_floor() const {
    return !content.wall && !content.goal && content.terrain.empty() && content.destination_of.empty() && !station &&
           items.empty();
  }
};

Shown shown(const GridMap& map, MdpIndex m, const GridState& state, const Cell& cell) {
  Shown result;
  result.content = map.content(m, cell);
  result.station = std::find(state.stations.begin(), state.stations.end(), cell) != state.stations.end();
  const auto numbers = map.is_picture() ? std::vector<std::size_t>{} : map.items_in(m);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (state.items[i] == cell) result.items.push_back(numbers[i]);
  }
  return result;
}

char glyph_at(const Picture& picture, const Cell& cell) {
  return picture[picture.size() - static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x - 1)];
}

template <typename Visit>
void for_each_cell_from_top(const GridMap& map, const Visit& visit) {
  for (int y = map.height(); y >= 1; --y)
    for (int x = 1; x <= map.width(); ++x) visit(Cell{x, y});
}

std::string name_of(const GridMap& map, const Shown& what, const LegendEntry& symbol) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " and ") + part; };
  if (what.content.wall) add("wall");
  if (!what.content.terrain.empty()) add(what.content.terrain);
  if (what.station) add(symbol.station);
  if (!what.content.destination_of.empty()) add("destination of " + what.content.destination_of);
  if (what.content.goal) add(symbol.goal_name.empty() ? "goal" : symbol.goal_name + " goal");
  for (const auto item : what.items) add(map.item_names()[item] + " at its initial place");
  return text.empty() ? "floor" : text;
}

}  // namespace

Picture bare_picture(const GridMap& map, StartId id) { return map.draw_bare(id.mdp, id.start); }

std::string legend(const Domain& domain, std::size_t indent) {
  const auto map = domain.drawing();
  if (!map) return "";
  const auto symbols = map->legend();
  const std::string blank(indent, ' ');

  // The last world has everything that is optional, the first nothing.
  std::vector<std::string> entries;
  for (const std::size_t number : {domain.num_mdps() - 1, std::size_t{0}}) {
    const MdpIndex m{number};
    const auto picture = map->draw(m, std::nullopt);
    const auto state = map->state(m, domain.initial_state(m));
    for_each_cell_from_top(*map, [&](const Cell& cell) {
      const auto what = shown(*map, m, state, cell);
      const auto name = what.is_floor() && cell == state.robot ? "first start"
                                                               : name_of(*map, what, symbols[map->legend_index(cell)]);
      const auto entry = fmt::format("{} {}", glyph_at(picture, cell), name);
      if (std::find(entries.begin(), entries.end(), entry) == entries.end()) entries.push_back(entry);
    });
  }

  for (const auto& symbol : symbols) {
    if (!map->is_picture()) break;
    const auto& item = symbol.item.empty() ? "destination of " + symbol.content.destination_of : symbol.item;
    const auto& placed = map->item_names();
    if (std::find(placed.begin(), placed.end(), item) != placed.end()) {
      entries.push_back(fmt::format("{} {}", symbol.symbol, item));
    }
  }

  std::string text, line;
  for (const auto& entry : entries) {
    if (!line.empty() && indent + line.size() + 3 + entry.size() > kTextWidth) {
      text += line + "\n" + blank;
      line.clear();
    }
    line += (line.empty() ? "" : "   ") + entry;
  }
  text += line;
  const std::string item = map->item_names().empty() || map->is_picture() ? "" : "   * item elsewhere";
  return blank + text + "\n" + blank + "@ robot" + item + "   ^ v < > moves   o end of a leg\n";
}

}  // namespace kith
