#include "legend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace kith::cli {
namespace {

// What one cell shows apart from the robot.
struct Shown {
  CellContent content;
  bool station = false;
  std::vector<std::size_t> items;  // by number in Domain::item_names()
  friend bool operator<(const Shown& a, const Shown& b) {
    const auto key = [](const Shown& s) {
      return std::tie(s.content.wall, s.content.goal, s.content.terrain, s.content.destination_of, s.station, s.items);
    };
    return key(a) < key(b);
  }
  [[nodiscard]] bool is_floor() const {
    return !content.wall && !content.goal && content.terrain.empty() && content.destination_of.empty() && !station &&
           items.empty();
  }
};

Shown shown(const Domain& domain, MdpIndex m, const GridState& state, const Cell& cell, bool with_items) {
  Shown result;
  result.content = domain.content(m, cell);
  result.station = std::find(state.stations.begin(), state.stations.end(), cell) != state.stations.end();
  const auto numbers = domain.items_in(m);
  for (std::size_t i = 0; with_items && i < numbers.size(); ++i) {
    if (state.items[i] == cell) result.items.push_back(numbers[i]);
  }
  return result;
}

char glyph_at(const Picture& picture, const Cell& cell) {
  return picture[picture.size() - static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x - 1)];
}

template <typename Visit>
void for_each_cell(const Domain& domain, const Visit& visit) {
  for (int y = domain.height(); y >= 1; --y) {
    for (int x = 1; x <= domain.width(); ++x) visit(Cell{x, y});
  }
}

// The symbols of the first and the last MDP: nothing optional, and everything.
std::map<Shown, char> glyphs(const Domain& domain) {
  std::map<Shown, char> result;
  for (const std::size_t number : {std::size_t{0}, domain.num_mdps() - 1}) {
    const MdpIndex m{number};
    const auto picture = domain.draw(m, std::nullopt);
    const auto state = domain.state(m, domain.initial_state(m));
    for_each_cell(domain, [&](const Cell& cell) {
      // A start on plain floor has a symbol of its own, which is not that of floor.
      const auto what = shown(domain, m, state, cell, true);
      if (!(what.is_floor() && cell == state.robot)) result.emplace(what, glyph_at(picture, cell));
    });
  }
  return result;
}

// The station's name, if it is optional: "rubble@{(2,1)} charger@{(4,1)}".
std::string station_name(const Domain& domain, MdpIndex m, const Cell& cell) {
  const auto text = domain.describe_variant(m);
  const auto place = text.find(fmt::format("({},{})", cell.x, domain.height() + 1 - cell.y));
  if (place == std::string::npos) return "station";
  const auto at = text.rfind('@', place);
  if (at == std::string::npos) return "station";
  const auto begin = text.rfind(' ', at);
  return begin == std::string::npos ? text.substr(0, at) : text.substr(begin + 1, at - begin - 1);
}

std::string name_of(const Domain& domain, const Shown& what, const std::string& station) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " and ") + part; };
  if (what.content.wall) add("wall");
  if (!what.content.terrain.empty()) add(what.content.terrain);
  if (what.station) add(station);
  if (!what.content.destination_of.empty()) add("destination of " + what.content.destination_of);
  if (what.content.goal) add("goal");
  for (const auto item : what.items) add(domain.item_names()[item] + " at its first place");
  return text.empty() ? "floor" : text;
}

}  // namespace

Picture bare_picture(const Domain& domain, DemoId id) {
  const auto known = glyphs(domain);
  const auto state = domain.state(id.mdp, id.start);
  const auto drawn = domain.draw(id.mdp, std::nullopt);
  Picture picture = drawn;
  for_each_cell(domain, [&](const Cell& cell) {
    const auto what = shown(domain, id.mdp, state, cell, false);
    const auto found = known.find(what);
    const char glyph = found != known.end() ? found->second : what.is_floor() ? ' ' : glyph_at(drawn, cell);
    picture[picture.size() - static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x - 1)] = glyph;
  });
  return picture;
}

std::string legend(const Domain& domain, std::size_t indent) {
  std::string symbols;
  for (const std::size_t number : {domain.num_mdps() - 1, std::size_t{0}}) {
    const MdpIndex m{number};
    const auto picture = domain.draw(m, std::nullopt);
    const auto state = domain.state(m, domain.initial_state(m));
    for_each_cell(domain, [&](const Cell& cell) {
      const auto what = shown(domain, m, state, cell, true);
      const auto name = what.is_floor() && cell == state.robot
                            ? "first start"
                            : name_of(domain, what, what.station ? station_name(domain, m, cell) : "");
      const auto entry = fmt::format("{} {}", glyph_at(picture, cell), name);
      if (("   " + symbols + "   ").find("   " + entry + "   ") != std::string::npos) return;
      symbols += (symbols.empty() ? "" : "   ") + entry;
    });
  }
  const std::string blank(indent, ' ');
  const std::string item = domain.item_names().empty() ? "" : "   * item elsewhere than at first";
  return blank + symbols + "\n" + blank + "@ robot" + item + "   ^ v < > moves   o end of a leg\n";
}

}  // namespace kith::cli
