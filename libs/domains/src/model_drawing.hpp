#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kith/domains/family_map.hpp"
#include "kith/domains/grid_map.hpp"
#include "kith/domains/named_files.hpp"
#include "kith/domains/raw_model.hpp"
#include "kith/files/reader.hpp"

namespace kith {

struct ExplicitFamily;

// What the states of one MDP look like.
struct DrawnMember {
  std::vector<std::uint32_t> looks;    // row-major, shape [num_states + num_terminals, ModelDrawing::look_size()]
  std::vector<std::uint32_t> by_look;  // states, sorted by their rows
  std::vector<std::pair<Cell, Cell>> fences;
};

// A picture of an explicit model: a map, and where the robot and other things are on it in every state.
struct ModelDrawing {
  detail::FamilyMap family_map;
  std::vector<std::string> things;  // that states place, apart from the robot
  std::vector<std::uint8_t> symbol_of_thing;
  std::vector<DrawnMember> members;

  // The cell of the robot; for each thing its cell and whether it is carried.
  [[nodiscard]] std::size_t look_size() const { return 1 + 2 * things.size(); }
};

namespace detail {

// Where something is in a state: indices into the variables of the model.
struct DrawnThing {
  std::size_t x = 0;
  std::size_t y = 0;
  std::optional<std::size_t> carried;
};

// What a domain file says about the drawing of its model.
struct DrawingPlan {
  FamilyMap family_map;
  std::array<std::int64_t, 2> origin{1, 1};  // x and y of the top left cell
  bool has_walls = true;                     // whether lines are drawn where no action leads to the next cell
  DrawnThing robot;
  std::vector<DrawnThing> things;
  std::vector<std::string> names;     // of things
  std::vector<std::uint8_t> symbols;  // of things, indices into FamilyMap::symbols
  TomlPlace place;                    // of [model.drawing]
};

// Reads [model.drawing] and, as a picture, [map]. Where `columns` says that states are numbered row by row, they get
// their column and row as variables, and the map may be left out. Reports everything that is wrong, also states that
// are off the map; then the result is not complete.
[[nodiscard]] DrawingPlan read_drawing(TomlReader& file, TomlReader& drawing, RawModel& model, NamedFiles& files,
                                       ModelReport& model_report);

// Warns of states that look alike.
[[nodiscard]] ModelDrawing draw_model(DrawingPlan&& plan, const ExplicitFamily& family, TomlReport& report);

}  // namespace detail
}  // namespace kith
