#pragma once

#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/explain/surfaces.hpp"
#include "kith/explain/svg.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// Draws maps of one domain, which has to stay: what stands on the cells, and what is marked on them.
class BoardSvg {
 public:
  explicit BoardSvg(const GridMap& map);

  [[nodiscard]] double width() const;   ///< With the numbers of the rows.
  [[nodiscard]] double height() const;  ///< With the numbers of the columns.

  /// The map of an MDP as it is in a state. `bare`, to be written on: without the robot, things small and in a corner.
  [[nodiscard]] Svg board(MdpIndex m, const GridState& state, bool bare = false) const;
  /// A path, to be added on top of a board. Where it goes round for ever, an arrow that bends back marks where.
  [[nodiscard]] Svg path(MdpIndex m, const Trajectory& path, const std::string& color, bool dashed = false) const;
  /// What the robot does at a cell: an arrow, or the action's name.
  void action(Svg& svg, const Cell& cell, const std::string& name) const;
  /// A number on a cell whose ground is darker the larger it is. @param share  of the largest, in [0, 1].
  void number(Svg& svg, const Cell& cell, std::size_t number, double share) const;

  /// The signs on the boards, with their names, in lines of this width. Returns how high it is.
  double legend(Svg& svg, double x, double y, double line_width) const;

 private:
  struct Point {
    double x = 0.0, y = 0.0;
  };
  [[nodiscard]] Point centre(const Cell& cell) const;
  // Around (0, 0).
  [[nodiscard]] Svg terrain(const std::string& name) const;
  [[nodiscard]] Svg item(const std::string& name) const;
  [[nodiscard]] Svg station(const std::string& name) const;
  [[nodiscard]] Svg destination(const std::string& name) const;
  [[nodiscard]] Svg goal(const std::string& name) const;
  [[nodiscard]] Svg robot() const;
  void fences(Svg& svg, MdpIndex m) const;
  void contents(Svg& svg, MdpIndex m, const GridState& state, bool is_small) const;
  void grid(Svg& svg) const;
  [[nodiscard]] std::string letters(const std::string& name) const;

  GridMap map_;
  std::vector<Surface> surfaces_;
  std::vector<std::string> things_;   // stations, items and named goals
  std::vector<std::string> letters_;  // of things_
};

}  // namespace kith
