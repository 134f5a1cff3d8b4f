#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/domains/cell.hpp"
#include "kith/domains/named_files.hpp"
#include "kith/files/reader.hpp"

namespace kith::detail {

// What a symbol of the legend puts on a cell. Empty strings: nothing of the kind.
struct SymbolContent {
  bool wall = false;
  bool start = false;
  bool goal = false;
  std::string goal_name;  // goal = "NAME"
  std::string terrain;
  std::string station;
  std::string item;
  std::string destination;  // the item that belongs here
  bool carried = false;     // the item: by the robot, from the beginning

  [[nodiscard]] bool is_floor() const { return *this == SymbolContent{}; }
  friend bool operator==(const SymbolContent&, const SymbolContent&) = default;
};

struct Symbol {
  char glyph = '.';
  SymbolContent content;
  bool toggles_each_cell = false;  // optional = true
  std::string toggle;              // optional = "NAME"; empty: none
  TomlPlace place;

  [[nodiscard]] bool is_optional() const { return toggles_each_cell || !toggle.empty(); }
};

// What a symbol stands for, on one cell: in all MDPs, or in those in which a group is on.
struct MapThing {
  std::size_t cell = 0;
  std::uint8_t symbol = 0;  // index into FamilyMap::symbols
  std::int32_t group = -1;  // index into FamilyMap::groups; -1: always there
};

// Things that are there or not together: one bit of a world.
struct CellGroup {
  std::string name;  // optional = "NAME"; empty: a thing by itself
  std::vector<MapThing> things;
  TomlPlace place;  // of the symbol or layer that is optional
};

// A cell, in the MDPs in which a group is on.
struct Spot {
  std::size_t cell = 0;
  std::int32_t group = -1;
};

struct Item {
  std::string name;
  std::vector<Spot> homes;  // none if the symbol is not on the map; at most one in each MDP
  std::vector<Spot> destinations;
  bool carried = false;  // from the beginning
};

struct Station {
  std::string name;
  std::size_t cell = 0;
};

// A number for every cell, computed from what is on the map or read from an image.
struct Raster {
  enum class Kind : std::uint8_t { kNear, kDistance, kSeen, kImage };
  std::string name;
  Kind kind = Kind::kNear;
  std::vector<std::string> of;        // names of things
  std::size_t reach = 0;              // cells: how far, or the largest distance
  std::vector<std::uint16_t> values;  // kImage: shape [cells]
  std::int32_t symbol = -1;  // how cells are drawn where it is not 0, index into FamilyMap::symbols; -1: not at all
  TomlPlace place;           // of the name
};

// What a file says about how much of its family is built.
struct Thinning {
  std::optional<std::size_t> worlds;  // nothing: every combination of optional things
  std::uint64_t seed = 1;             // of the worlds that are drawn
  TomlPlace worlds_place;             // of `worlds`, if given
  std::optional<std::size_t> starts;  // per world; nothing: every state
  const TomlArray* listed = nullptr;  // [[family.world]]
  TomlPlace listed_place;
};

// The map with everything optional on it. Cells are numbered in reading order: top row first, left to right. The lowest
// layer has a symbol on every cell; further layers put things on top of it.
struct FamilyMap {
  int width = 0;
  int height = 0;
  std::vector<Symbol> symbols;             // legend order; then those of rasters and of cells that hold several things
  std::vector<std::uint8_t> symbol_of;     // per cell, index into symbols: the lowest layer
  std::vector<CellGroup> groups;           // index order, most significant first
  std::vector<std::int32_t> group_of;      // per cell, of the lowest layer; -1: always there
  std::vector<MapThing> painted;           // the other layers, by cell and then by layer
  std::vector<Item> items;                 // legend order
  std::vector<Station> stations;           // reading order; one per cell
  std::vector<std::string> terrain_names;  // legend order, as are the two below
  std::vector<std::string> station_names;
  std::vector<std::string> goal_names;
  std::vector<std::string> absent;  // names that conditions may use although nothing is called so
  std::vector<Spot> starts;         // one in each MDP
  std::vector<Raster> rasters;
  std::vector<std::vector<std::uint16_t>> raster_grids;  // shape [?, cells]
  std::vector<std::uint32_t> raster_grid_of;             // shape [rasters, MDPs], indices into raster_grids
  Thinning thinning;
  std::vector<std::uint64_t> masks;      // of a thinned family: the groups that are on, per MDP; else empty
  std::vector<std::string> world_names;  // of a family whose worlds are listed, per MDP; else empty
  TomlPlace map_place;                   // of [map]
  TomlPlace source_place;                // of what the lowest layer is read from
  TomlPlace start_place;
  TomlPlace goal_place;                  // of a goal or destination
  std::vector<TomlPlace> row_places;     // of the strings in rows; empty: read from an image
  std::optional<std::size_t> some_goal;  // cell of a goal or destination, for messages
  bool is_picture = false;               // of an explicit model: it makes no states
  bool legend_is_sound = false;          // else names may be missing
  bool is_sound = false;                 // legend and rows

