#include "world.hpp"

#include <algorithm>

namespace kith::detail {

std::string cell_text(const World& world, std::size_t cell) {
  const auto width = static_cast<std::size_t>(world.width);
  return '(' + std::to_string(cell % width + 1) + ',' + std::to_string(cell / width + 1) + ')';
}

std::string symbol_name(const Symbol& symbol) {
  const SymbolContent& content = symbol.content;
  for (const std::string* name : {&content.terrain, &content.station, &content.item, &content.goal_name}) {
    if (!name->empty()) return *name;
  }
  if (content.goal) return "goal";
  return content.wall ? "wall" : std::string{symbol.glyph};
}

std::string variant_text(const World& world, std::size_t mdp) {
  std::vector<std::string> names;
  std::vector<std::string> lists;
  for (std::size_t group = 0; group < world.groups.size(); ++group) {
    for (const std::size_t cell : world.groups[group].cells) {
      const std::string name = symbol_name(world.symbols[world.symbol_of[cell]]);
      auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      if (at == names.size()) {
        names.push_back(name);
        lists.emplace_back();
      }
      if (!world.is_on(group, mdp)) continue;
      if (!lists[at].empty()) lists[at] += ',';
      lists[at] += cell_text(world, cell);
    }
  }
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += ' ';
    text += names[i] + "@{" + lists[i] + '}';
  }
  return text;
}

TomlPlace place_of_cell(const World& world, std::size_t cell) {
  const auto width = static_cast<std::size_t>(world.width);
  TomlPlace place = world.row_places.at(cell / width);
  // Written with escapes, columns cannot be counted: point at the row.
  if (place.length != width + 2) return place;
  place.column += 1 + cell % width;
  place.length = 1;
  return place;
}

}  // namespace kith::detail
