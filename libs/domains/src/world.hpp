#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/toml/reader.hpp"

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

// Cells that are there or not together: one bit of a variant.
struct CellGroup {
  std::vector<std::size_t> cells;
};

struct Item {
  std::string name;
  std::optional<std::size_t> home;  // cell; nothing if the symbol is not on the map
  bool has_destination = false;
};

struct Station {
  std::string name;
  std::size_t cell = 0;
};

// What a file says about how much of its family is built.
struct Thinning {
  std::optional<std::size_t> worlds;  // nothing: every combination of optional things
  std::uint64_t seed = 1;             // of the worlds that are drawn
  TomlPlace worlds_place;             // of `worlds`, if given
  std::optional<std::size_t> starts;  // per world; nothing: every state
};

// The map with everything optional on it. Cells are numbered in reading order:
// top row first, left to right.
struct World {
  int width = 0;
  int height = 0;
  std::vector<Symbol> symbols;             // legend order
  std::vector<std::uint8_t> symbol_of;     // per cell, index into symbols
  std::vector<CellGroup> groups;           // index order, most significant first
  std::vector<std::int32_t> group_of;      // per cell; -1: always there
  std::vector<Item> items;                 // legend order
  std::vector<Station> stations;           // reading order
  std::vector<std::string> terrain_names;  // legend order, as are the two below
  std::vector<std::string> station_names;
  std::vector<std::string> goal_names;
  std::size_t start = 0;
  Thinning thinning;
  std::vector<std::uint64_t> variants;   // of a thinned family: the groups that are on, per MDP; else empty
  TomlPlace map_place;                   // of [map]
  std::vector<TomlPlace> row_places;     // of the strings in rows
  std::optional<std::size_t> some_goal;  // cell of a goal or destination, for messages
  bool legend_is_sound = false;          // else names may be missing
  bool is_sound = false;                 // legend and rows

  [[nodiscard]] std::size_t num_cells() const { return symbol_of.size(); }
  [[nodiscard]] const SymbolContent& content(std::size_t cell) const { return symbols[symbol_of[cell]].content; }
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
  [[nodiscard]] std::size_t num_mdps() const {
    return variants.empty() ? std::size_t{1} << groups.size() : variants.size();
  }
  [[nodiscard]] std::uint64_t bit_of(std::size_t group) const {
    return std::uint64_t{1} << (groups.size() - 1 - group);
  }
  [[nodiscard]] std::uint64_t variant(std::size_t mdp) const { return variants.empty() ? mdp : variants[mdp]; }
  [[nodiscard]] bool is_on(std::size_t group, std::size_t mdp) const { return (variant(mdp) & bit_of(group)) != 0; }
  // Whether what is on the cell is there in MDP `mdp`.
  [[nodiscard]] bool is_present(std::size_t cell, std::size_t mdp) const {
    return group_of[cell] < 0 || is_on(static_cast<std::size_t>(group_of[cell]), mdp);
  }
};

// "(3,1)": column and row from the top left, as in all messages.
[[nodiscard]] std::string cell_text(const World& world, std::size_t cell);
// The optional things of MDP `mdp`: "rubble@{(2,1),(2,2)} charger@{}".
[[nodiscard]] std::string variant_text(const World& world, std::size_t mdp);
// What people call the thing a symbol stands for: its terrain, station, item, ...
[[nodiscard]] std::string symbol_name(const Symbol& symbol);

// What names of terrains, stations, items and goals are made of, so that conditions can say them.
[[nodiscard]] constexpr bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

// Reads the symbols of [map.legend] and the names that they declare.
void read_legend(const TomlTable& legend, World& world, TomlReport& report);

// Reads [map] and [map.legend]. Reports everything that is wrong.
[[nodiscard]] World read_world(TomlReader& file);

// Where cell `cell` stands in the file.
[[nodiscard]] TomlPlace place_of_cell(const World& world, std::size_t cell);

}  // namespace kith::detail
