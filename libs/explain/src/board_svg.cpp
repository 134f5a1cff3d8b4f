#include "kith/explain/board_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <string_view>

#include "drawing.hpp"
#include "kith/core/math.hpp"

namespace kith {
namespace {

constexpr double kCell = 40.0;
constexpr double kMargin = 22.0;
void add_once(std::vector<std::string>& all, const std::string& name) {
  if (!name.empty() && std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
}

// A terrain's texture on a whole cell around (0, 0): four by four tiles.
std::string marks_of(const detail::Texture& texture) {
  constexpr int kTiles = 4;
  const auto start = [](int tile) { return kCell * tile / kTiles - kCell / 2; };
  std::string marks;
  for (int row = 0; row < kTiles; ++row) {
    for (int column = 0; column < kTiles; ++column) {
      for (const auto& [x, y] : texture.at) {
        marks += "M" + svg_number(start(column) + x) + " " + svg_number(start(row) + y) + texture.path;
      }
    }
  }
  return marks;
}

std::string capital(const std::string& name, std::size_t n) {
  auto text = name.substr(0, n);
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

// A picture of a thing or, if there is none, its letters.
void sign(Svg& svg, const std::string& name, const std::string& letters, double size, double y = 0.0,
          const std::string& opacity = "1") {
  const auto& ink = detail::board_color("ink");
  const auto* icon = detail::icon_of(name);
  if (icon == nullptr) {
    svg.text(0, y + 0.3 * size, letters,
             {{"text-anchor", "middle"},
              {"font-size", svg_number(0.8 * size)},
              {"font-weight", "bold"},
              {"fill", ink},
              {"opacity", opacity}});
    return;
  }
  const bool is_filled = !icon->fill.empty();
  svg.add("path", {{"d", is_filled ? icon->fill : icon->line},
                   {"transform", fmt::format("translate(0 {}) scale({})", svg_number(y), svg_number(size / 16.0))},
                   {"fill", is_filled ? ink : "none"},
                   {"stroke", is_filled ? "none" : ink},
                   {"stroke-width", "1.6"},
                   {"stroke-linejoin", "round"},
                   {"opacity", opacity}});
}

void square(Svg& svg, double half, double rx, const std::string& fill, const std::string& dashes = "none") {
  svg.add("rect", {{"x", svg_number(-half)},
                   {"y", svg_number(-half)},
                   {"width", svg_number(2 * half)},
                   {"height", svg_number(2 * half)},
                   {"rx", svg_number(rx)},
                   {"fill", fill},
                   {"stroke", detail::board_color("ink")},
                   {"stroke-width", "1.5"},
                   {"stroke-dasharray", dashes}});
}

}  // namespace

BoardSvg::BoardSvg(const GridMap& map) : map_{map}, surfaces_{surfaces_of(map)} {
  for (const auto& entry : map.legend()) {
    add_once(things_, entry.station);
    add_once(things_, entry.item);
    add_once(things_, entry.goal_name);
  }
  for (const auto& name : things_) {
    const auto is_taken = [&](const std::string& sign) {
      return std::find(letters_.begin(), letters_.end(), sign) != letters_.end();
    };
    auto sign = capital(name, 1);
    if (is_taken(sign)) sign = capital(name, 2);
    if (is_taken(sign)) sign = capital(name, 1) + std::to_string(letters_.size());
    letters_.push_back(sign);
  }
}

double BoardSvg::width() const { return kMargin + kCell * map_.width() + 2.0; }
double BoardSvg::height() const { return kMargin + kCell * map_.height() + 2.0; }

BoardSvg::Point BoardSvg::centre(const Cell& cell) const {
  return {kMargin + (cell.x - 0.5) * kCell, kMargin + (map_.height() - cell.y + 0.5) * kCell};
}

std::string BoardSvg::letters(const std::string& name) const {
  const auto at = std::find(things_.begin(), things_.end(), name);
  return at == things_.end() ? "" : letters_[static_cast<std::size_t>(at - things_.begin())];
}

Svg BoardSvg::terrain(const std::string& name) const {
  const auto surface = std::ranges::find(surfaces_, name, &Surface::name);
  const auto tint = std::ranges::find(detail::tints(), surface->tint, &detail::Tint::name);
  const auto texture = std::ranges::find(detail::textures(), surface->pattern, &detail::Texture::name);
  Svg svg;
  svg.add("rect", {{"x", svg_number(-kCell / 2)},
                   {"y", svg_number(-kCell / 2)},
                   {"width", svg_number(kCell)},
                   {"height", svg_number(kCell)},
                   {"fill", tint->ground}});
  svg.add("path", {{"d", marks_of(*texture)},
                   {"fill", texture->is_filled ? tint->mark : "none"},
                   {"stroke", texture->is_filled ? "none" : tint->mark}});
  return svg;
}

Svg BoardSvg::item(const std::string& name) const {
  Svg svg;
  square(svg, 11, 5, detail::board_color("thing"));
  sign(svg, name, letters(name), 16);
  return svg;
}

Svg BoardSvg::station(const std::string& name) const {
  Svg svg;
  square(svg, 12, 4, detail::board_color("station"));
  sign(svg, name, letters(name), 17);
  return svg;
}

Svg BoardSvg::destination(const std::string& name) const {
  Svg svg;
  square(svg, 15, 6, detail::board_color("floor"), "4.5 3");
  sign(svg, name, letters(name), 18, 0.0, "0.4");
  return svg;
}

Svg BoardSvg::goal(const std::string& name) const {
  const auto& ink = detail::board_color("ink");
  Svg svg;
  svg.add("path", {{"d", "M-9 14V-14"}, {"stroke", ink}, {"stroke-width", "2.4"}});
  svg.add("path", {{"d", "M-9 -14H13L8 -6.5 13 1H-9Z"},
                   {"fill", detail::board_color("goal")},
                   {"stroke", ink},
                   {"stroke-width", "1.4"}});
  if (!name.empty()) sign(svg, name, letters(name), 14, -6.5);
  return svg;
}

Svg BoardSvg::robot() const {
  const auto& ink = detail::board_color("robot");
  const auto& floor = detail::board_color("floor");
  Svg svg;
  svg.add("path", {{"d", "M0 -10V-15"}, {"stroke", ink}, {"stroke-width", "2"}});
  svg.add("circle", {{"cy", "-15.5"}, {"r", "2.4"}, {"fill", ink}});
  svg.add("rect", {{"x", "-11"}, {"y", "-10"}, {"width", "22"}, {"height", "21"}, {"rx", "6"}, {"fill", ink}});
  for (const auto* eye : {"-4.6", "4.6"}) svg.add("circle", {{"cx", eye}, {"cy", "-2"}, {"r", "2.6"}, {"fill", floor}});
  svg.add("path", {{"d", "M-4 5.5h8"}, {"stroke", floor}, {"stroke-width", "1.8"}});
  return svg;
}

void BoardSvg::grid(Svg& svg) const {
  const double right = kMargin + kCell * map_.width();
  const double bottom = kMargin + kCell * map_.height();
  for (int x = 0; x <= map_.width(); ++x) {
    const double at = kMargin + kCell * x;
    const bool edge = x == 0 || x == map_.width();
    svg.line(at, kMargin, at, bottom, {{"stroke", edge ? detail::board_color("frame") : detail::board_color("grid")}});
    if (x > 0) {
      svg.text(at - kCell / 2, kMargin - 7, std::to_string(x),
               {{"text-anchor", "middle"}, {"font-size", "11"}, {"fill", detail::board_color("frame")}});
    }
  }
  for (int y = 0; y <= map_.height(); ++y) {
    const double at = kMargin + kCell * y;
    const bool edge = y == 0 || y == map_.height();
    svg.line(kMargin, at, right, at, {{"stroke", edge ? detail::board_color("frame") : detail::board_color("grid")}});
    if (y > 0) {
      svg.text(kMargin - 6, at - kCell / 2 + 4, std::to_string(y),
               {{"text-anchor", "end"}, {"font-size", "11"}, {"fill", detail::board_color("frame")}});
    }
  }
}

void BoardSvg::fences(Svg& svg, MdpIndex m) const {
  for (const auto& [a, b] : map_.fences(m)) {
    const auto from = centre(a);
    const auto to = centre(b);
    const double x = (from.x + to.x) / 2;
    const double y = (from.y + to.y) / 2;
    const double dx = (to.y - from.y) / 2;  // along the border
    const double dy = (to.x - from.x) / 2;
    svg.line(x - dx, y - dy, x + dx, y + dy,
             {{"stroke", detail::board_color("wall")}, {"stroke-width", "5"}, {"stroke-linecap", "round"}});
  }
}

// What stands on cells: where something is to be written over them, small and in a corner.
void BoardSvg::contents(Svg& svg, MdpIndex m, const GridState& state, bool is_small) const {
  const auto put = [&](const Cell& cell, const Svg& thing) {
    constexpr double kCorner = 11.5;
    const auto at = centre(cell);
    svg.add(at.x - (is_small ? kCorner : 0.0), at.y - (is_small ? kCorner : 0.0), thing, is_small ? 0.5 : 1.0);
  };
  for (int y = 1; y <= map_.height(); ++y) {
    for (int x = 1; x <= map_.width(); ++x) {
      const Cell cell{x, y};
      const auto at = centre(cell);
      const auto content = map_.content(m, cell);
      if (content.wall) {
        svg.add("rect", {{"x", svg_number(at.x - kCell / 2)},
                         {"y", svg_number(at.y - kCell / 2)},
                         {"width", svg_number(kCell)},
                         {"height", svg_number(kCell)},
                         {"fill", detail::board_color("wall")}});
      }
      if (!content.destination_of.empty()) put(cell, destination(content.destination_of));
      if (content.goal) put(cell, goal(map_.legend()[map_.legend_index(cell)].goal_name));
    }
  }
  for (const auto& cell : state.stations) put(cell, station(map_.legend()[map_.legend_index(cell)].station));
  const auto items = map_.items_in(m);
  constexpr std::string_view kDestination = "destination of ";
  for (const bool is_destination : {true, false}) {  // what is at its destination is drawn on top
    for (std::size_t i = 0; i < state.items.size(); ++i) {
      const auto& name = map_.item_names()[items[i]];
      if (state.carried[i] || name.starts_with(kDestination) != is_destination) continue;
      put(state.items[i], is_destination ? destination(name.substr(kDestination.size())) : item(name));
    }
  }
}

Svg BoardSvg::board(MdpIndex m, const GridState& state, bool bare) const {
  Svg svg;
  for (int y = 1; y <= map_.height(); ++y) {
    for (int x = 1; x <= map_.width(); ++x) {
      const auto content = map_.content(m, {x, y});
      const auto at = centre({x, y});
      if (!content.terrain.empty()) svg.add(at.x, at.y, terrain(content.terrain));
    }
  }
  grid(svg);
  fences(svg, m);
  contents(svg, m, state, bare);
  if (!bare) svg.add(centre(state.robot).x, centre(state.robot).y, robot());
  return svg;
}

Svg BoardSvg::path(MdpIndex m, const Trajectory& path, const std::string& color, bool dashed) const {
  Svg svg;
  constexpr double kLane = 3.5;  // to the right of the middle, so that ways there and back lie beside each other
  const double width = dashed ? 2.6 : 3.4;
  for (std::size_t t = 0; t + 1 < path.states.size(); ++t) {
    const auto from = centre(map_.state(m, path.states[t]).robot);
    const auto to = centre(map_.state(m, path.states[t + 1]).robot);
    const double dx = (to.x - from.x) / kCell;
    const double dy = (to.y - from.y) / kCell;
    if (dx == 0.0 && dy == 0.0) {
      svg.add("circle", {{"cx", svg_number(from.x)},
                         {"cy", svg_number(from.y)},
                         {"r", "16.5"},
                         {"fill", "none"},
                         {"stroke", color},
                         {"stroke-width", "2"}});
      continue;
    }
    const double x = -dy * kLane;
    const double y = dx * kLane;
    svg.line(from.x + x, from.y + y, to.x + x, to.y + y,
             {{"stroke", color},
              {"stroke-width", svg_number(width)},
              {"stroke-linecap", "round"},
              {"stroke-dasharray", dashed ? "6 5" : "none"}});
    const double angle = math::atan2(dy, dx) * 180.0 / std::numbers::pi;
    svg.add("path", {{"d", "M5 0L-4 -4.6V4.6Z"},
                     {"fill", color},
                     {"transform", fmt::format("translate({} {}) rotate({})", svg_number((from.x + to.x) / 2 + x),
                                               svg_number((from.y + to.y) / 2 + y), svg_number(angle))}});
  }
  if (path.repeats_from) {  // an arrow that bends back to where it begins: from here on again and again
    const auto at = centre(map_.state(m, path.states.back()).robot);
    const auto place = fmt::format("translate({} {})", svg_number(at.x + 13.0), svg_number(at.y - 13.0));
    svg.add("path", {{"d", "M5 0A5 5 0 1 1 2.5 -4.3"},
                     {"transform", place},
                     {"fill", "none"},
                     {"stroke", color},
                     {"stroke-width", "2"}});
    svg.add("path", {{"d", "M2 -8L6.5 -2.5L-0.5 -1.5Z"}, {"transform", place}, {"fill", color}});
  }
  return svg;
}

void BoardSvg::action(Svg& svg, const Cell& cell, const std::string& name) const {
  const auto at = centre(cell);
  static constexpr std::array<std::pair<std::string_view, int>, 4> kAngles{
      {{"right", 0}, {"down", 90}, {"left", 180}, {"up", 270}}};
  const auto move = std::find_if(kAngles.begin(), kAngles.end(), [&](const auto& one) { return one.first == name; });

  // What is no move is written out.
  if (move == kAngles.end()) {
    svg.add("rect", {{"x", svg_number(at.x - 19)},
                     {"y", svg_number(at.y + 7)},
                     {"width", "38"},
                     {"height", "12"},
                     {"rx", "3"},
                     {"fill", "#ffffff"},
                     {"fill-opacity", "0.85"}});
    svg.text(at.x, at.y + 16.5, name,
             {{"text-anchor", "middle"},
              {"font-size", "10"},
              {"font-weight", "bold"},
              {"fill", detail::board_color("own")}});
    return;
  }

  svg.add("path",
          {{"d", "M-12 0H8M2 -6L9 0L2 6"},
           {"transform", fmt::format("translate({} {}) rotate({})", svg_number(at.x), svg_number(at.y), move->second)},
           {"fill", "none"},
           {"stroke", detail::board_color("own")},
           {"stroke-width", "3"},
           {"stroke-linecap", "round"},
           {"stroke-linejoin", "round"}});
}

void BoardSvg::number(Svg& svg, const Cell& cell, std::size_t number, double share) const {
  const auto at = centre(cell);
  constexpr double kHalf = kCell / 2 - 3;
  svg.add("rect", {{"x", svg_number(at.x - kHalf)},
                   {"y", svg_number(at.y - kHalf)},
                   {"width", svg_number(2 * kHalf)},
                   {"height", svg_number(2 * kHalf)},
                   {"rx", "4"},
                   {"fill", detail::board_color("own")},
                   {"fill-opacity", svg_number(0.08 + 0.72 * share)}});
  svg.text(at.x, at.y + 5, std::to_string(number),
           {{"text-anchor", "middle"},
            {"font-size", "14"},
            {"font-weight", "bold"},
            {"fill", share > 0.55 ? detail::board_color("floor") : detail::board_color("ink")}});
}

double BoardSvg::legend(Svg& svg, double x, double y, double line_width) const {
  constexpr double kLine = 38.0;
  double column = 0.0;
  double row = 0.0;
  const auto entry = [&](const std::string& name, const Svg& sign) {
    const double width = 46.0 + svg_text_width(name, 13) + 12.0;
    if (column > 0.0 && column + width > line_width) {
      column = 0.0;
      row += kLine;
    }
    svg.add(x + column + 20.0, y + row + 20.0, sign);
    svg.text(x + column + 46.0, y + row + 24.5, name);
    column += width;
  };
  entry("robot", robot());
  if (std::ranges::any_of(map_.legend(), [](const LegendEntry& symbol) { return symbol.content.wall; })) {
    Svg wall;
    wall.add("rect",
             {{"x", "-14"}, {"y", "-14"}, {"width", "28"}, {"height", "28"}, {"fill", detail::board_color("wall")}});
    entry("wall", wall);
  }
  for (const auto& surface : surfaces_) entry(surface.name, terrain(surface.name));
  std::vector<std::string> known;
  const auto once = [&](const std::string& name, const Svg& sign) {
    if (name.empty() || std::ranges::find(known, name) != known.end()) return;
    known.push_back(name);
    entry(name, sign);
  };
  for (const auto& symbol : map_.legend()) {
    once(symbol.station, station(symbol.station));
    once(symbol.item, item(symbol.item));
    const auto& delivered = symbol.content.destination_of;
    if (!delivered.empty()) once("destination of " + delivered, destination(delivered));
    if (symbol.content.goal)
      once(symbol.goal_name.empty() ? "goal" : symbol.goal_name + " goal", goal(symbol.goal_name));
  }
  return row + kLine + 6.0;
}

}  // namespace kith
