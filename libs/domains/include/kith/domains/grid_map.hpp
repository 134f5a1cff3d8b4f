#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kith/domains/cell.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith {

using MdpIndex = Index<struct MdpTag>;

/// One state of a gridworld, as people see it.
struct GridState {
  Cell robot;
  std::vector<Cell> items;     ///< Those of the MDP in declaration order; a carried item is at the robot's cell.
  std::vector<bool> carried;   ///< Per entry of items; at most one.
  std::vector<Cell> stations;  ///< Those still present, in reading order (top row first).
  bool exited = false;
  friend bool operator==(const GridState&, const GridState&) = default;
};

/// What a cell of one MDP's map holds apart from robot, items and stations.
struct CellContent {
  bool wall = false;
  bool goal = false;
  std::string terrain;         ///< Empty: plain floor.
  std::string destination_of;  ///< Item that belongs here; empty: none.
};

/// What a symbol of the legend puts on a cell.
struct LegendEntry {
  char symbol = '.';
  CellContent content;       ///< Wall, goal, terrain and destination.
  std::string goal_name;     ///< Empty: a goal without a name, or none.
  std::string station;       ///< Empty: none.
  std::string item;          ///< Empty: none.
  bool start = false;        ///< Where the robot first enters.
  bool is_optional = false;  ///< Whether some MDPs lack it.
};

struct GridFamily;
struct ModelDrawing;

namespace detail {
struct FamilyMap;
}

/// The map on which the MDPs of a domain are gridworlds: what its cells hold, what its states look like, and how it is
/// drawn; or, of an explicit model, a picture of it. A view: it refers to the Domain whose map() or drawing() it is. A
/// function that takes an MDP, a state or a cell throws
/// std::invalid_argument if there is none such.
class GridMap {
 public:
  explicit GridMap(const GridFamily& family) noexcept;
  explicit GridMap(const ModelDrawing& drawing) noexcept;

  /// Whether it is only a picture: states say where things are, and different states may look the same. Items are then
  /// everything that states place, also destinations, and stations stay.
  [[nodiscard]] bool is_picture() const noexcept { return drawing_ != nullptr; }

  [[nodiscard]] int width() const noexcept;
  [[nodiscard]] int height() const noexcept;
  [[nodiscard]] CellContent content(MdpIndex m, Cell cell) const;
  /// The symbols of the file, in its order.
  [[nodiscard]] std::vector<LegendEntry> legend() const;
  /// The symbol that the file draws at a cell: an index into legend(). MDPs may lack what it stands for.
  [[nodiscard]] std::size_t legend_index(Cell cell) const;
  /// Also for terminal states.
  [[nodiscard]] GridState state(MdpIndex m, StateIndex s) const;
  /// The inverse of state(); nothing if the MDP has no such state, and the first of several that look like this.
  [[nodiscard]] std::optional<StateIndex> find_state(MdpIndex m, const GridState& state) const;
  /// All items of the family, in declaration order; a destination that is placed by states is called "destination of
  /// ITEM".
  [[nodiscard]] const std::vector<std::string>& item_names() const noexcept;
  /// Which of item_names() MDP m has: entry i names GridState::items[i]. All, unless items are optional.
  [[nodiscard]] std::vector<std::size_t> items_in(MdpIndex m) const;

  /// Neighbouring cells of a picture between which a line is drawn, because no action leads from one to the other.
  [[nodiscard]] std::vector<std::pair<Cell, Cell>> fences(MdpIndex m) const;

  /// The map of MDP m as text, top row first, one row per string, in the
  /// symbols of the domain file; without `s` the initial picture, with it the
  /// robot as '@' and the things where they are in `s`.
  /// An item away from its first cell is drawn as '*', unless the robot is there. Pictures draw items as their symbols,
  /// and none without `s`.
  [[nodiscard]] std::vector<std::string> draw(MdpIndex m, std::optional<StateIndex> s) const;
  /// The same without the robot and the items: what stands on the map while the MDP is in state `s`.
  [[nodiscard]] std::vector<std::string> draw_bare(MdpIndex m, StateIndex s) const;

 private:
  [[nodiscard]] const detail::FamilyMap& family_map() const noexcept;
  void check_mdp(MdpIndex m, const char* function) const;
  [[nodiscard]] GridState drawn_state(MdpIndex m, StateIndex s) const;
  [[nodiscard]] std::optional<StateIndex> find_drawn(MdpIndex m, const GridState& state) const;
  [[nodiscard]] std::vector<std::string> drawn_rows(MdpIndex m) const;
  void place_things(MdpIndex m, const GridState& now, bool bare, std::vector<std::string>& rows) const;

  const GridFamily* family_ = nullptr;  // or
  const ModelDrawing* drawing_ = nullptr;
};

}  // namespace kith
