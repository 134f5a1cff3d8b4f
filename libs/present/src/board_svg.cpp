#include "kith/present/board_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>

namespace kith {
namespace {

constexpr double kCell = 40.0;
constexpr double kMargin = 22.0;
constexpr const char* kInk = "#1c2127";

struct Tint {
  std::string_view name, ground, mark;
};
constexpr std::array<Tint, 9> kTints{{{"dark", "#4a525c", "#2b3138"},
                                      {"brown", "#e9dcc9", "#8f6f45"},
                                      {"blue", "#d3e4f7", "#5b8db8"},
                                      {"green", "#d9ecd9", "#5d9a64"},
                                      {"purple", "#e6dcf3", "#8d6fb5"},
                                      {"grey", "#e1e4e8", "#87909b"},
                                      {"orange", "#fbdcbf", "#c9762b"},
                                      {"red", "#f7d4d0", "#c25a50"},
                                      {"yellow", "#f8edc0", "#b39a3a"}}};

void add_once(std::vector<std::string>& all, const std::string& name) {
  if (!name.empty() && std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
}

const Tint& tint_called(std::string_view name) {
  return *std::find_if(kTints.begin(), kTints.end(), [&](const Tint& tint) { return tint.name == name; });
}

// A mark of a texture around (x, y).
std::string mark_of(std::string_view pattern, double x, double y) {
  const auto at = [&](double dx, double dy) { return "M" + svg_number(x + dx) + " " + svg_number(y + dy); };
  if (pattern == "dots") return at(-0.8, -0.8) + "h1.6v1.6h-1.6z";
  if (pattern == "lines") return at(-2, 2) + "l4 -4";
  if (pattern == "cross") return at(-3, 0) + "h6" + at(0, -3) + "v6";
  return at(-5, 0) + "q2.5 -3 5 0t5 0";
}

std::string capital(const std::string& name, std::size_t n) {
  auto text = name.substr(0, n);
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

void centred(Svg& svg, double x, double y, const std::string& words, double size) {
  svg.text(x, y + 0.36 * size, words,
           {{"text-anchor", "middle"}, {"font-size", svg_number(size)}, {"font-weight", "bold"}, {"fill", kInk}});
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

void BoardSvg::terrain(Svg& svg, const Point& at, const std::string& name) const {
  const auto surface =
      std::find_if(surfaces_.begin(), surfaces_.end(), [&](const Surface& one) { return one.name == name; });
  const auto& tint = tint_called(surface->tint);
  const double half = kCell / 2;
  svg.add("rect", {{"x", svg_number(at.x - half)},
                   {"y", svg_number(at.y - half)},
                   {"width", svg_number(kCell)},
                   {"height", svg_number(kCell)},
                   {"fill", std::string{tint.ground}}});
  std::string marks;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double shift = surface->pattern == "dots" ? (j % 2) * 3.0 : 0.0;
      marks += mark_of(surface->pattern, at.x - half + 5.0 + 10.0 * i + shift, at.y - half + 5.0 + 10.0 * j);
    }
  }
  svg.add("path", {{"d", marks},
                   {"fill", surface->pattern == "dots" ? std::string{tint.mark} : "none"},
                   {"stroke", std::string{tint.mark}}});
}

void BoardSvg::disc(Svg& svg, const Point& at, const std::string& sign) const {
  svg.add("circle", {{"cx", svg_number(at.x)},
                     {"cy", svg_number(at.y)},
                     {"r", "10.5"},
                     {"fill", "#cfe6d8"},
                     {"stroke", kInk},
                     {"stroke-width", "1.5"}});
  centred(svg, at.x, at.y, sign, 12);
}

void BoardSvg::station(Svg& svg, const Point& at, const std::string& sign) const {
  svg.add("rect", {{"x", svg_number(at.x - 12)},
                   {"y", svg_number(at.y - 12)},
                   {"width", "24"},
                   {"height", "24"},
                   {"rx", "4"},
                   {"fill", "#ffe08a"},
                   {"stroke", kInk},
                   {"stroke-width", "1.5"}});
  centred(svg, at.x, at.y, sign, 13);
}

void BoardSvg::destination(Svg& svg, const Point& at, const std::string& sign) const {
  for (const double r : {14.5, 10.5}) {
    svg.add("circle", {{"cx", svg_number(at.x)},
                       {"cy", svg_number(at.y)},
                       {"r", svg_number(r)},
                       {"fill", "#ffffff"},
                       {"stroke", kInk},
                       {"stroke-width", "1.5"},
                       {"stroke-dasharray", r > 12 ? "3 2.2" : "none"}});
  }
  centred(svg, at.x, at.y, sign, 12);
}

void BoardSvg::goal(Svg& svg, const Point& at, const std::string& sign) const {
  svg.add("path", {{"d", fmt::format("M{0} {1}v-28", svg_number(at.x - 9), svg_number(at.y + 14))},
                   {"stroke", kInk},
                   {"stroke-width", "2.4"}});
  svg.add("path", {{"d", fmt::format("M{} {}h22l-5 7.5l5 7.5h-22z", svg_number(at.x - 9), svg_number(at.y - 14))},
                   {"fill", "#b9e2c6"},
                   {"stroke", kInk},
                   {"stroke-width", "1.4"}});
  centred(svg, at.x - 1, at.y - 6.5, sign, 11);
}

void BoardSvg::robot(Svg& svg, const Point& at) const {
  const auto x = [&](double by) { return svg_number(at.x + by); };
  const auto y = [&](double by) { return svg_number(at.y + by); };
  svg.add("path", {{"d", "M" + x(0) + " " + y(-10) + "v-5"}, {"stroke", kInk}, {"stroke-width", "2"}});
  svg.add("circle", {{"cx", x(0)}, {"cy", y(-15.5)}, {"r", "2.4"}, {"fill", kInk}});
  svg.add("rect", {{"x", x(-11)},
                   {"y", y(-10)},
                   {"width", "22"},
                   {"height", "21"},
                   {"rx", "6"},
                   {"fill", kInk},
                   {"stroke", "#ffffff"}});
  for (const double eye : {-4.6, 4.6}) {
    svg.add("circle", {{"cx", x(eye)}, {"cy", y(-2)}, {"r", "2.6"}, {"fill", "#ffffff"}});
  }
  svg.add("path", {{"d", "M" + x(-4) + " " + y(5.5) + "h8"}, {"stroke", "#ffffff"}, {"stroke-width", "1.8"}});
}

void BoardSvg::grid(Svg& svg) const {
  const double right = kMargin + kCell * map_.width();
  const double bottom = kMargin + kCell * map_.height();
  for (int x = 0; x <= map_.width(); ++x) {
    const double at = kMargin + kCell * x;
    const bool edge = x == 0 || x == map_.width();
    svg.line(at, kMargin, at, bottom, {{"stroke", edge ? "#57606a" : "#d5d9de"}});
    if (x > 0) {
      svg.text(at - kCell / 2, kMargin - 7, std::to_string(x),
               {{"text-anchor", "middle"}, {"font-size", "11"}, {"fill", "#57606a"}});
    }
  }
  for (int y = 0; y <= map_.height(); ++y) {
    const double at = kMargin + kCell * y;
    const bool edge = y == 0 || y == map_.height();
    svg.line(kMargin, at, right, at, {{"stroke", edge ? "#57606a" : "#d5d9de"}});
    if (y > 0) {
      svg.text(kMargin - 6, at - kCell / 2 + 4, std::to_string(y),
               {{"text-anchor", "end"}, {"font-size", "11"}, {"fill", "#57606a"}});
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
             {{"stroke", "#3c444d"}, {"stroke-width", "5"}, {"stroke-linecap", "round"}});
  }
}

void BoardSvg::contents(Svg& svg, MdpIndex m, const GridState& state) const {
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
                         {"fill", "#3c444d"}});
      }
      if (!content.destination_of.empty()) destination(svg, at, letters(content.destination_of));
      if (content.goal) goal(svg, at, letters(map_.legend()[map_.legend_index(cell)].goal_name));
    }
  }
  for (const auto& cell : state.stations) {
    station(svg, centre(cell), letters(map_.legend()[map_.legend_index(cell)].station));
  }
  const auto items = map_.items_in(m);
  constexpr std::string_view kDestination = "destination of ";
  for (const bool is_destination : {true, false}) {  // what is at its destination is drawn on top
    for (std::size_t i = 0; i < state.items.size(); ++i) {
      const auto& name = map_.item_names()[items[i]];
      if (state.carried[i] || name.starts_with(kDestination) != is_destination) continue;
      if (is_destination) {
        destination(svg, centre(state.items[i]), letters(name.substr(kDestination.size())));
      } else {
        disc(svg, centre(state.items[i]), letters(name));
      }
    }
  }
}

