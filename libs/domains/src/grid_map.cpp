#include "kith/domains/grid_map.hpp"

#include <algorithm>
#include <stdexcept>

#include "domain_data.hpp"

namespace kith {
namespace {

using detail::FamilyMap;
using detail::SymbolContent;

const DomainMember& member_of(const GridFamily& family, MdpIndex m, const char* function) {
  if (m.value() < family.members.size()) return family.members[m.value()];
  throw std::invalid_argument{std::string{function} + ": there is no MDP " + std::to_string(m.value())};
}

// The symbol that shows exactly `content`: the cell's own if it does, else the
// first of the legend that does; without one the cell's own, or a blank for floor.
char glyph_for(const FamilyMap& family_map, std::size_t cell, const SymbolContent& content) {
  const detail::Symbol& own = family_map.symbols[family_map.symbol_of[cell]];
  if (own.content == content) return own.glyph;
  for (const detail::Symbol& symbol : family_map.symbols) {
    if (symbol.content == content) return symbol.glyph;
  }
  return content.is_floor() ? ' ' : family_map.symbols[family_map.things_on(cell).back().symbol].glyph;
}

}  // namespace

GridMap::GridMap(const GridFamily& family) noexcept : family_{&family} {}
GridMap::GridMap(const ModelDrawing& drawing) noexcept : drawing_{&drawing} {}

const FamilyMap& GridMap::family_map() const noexcept {
  return drawing_ != nullptr ? drawing_->family_map : family_->family_map;
}

void GridMap::check_mdp(MdpIndex m, const char* function) const {
  if (drawing_ == nullptr) {
    (void)member_of(*family_, m, function);
  } else if (m.value() >= drawing_->members.size()) {
    throw std::invalid_argument{std::string{function} + ": there is no MDP " + std::to_string(m.value())};
  }
}

int GridMap::width() const noexcept { return family_map().width; }
int GridMap::height() const noexcept { return family_map().height; }
const std::vector<std::string>& GridMap::item_names() const noexcept {
  return drawing_ != nullptr ? drawing_->things : family_->item_names;
}

std::vector<LegendEntry> GridMap::legend() const {
  std::vector<LegendEntry> entries;
  for (const detail::Symbol& symbol : family_map().symbols) {
    const detail::SymbolContent& content = symbol.content;
    entries.push_back({symbol.glyph,
                       {content.wall, content.goal, content.terrain, content.destination},
                       content.goal_name,
                       content.station,
                       content.item,
                       content.start,
                       symbol.is_optional()});
  }
  return entries;
}

std::size_t GridMap::legend_index(Cell cell) const {
  const auto index = family_map().index_of(cell);
  if (!index) throw std::invalid_argument{"GridMap::legend_index: the cell is off the map"};
  // What has a name of its own is looked up here: stations and goals.
  const FamilyMap& all = family_map();
  std::size_t found = all.symbol_of[*index];
  for (const detail::MapThing& thing : all.things_on(*index)) {
    const auto has_name = [&](std::size_t symbol) {
      const SymbolContent& content = all.symbols[symbol].content;
      return content.goal || !content.station.empty();
    };
    if (!has_name(found) || has_name(thing.symbol)) found = thing.symbol;
  }
  return found;
}

CellContent GridMap::content(MdpIndex m, Cell cell) const {
  check_mdp(m, "GridMap::content");
  const auto index = family_map().index_of(cell);
  if (!index) throw std::invalid_argument{"GridMap::content: the cell is off the map"};
  const detail::SymbolContent content = family_map().content_in(*index, m.value());
  return {content.wall, content.goal, content.terrain, content.destination};
}

std::vector<std::size_t> GridMap::items_in(MdpIndex m) const {
  std::vector<std::size_t> items;
  check_mdp(m, "GridMap::items_in");
  if (drawing_ != nullptr) {
    for (std::size_t i = 0; i < drawing_->things.size(); ++i) items.push_back(i);
    return items;
  }
  const DomainMember& member = family_->members[m.value()];
  for (std::size_t i = 0; i < member.item_present.size(); ++i) {
    if (member.item_present[i]) items.push_back(i);
  }
  return items;
}

GridState GridMap::drawn_state(MdpIndex m, StateIndex s) const {
  check_mdp(m, "GridMap::state");
  const DrawnMember& member = drawing_->members[m.value()];
  if (s.value() >= member.by_look.size()) {
    throw std::invalid_argument{"GridMap::state: there is no state " + std::to_string(s.value())};
  }
  const std::uint32_t* look = member.looks.data() + s.value() * drawing_->look_size();
  const FamilyMap& all = family_map();
  GridState state;
  state.robot = all.cell_at(*look++);
  for (std::size_t i = 0; i < drawing_->things.size(); ++i) {
    state.items.push_back(all.cell_at(*look++));
    state.carried.push_back(*look++ != 0);
  }
  for (const detail::Station& station : all.stations) {
    if (!all.content_in(station.cell, m.value()).station.empty()) state.stations.push_back(all.cell_at(station.cell));
  }
  return state;
}

std::optional<StateIndex> GridMap::find_drawn(MdpIndex m, const GridState& state) const {
  check_mdp(m, "GridMap::find_state");
  const DrawnMember& member = drawing_->members[m.value()];
  const std::size_t size = drawing_->look_size();
  if (state.items.size() != drawing_->things.size() || state.carried.size() != state.items.size()) return std::nullopt;
  std::vector<std::uint32_t> look;
  const auto add_cell = [&](const Cell& cell) {
    const auto index = family_map().index_of(cell);
    look.push_back(index ? static_cast<std::uint32_t>(*index) : static_cast<std::uint32_t>(family_map().num_cells()));
  };
  add_cell(state.robot);
  for (std::size_t i = 0; i < state.items.size(); ++i) {
    add_cell(state.items[i]);
    look.push_back(state.carried[i] ? 1 : 0);
  }
  const auto row = [&](std::uint32_t s) { return member.looks.begin() + static_cast<std::ptrdiff_t>(s * size); };
  const auto end = static_cast<std::ptrdiff_t>(size);
  const auto found =
      std::lower_bound(member.by_look.begin(), member.by_look.end(), look, [&](std::uint32_t s, const auto& key) {
        return std::lexicographical_compare(row(s), row(s) + end, key.begin(), key.end());
      });
  if (found == member.by_look.end() || !std::equal(look.begin(), look.end(), row(*found))) return std::nullopt;
  return StateIndex{*found};
}

std::vector<std::pair<Cell, Cell>> GridMap::fences(MdpIndex m) const {
  check_mdp(m, "GridMap::fences");
  return drawing_ != nullptr ? drawing_->members[m.value()].fences : std::vector<std::pair<Cell, Cell>>{};
}

// The rows of a picture, with what the MDP has.
std::vector<std::string> GridMap::drawn_rows(MdpIndex m) const {
  check_mdp(m, "GridMap::draw");
  const FamilyMap& all = family_map();
  std::vector<std::string> rows(static_cast<std::size_t>(all.height));
  for (std::size_t cell = 0; cell < all.num_cells(); ++cell) {
    rows[cell / static_cast<std::size_t>(all.width)] += glyph_for(all, cell, all.content_in(cell, m.value()));
  }
  return rows;
}

// Things of a picture where a state has them: destinations, unless `bare` what can be carried, and the robot.
void GridMap::place_things(MdpIndex m, const GridState& now, bool bare, std::vector<std::string>& rows) const {
  const auto put = [&](const Cell& cell, char glyph) {
    rows[static_cast<std::size_t>(family_map().height - cell.y)][static_cast<std::size_t>(cell.x - 1)] = glyph;
  };
  for (const bool is_item : {false, true}) {
    if (bare && is_item) return;
    for (const std::size_t i : items_in(m)) {
      const detail::Symbol& symbol = family_map().symbols[drawing_->symbol_of_thing[i]];
      if (symbol.content.item.empty() != is_item) put(now.items[i], symbol.glyph);
    }
  }
  put(now.robot, '@');
}

GridState GridMap::state(MdpIndex m, StateIndex s) const {
  if (drawing_ != nullptr) return drawn_state(m, s);
  const DomainMember& member = member_of(*family_, m, "GridMap::state");
  if (s.value() >= member.states.size()) {
    throw std::invalid_argument{"GridMap::state: there is no state " + std::to_string(s.value())};
  }
  const detail::PackedState packed = member.states[s.value()];
  const detail::FamilyMap& family_map = family_->family_map;
  GridState state;
  state.robot = family_map.cell_at(family_->layout.robot(packed));
  for (std::size_t i = 0; i < member.item_present.size(); ++i) {
    if (!member.item_present[i]) continue;
    state.items.push_back(family_map.cell_at(family_->layout.item(packed, i)));
    state.carried.push_back(family_->layout.carried(packed) == i + 1);
  }
  for (std::size_t i = 0; i < family_map.stations.size(); ++i) {
    if (family_->layout.has_station(packed, i))
      state.stations.push_back(family_map.cell_at(family_map.stations[i].cell));
  }
  state.exited = family_->layout.exited(packed);
  return state;
}

std::optional<StateIndex> GridMap::find_state(MdpIndex m, const GridState& state) const {
  if (drawing_ != nullptr) return find_drawn(m, state);
  const DomainMember& member = member_of(*family_, m, "GridMap::find_state");
  const detail::FamilyMap& family_map = family_->family_map;
  const auto robot = family_map.index_of(state.robot);
  const std::vector<std::size_t> items = items_in(m);
  if (!robot || state.items.size() != items.size() || state.carried.size() != items.size()) return std::nullopt;
  detail::PackedState packed = family_->layout.with_robot(0, *robot);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto cell = family_map.index_of(state.items[i]);
    if (!cell) return std::nullopt;
    packed = family_->layout.with_item(packed, items[i], *cell);
    if (state.carried[i]) packed = family_->layout.with_carried(packed, items[i] + 1);
  }
  std::uint64_t stations = 0;
  for (std::size_t i = 0; i < family_map.stations.size(); ++i) {
    const Cell cell = family_map.cell_at(family_map.stations[i].cell);
    if (std::ranges::find(state.stations, cell) != state.stations.end()) stations |= std::uint64_t{1} << i;
  }
  packed = family_->layout.with_stations(packed, stations);
  if (state.exited) packed = family_->layout.with_exit(packed);