  [[nodiscard]] std::size_t num_cells() const { return symbol_of.size(); }
  [[nodiscard]] Cell cell_at(std::size_t index) const {
    const auto w = static_cast<std::size_t>(width);
    return {static_cast<int>(index % w) + 1, height - static_cast<int>(index / w)};
  }
  // Nothing if the cell is off the map.
  [[nodiscard]] std::optional<std::size_t> index_of(Cell cell) const {
    if (cell.x < 1 || cell.x > width || cell.y < 1 || cell.y > height) return std::nullopt;
    return static_cast<std::size_t>(height - cell.y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(cell.x - 1);
  }
  // Without thinning the groups that are on are the bits of the MDP's index. @pre at most 16 groups without thinning.
  [[nodiscard]] std::size_t num_mdps() const { return masks.empty() ? std::size_t{1} << groups.size() : masks.size(); }
  [[nodiscard]] std::uint64_t bit_of(std::size_t group) const {
    return std::uint64_t{1} << (groups.size() - 1 - group);
  }
  [[nodiscard]] std::uint64_t mask(std::size_t mdp) const { return masks.empty() ? mdp : masks[mdp]; }
  [[nodiscard]] bool is_on(std::size_t group, std::size_t mdp) const { return (mask(mdp) & bit_of(group)) != 0; }
  [[nodiscard]] bool is_there(std::int32_t group, std::size_t mdp) const {
    return group < 0 || is_on(static_cast<std::size_t>(group), mdp);
  }
  // The cell in MDP `mdp`, if any.
  [[nodiscard]] std::optional<std::size_t> find(const std::vector<Spot>& spots, std::size_t mdp) const {
    for (const Spot& spot : spots) {
      if (is_there(spot.group, mdp)) return spot.cell;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::size_t start_in(std::size_t mdp) const { return find(starts, mdp).value_or(0); }
  // The things on the cell, of all layers.
  [[nodiscard]] std::vector<MapThing> things_on(std::size_t cell) const;
  // Those that are there in MDP `mdp`, taken together, and areas that are drawn.
  [[nodiscard]] SymbolContent content_in(std::size_t cell, std::size_t mdp) const;
  [[nodiscard]] std::uint16_t raster_value(std::size_t raster, std::size_t cell, std::size_t mdp) const {
    return raster_grids[raster_grid_of[raster * num_mdps() + mdp]][cell];
  }
};

// "(3,1)": column and row from the top left, as in all messages.
[[nodiscard]] std::string cell_text(const FamilyMap& family_map, std::size_t cell);
// The optional things of MDP `mdp`: "rubble@{(2,1),(2,2)} charger@{}".
[[nodiscard]] std::string world_text(const FamilyMap& family_map, std::size_t mdp);
// What people call the thing a symbol stands for: its terrain, station, item, ...
[[nodiscard]] std::string symbol_name(const Symbol& symbol);

// What names of terrains, stations, items and goals are made of, so that conditions can say them.
[[nodiscard]] constexpr bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

// Several things on one cell. A wall hides the others; terrains are named together: "rubble and smoke".
[[nodiscard]] SymbolContent together(const std::vector<const SymbolContent*>& contents);

// What conditions and rasters call the things of a symbol.
[[nodiscard]] bool is_called(const SymbolContent& content, const std::string& name);

// Reads the symbols of [map.legend] and the names that they declare.
void read_legend(const TomlTable& legend, FamilyMap& family_map, TomlReport& report);

// Reads [map], its layers and rasters, and [family]. Reports everything that is wrong.
[[nodiscard]] FamilyMap read_world(TomlReader& file, NamedFiles& files, ModelReport& report);

// Reads [map] as the picture of an explicit model: it needs no start and no end, and what is optional is there in the
// MDP of that name. The worlds are not known yet.
[[nodiscard]] FamilyMap read_picture(TomlReader& file, NamedFiles& files, ModelReport& report);

// Where cell `cell` of the lowest layer stands in the file.
[[nodiscard]] TomlPlace place_of_cell(const FamilyMap& family_map, std::size_t cell);

}  // namespace kith::detail