Svg BoardSvg::board(MdpIndex m, const GridState& state, bool bare) const {
  Svg svg;
  for (int y = 1; y <= map_.height(); ++y) {
    for (int x = 1; x <= map_.width(); ++x) {
      const auto content = map_.content(m, {x, y});
      if (!content.terrain.empty()) terrain(svg, centre({x, y}), content.terrain);
    }
  }
  grid(svg);
  fences(svg, m);
  contents(svg, m, state);
  if (!bare) robot(svg, centre(state.robot));
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
    const double angle = std::atan2(dy, dx) * 180.0 / std::numbers::pi;
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
  if (move == kAngles.end()) {
    svg.add("rect", {{"x", svg_number(at.x - 19)},
                     {"y", svg_number(at.y + 7)},
                     {"width", "38"},
                     {"height", "12"},
                     {"rx", "3"},
                     {"fill", "#ffffff"},
                     {"fill-opacity", "0.85"}});
    svg.text(at.x, at.y + 16.5, name,
             {{"text-anchor", "middle"}, {"font-size", "10"}, {"font-weight", "bold"}, {"fill", "#0b5cad"}});
    return;
  }
  svg.add("path",
          {{"d", "M-12 0H8M2 -6L9 0L2 6"},
           {"transform", fmt::format("translate({} {}) rotate({})", svg_number(at.x), svg_number(at.y), move->second)},
           {"fill", "none"},
           {"stroke", "#0b5cad"},
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
                   {"fill", "#0b5cad"},
                   {"fill-opacity", svg_number(0.08 + 0.72 * share)}});
  svg.text(at.x, at.y + 5, std::to_string(number),
           {{"text-anchor", "middle"},
            {"font-size", "14"},
            {"font-weight", "bold"},
            {"fill", share > 0.55 ? "#ffffff" : kInk}});
}