  const auto it =
      std::ranges::lower_bound(member.by_state, packed, {}, [&](std::uint32_t s) { return member.states[s]; });
  // Comparing the whole state also refuses what the packing cannot express.
  if (it == member.by_state.end() || this->state(m, StateIndex{*it}) != state) return std::nullopt;
  return StateIndex{*it};
}

std::vector<std::string> GridMap::draw(MdpIndex m, std::optional<StateIndex> s) const {
  if (drawing_ != nullptr) {
    std::vector<std::string> rows = drawn_rows(m);
    if (s) place_things(m, state(m, *s), false, rows);
    return rows;
  }

  const FamilyMap& family_map = family_->family_map;
  const GridState now = s ? state(m, *s) : GridState{};
  const std::vector<std::size_t> items = items_in(m);
  std::vector<std::string> rows(static_cast<std::size_t>(family_map.height));
  for (std::size_t cell = 0; cell < family_map.num_cells(); ++cell) {
    const Cell at = family_map.cell_at(cell);
    SymbolContent content = family_map.content_in(cell, m.value());
    bool moved_here = false;
    if (s) {
      content.start = false;
      content.carried = false;
      if (std::ranges::find(now.stations, at) == now.stations.end()) content.station.clear();
      for (std::size_t i = 0; i < items.size(); ++i) {
        const std::string& name = family_->item_names[items[i]];
        if (now.items[i] != at && content.item == name) content.item.clear();
        moved_here = moved_here || (now.items[i] == at && content.item != name);
      }
    }
    char glyph = glyph_for(family_map, cell, content);
    if (moved_here) glyph = '*';
    if (s && now.robot == at) glyph = '@';
    rows[cell / static_cast<std::size_t>(family_map.width)] += glyph;
  }
  return rows;
}

std::vector<std::string> GridMap::draw_bare(MdpIndex m, StateIndex s) const {
  if (drawing_ != nullptr) {
    std::vector<std::string> rows = drawn_rows(m);
    place_things(m, state(m, s), true, rows);
    return rows;
  }
  const FamilyMap& family_map = family_->family_map;
  const GridState now = state(m, s);
  std::vector<std::string> rows(static_cast<std::size_t>(family_map.height));
  for (std::size_t cell = 0; cell < family_map.num_cells(); ++cell) {
    SymbolContent content = family_map.content_in(cell, m.value());
    content.start = false;
    content.carried = false;
    content.item.clear();
    if (std::ranges::find(now.stations, family_map.cell_at(cell)) == now.stations.end()) content.station.clear();
    rows[cell / static_cast<std::size_t>(family_map.width)] += glyph_for(family_map, cell, content);
  }
  return rows;
}

}  // namespace kith
