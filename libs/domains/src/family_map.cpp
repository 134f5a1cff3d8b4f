#include "kith/domains/family_map.hpp"

#include <algorithm>

namespace kith::detail {

std::string cell_text(const FamilyMap& family_map, std::size_t cell) {
  const auto width = static_cast<std::size_t>(family_map.width);
  return '(' + std::to_string(cell % width + 1) + ',' + std::to_string(cell / width + 1) + ')';
}

std::string symbol_name(const Symbol& symbol) {
  const SymbolContent& content = symbol.content;
  for (const std::string* name : {&content.terrain, &content.station, &content.item, &content.goal_name}) {
    if (!name->empty()) return *name;
  }
  if (content.goal) return "goal";
  if (content.start) return "start";
  return content.wall ? "wall" : std::string{symbol.glyph};
}

std::string world_text(const FamilyMap& family_map, std::size_t mdp) {
  std::vector<std::string> names;
  std::vector<std::string> lists;
  for (std::size_t group = 0; group < family_map.groups.size(); ++group) {
    for (const MapThing& thing : family_map.groups[group].things) {
      const std::string name = symbol_name(family_map.symbols[thing.symbol]);
      auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      if (at == names.size()) {
        names.push_back(name);
        lists.emplace_back();
      }

      if (!family_map.is_on(group, mdp)) continue;
      if (!lists[at].empty()) lists[at] += ',';
      lists[at] += cell_text(family_map, thing.cell);
    }
  }

  std::string text;
  if (!family_map.world_names.empty() && !family_map.world_names[mdp].empty())
    text = family_map.world_names[mdp] + ": ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += ' ';
    text += names[i] + "@{" + lists[i] + '}';
  }
  return text;
}

TomlPlace place_of_cell(const FamilyMap& family_map, std::size_t cell) {
  if (family_map.row_places.empty()) return family_map.source_place;
  const auto width = static_cast<std::size_t>(family_map.width);
  TomlPlace place = family_map.row_places.at(cell / width);
  // Written with escapes, columns cannot be counted: point at the row.
  if (place.length != width + 2) return place;
  place.column += 1 + cell % width;
  place.length = 1;
  return place;
}

SymbolContent together(const std::vector<const SymbolContent*>& contents) {
  SymbolContent sum;
  std::vector<std::string> terrains;
  const auto take = [](std::string& to, const std::string& from) {
    if (!from.empty()) to = from;
  };
  for (const SymbolContent* one : contents) {
    sum.wall = sum.wall || one->wall;
    sum.start = sum.start || one->start;
    sum.goal = sum.goal || one->goal;
    sum.carried = sum.carried || one->carried;
    take(sum.goal_name, one->goal_name);
    take(sum.station, one->station);
    take(sum.item, one->item);
    take(sum.destination, one->destination);
    if (one->terrain.empty() || std::find(terrains.begin(), terrains.end(), one->terrain) != terrains.end()) continue;
    terrains.push_back(one->terrain);
    sum.terrain += (sum.terrain.empty() ? "" : " and ") + one->terrain;
  }
  if (!sum.wall) return sum;
  SymbolContent wall;
  wall.wall = true;
  return wall;
}

bool is_called(const SymbolContent& content, const std::string& name) {
  if (name == "wall") return content.wall;
  if (name == "goal") return content.goal;
  return content.terrain == name || content.station == name || content.item == name || content.goal_name == name;
}

std::vector<MapThing> FamilyMap::things_on(std::size_t cell) const {
  std::vector<MapThing> things{{cell, symbol_of[cell], group_of[cell]}};
  const auto begin = std::lower_bound(painted.begin(), painted.end(), cell,
                                      [](const MapThing& t, std::size_t c) { return t.cell < c; });
  for (auto it = begin; it != painted.end() && it->cell == cell; ++it) things.push_back(*it);
  return things;
}

SymbolContent FamilyMap::content_in(std::size_t cell, std::size_t mdp) const {
  if (painted.empty() && rasters.empty()) {
    return is_there(group_of[cell], mdp) ? symbols[symbol_of[cell]].content : SymbolContent{};
  }
  std::vector<const SymbolContent*> contents;
  for (const MapThing& thing : things_on(cell)) {
    if (is_there(thing.group, mdp)) contents.push_back(&symbols[thing.symbol].content);
  }
  for (std::size_t r = 0; r < rasters.size(); ++r) {
    if (rasters[r].symbol < 0 || raster_value(r, cell, mdp) == 0) continue;
    contents.push_back(&symbols[static_cast<std::size_t>(rasters[r].symbol)].content);
  }
  return together(contents);
}

}  // namespace kith::detail