double BoardSvg::legend(Svg& svg, double x, double y, double line_width) const {
  constexpr double kLine = 38.0;
  double column = 0.0;
  double row = 0.0;
  const auto entry = [&](const std::string& name, const auto& draw) {
    const double width = 46.0 + svg_text_width(name, 13) + 12.0;
    if (column > 0.0 && column + width > line_width) {
      column = 0.0;
      row += kLine;
    }
    Svg sign;
    draw(sign);
    svg.add(x + column + 20.0, y + row + 20.0, sign);
    svg.text(x + column + 46.0, y + row + 24.5, name);
    column += width;
  };
  constexpr Point middle{0.0, 0.0};
  entry("robot", [&](Svg& sign) { robot(sign, middle); });
  bool has_wall = false;
  std::vector<std::string> known;
  for (const auto& symbol : map_.legend()) has_wall = has_wall || symbol.content.wall;
  if (has_wall) {
    entry("wall", [&](Svg& sign) {
      sign.add("rect", {{"x", "-14"}, {"y", "-14"}, {"width", "28"}, {"height", "28"}, {"fill", "#3c444d"}});
    });
  }
  for (const auto& surface : surfaces_) entry(surface.name, [&](Svg& sign) { terrain(sign, middle, surface.name); });
  const auto once = [&](const std::string& name, const auto& draw) {
    if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return;
    known.push_back(name);
    entry(name, draw);
  };
  for (const auto& symbol : map_.legend()) {
    once(symbol.station, [&](Svg& sign) { station(sign, middle, letters(symbol.station)); });
    once(symbol.item, [&](Svg& sign) { disc(sign, middle, letters(symbol.item)); });
    if (!symbol.content.destination_of.empty()) {
      once("destination of " + symbol.content.destination_of,
           [&](Svg& sign) { destination(sign, middle, letters(symbol.content.destination_of)); });
    }
    if (symbol.content.goal) {
      once(symbol.goal_name.empty() ? "goal" : symbol.goal_name + " goal",
           [&](Svg& sign) { goal(sign, middle, letters(symbol.goal_name)); });
    }
  }
  return row + kLine + 6.0;
}

}  // namespace kith
