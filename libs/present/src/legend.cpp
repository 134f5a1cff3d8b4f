#include "kith/present/legend.hpp"
#include "kith/present/wrapped.hpp"

#include <fmt/format.h>
#include <string>
#include <vector>

#include <algorithm>

namespace kith {
namespace {

// What one cell shows apart from the robot.
struct Shown {
  CellContent content;
  bool station = false;
  std::vector<std::size_t> items;  // by number in Domain::item_names()
  [[nodiscard]] bool is_floor() const {
    return !content.wall && !content.goal && content.terrain.empty() && content.destination_of.empty() && !station &&
           items.empty();
  }
};

Shown shown(const Domain& domain, MdpIndex m, const GridState& state, const Cell& cell) {
  Shown result;
  result.content = domain.content(m, cell);
  result.station = std::find(state.stations.begin(), state.stations.end(), cell) != state.stations.end();
  const auto numbers = domain.items_in(m);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (state.items[i] == cell) result.items.push_back(numbers[i]);
  }
  return result;
}

char glyph_at(const Picture& picture, const Cell& cell) {
  return picture[picture.size() - static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x - 1)];
}

template <typename Visit>
void for_each_cell_from_top(const Domain& domain, const Visit& visit) {
  for (int y = domain.height(); y >= 1; --y) {
    for (int x = 1; x <= domain.width(); ++x) visit(Cell{x, y});
  }
}

std::string name_of(const Domain& domain, const Shown& what, const LegendEntry& symbol) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " and ") + part; };
  if (what.content.wall) add("wall");
  if (!what.content.terrain.empty()) add(what.content.terrain);
  if (what.station) add(symbol.station);
  if (!what.content.destination_of.empty()) add("destination of " + what.content.destination_of);
  if (what.content.goal) add(symbol.goal_name.empty() ? "goal" : symbol.goal_name + " goal");
  for (const auto item : what.items) add(domain.item_names()[item] + " at its initial place");
  return text.empty() ? "floor" : text;
}

}  // namespace

Picture bare_picture(const Domain& domain, DemoId id) { return domain.draw_bare(id.mdp, id.start); }

std::string legend(const Domain& domain, std::size_t indent) {
  if (!domain.has_map()) return "";
  const auto symbols = domain.legend();
  const std::string blank(indent, ' ');
  std::vector<std::string> entries;
  for (const std::size_t number : {domain.num_mdps() - 1, std::size_t{0}}) {
    const MdpIndex m{number};
    const auto picture = domain.draw(m, std::nullopt);
    const auto state = domain.state(m, domain.initial_state(m));
    for_each_cell_from_top(domain, [&](const Cell& cell) {
      const auto what = shown(domain, m, state, cell);
      const auto name = what.is_floor() && cell == state.robot
                            ? "first start"
                            : name_of(domain, what, symbols[domain.legend_index(cell)]);
      const auto entry = fmt::format("{} {}", glyph_at(picture, cell), name);
      if (std::find(entries.begin(), entries.end(), entry) == entries.end()) entries.push_back(entry);
    });
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
  const std::string item = domain.item_names().empty() ? "" : "   * item elsewhere";
  return blank + text + "\n" + blank + "@ robot" + item + "   ^ v < > moves   o end of a leg\n";
}

}  // namespace kith
