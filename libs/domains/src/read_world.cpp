#include <algorithm>
#include <optional>
#include <unordered_map>

#include "kith/domains/family_map.hpp"
#include "kith/domains/layers.hpp"
#include "kith/domains/thinning.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMaxGroups = 16;         // every combination of them is an MDP
constexpr std::size_t kMaxThinnedGroups = 64;  // bits of a world

// Reads the layers and finds what stands where.
class MapReader {
 public:
  MapReader(FamilyMap& family_map, TomlReport& report, NamedFiles& files, ModelReport& model_report)
      : family_map_{family_map}, report_{report}, layers_{family_map, report, files, model_report} {}

  void read(TomlReader& map) {
    if (!layers_.read_base(map)) return;
    layers_.read_others(map);
    group_optional_things();
    find_things();
    for (const Symbol& symbol : family_map_.symbols) warn_if_unused(symbol);
  }

  // Once the MDPs are known: what depends on which things are there.
  void check_worlds() {
    if (family_map_.starts.size() > 1 || has_optional(family_map_.starts)) check_starts();
    for (const Item& item : family_map_.items) {
      if (item.homes.size() > 1) check_homes(item);
      if (item.carried) check_carried(item);
    }
  }

 private:
  void find_things() {
    find_in_base();
    for (const PaintedThing& painted : layers_.painted()) find(painted.thing, painted.place);
    std::stable_sort(family_map_.painted.begin(), family_map_.painted.end(),
                     [](const MapThing& a, const MapThing& b) { return a.cell < b.cell; });
    for (const PaintedThing& painted : layers_.painted()) check_shared(painted);
    std::stable_sort(family_map_.stations.begin(), family_map_.stations.end(),
                     [](const Station& a, const Station& b) { return a.cell < b.cell; });
    if (family_map_.starts.empty() && !family_map_.is_picture) {
      report_.error("E0206", family_map_.source_place, "the map has no start", "declare a symbol with start = true");
    }
  }

  void find_in_base() {
    for (std::size_t cell = 0; cell < family_map_.num_cells(); ++cell) {
      const MapThing thing{cell, family_map_.symbol_of[cell], family_map_.group_of[cell]};
      if (!family_map_.symbols[thing.symbol].content.is_floor()) find(thing, place_of_cell(family_map_, cell));
    }
  }

  void find(const MapThing& thing, const TomlPlace& place) {
    const SymbolContent& content = family_map_.symbols[thing.symbol].content;
    const auto always = [](const Spot& spot) { return spot.group < 0; };
    const Spot spot{thing.cell, thing.group};
    if (content.start && family_map_.is_picture) {
      // where the robot is drawn depends on the state
    } else if (content.start && always(spot) && std::ranges::any_of(family_map_.starts, always)) {
      report_.error("E0208", place, "there is a second start");
    } else if (content.start) {
      if (family_map_.starts.empty()) family_map_.start_place = place;
      family_map_.starts.push_back(spot);
    }
    if (!content.station.empty()) find_station(content.station, thing.cell, place);
    if ((content.goal || !content.destination.empty()) && !family_map_.some_goal) {
      family_map_.some_goal = thing.cell;
      family_map_.goal_place = place;
    }
    for (Item& item : family_map_.items) {
      if (item.name == content.destination) item.destinations.push_back(spot);
      if (item.name != content.item) continue;
      if (always(spot) && std::ranges::any_of(item.homes, always)) {
        report_.error("E0211", place, "item '" + item.name + "' lies on two cells");
      }
      item.homes.push_back(spot);
    }
  }

  void find_station(const std::string& name, std::size_t cell, const TomlPlace& place) {
    const auto [at, is_new] = station_at_.try_emplace(cell, name);
    if (is_new) {
      family_map_.stations.push_back({name, cell});
    } else if (at->second != name) {
      report_.error("E0270", place, "there is already the station '" + at->second + "' on this cell",
                    "put one of the two on another cell");
    }
  }

  // What is painted on a cell goes with what is there.
  void check_shared(const PaintedThing& painted) {
    const SymbolContent& content = family_map_.symbols[painted.thing.symbol].content;
    const std::vector<MapThing> things = family_map_.things_on(painted.thing.cell);

    const auto is_start = [&](const MapThing& thing) { return family_map_.symbols[thing.symbol].content.start; };
    const auto is_wall = [&](const MapThing& thing) { return family_map_.symbols[thing.symbol].content.wall; };
    const auto stands_always = [&](const MapThing& thing) { return is_wall(thing) && thing.group < 0; };
    if (std::ranges::any_of(things, is_start) && std::ranges::any_of(things, is_wall)) {
      report_.error("E0209", painted.place, "the robot cannot start on a wall");
      return;
    }

    const bool is_thing =
        !content.station.empty() || !content.item.empty() || content.goal || !content.destination.empty();
    const bool in_wall = std::ranges::any_of(things, stands_always);
    if (is_thing && in_wall) {
      report_.error("E0270", painted.place,
                    symbol_name(family_map_.symbols[painted.thing.symbol]) + " at " +
                        cell_text(family_map_, painted.thing.cell) + " is inside a wall",
                    "a wall that is always there cannot be entered; paint it on a free cell");
    }

    for (const MapThing& thing : things) {
      const std::string& other = family_map_.symbols[thing.symbol].content.destination;
      if (content.destination.empty() || other.empty() || other == content.destination) continue;
      report_.error("E0270", painted.place, "this cell is already the destination of '" + other + "'",
                    "put one of the two on another cell");
      break;
    }
  }

  // --- optional things ---

  void group_optional_things() {
    family_map_.group_of.assign(family_map_.num_cells(), -1);
    std::vector<std::vector<std::size_t>> cells_of(family_map_.symbols.size());
    for (std::size_t cell = 0; cell < family_map_.num_cells(); ++cell) {
      if (family_map_.symbols[family_map_.symbol_of[cell]].is_optional())
        cells_of[family_map_.symbol_of[cell]].push_back(cell);
    }
    for (std::size_t i = 0; i < family_map_.symbols.size(); ++i) {
      for (const std::size_t cell : cells_of[i]) {
        const std::size_t group = group_named(family_map_.symbols[i].toggle, family_map_.symbols[i].place);
        family_map_.groups[group].things.push_back(
            {cell, static_cast<std::uint8_t>(i), static_cast<std::int32_t>(group)});
        family_map_.group_of[cell] = static_cast<std::int32_t>(group);
      }
    }
    for (std::size_t layer = 0; layer < layers_.num_others(); ++layer) group_layer(layer);
    check_groups();
  }

  // Within a layer in legend order, and within a symbol in reading order, as in the lowest one.
  void group_layer(std::size_t layer) {
    std::vector<PaintedThing*> things;
    for (PaintedThing& painted : layers_.painted()) {
      if (painted.layer == layer) things.push_back(&painted);
    }
    std::stable_sort(things.begin(), things.end(),
                     [](const PaintedThing* a, const PaintedThing* b) { return a->thing.symbol < b->thing.symbol; });
    std::optional<std::size_t> of_layer;
    for (PaintedThing* painted : things) {
      const Symbol& symbol = family_map_.symbols[painted->thing.symbol];
      if (painted->toggle) {
        if (!of_layer) of_layer = group_named(*painted->toggle, painted->place);
        add(*painted, *of_layer);
      } else if (symbol.is_optional()) {
        add(*painted, group_named(symbol.toggle, painted->place));
      }
    }
    for (const PaintedThing& painted : layers_.painted()) {
      if (painted.layer == layer) family_map_.painted.push_back(painted.thing);
    }
  }

  void add(PaintedThing& painted, std::size_t group) {
    painted.thing.group = static_cast<std::int32_t>(group);
    family_map_.groups[group].things.push_back(painted.thing);
  }

  // The group of that name; a new one if there is none, or for no name.
  std::size_t group_named(const std::string& name, const TomlPlace& place) {
    if (!name.empty()) {
      const auto [at, is_new] = group_of_name_.try_emplace(name, family_map_.groups.size());
      if (!is_new) return at->second;
    }
    family_map_.groups.push_back({name, {}, place});
    return family_map_.groups.size() - 1;
  }

  void check_groups() {
    const std::string number = std::to_string(family_map_.groups.size());
    const bool builds_all =
        !family_map_.is_picture && !family_map_.thinning.worlds && family_map_.thinning.listed == nullptr;
    if (builds_all && family_map_.groups.size() > kMaxGroups) {
      report_.error("E0218", family_map_.source_place,
                    number + " optional things make about " + power_of_two() + " MDPs; at most 65536 are built",
                    "toggle cells together: optional = \"NAME\"; or build some of them: [family] worlds = NUMBER");
    } else if (family_map_.groups.size() > kMaxThinnedGroups) {
      report_.error("E0218", family_map_.source_place, number + " optional things; at most 64 are supported",
                    "toggle cells together: optional = \"NAME\"");
    }
  }

  [[nodiscard]] std::string power_of_two() const {
    const std::size_t n = family_map_.groups.size();
    return n < 60 ? std::to_string(std::size_t{1} << n) : "2^" + std::to_string(n);
  }

  // Walls and floor may be declared and not used; other things are there to be used.
  void warn_if_unused(const Symbol& symbol) {
    SymbolContent wall;
    wall.wall = true;
    const SymbolContent& content = symbol.content;
    if (content.is_floor() || content == wall) return;
    if (family_map_.is_picture && !(content.item.empty() && content.destination.empty())) return;  // placed by states
    const auto is_declared = [&](const std::string& name) { return is_called(content, name); };
    const auto number = static_cast<std::uint8_t>(&symbol - family_map_.symbols.data());
    const bool painted =
        std::ranges::any_of(family_map_.painted, [number](const MapThing& thing) { return thing.symbol == number; });
    const bool used = painted || std::ranges::find(family_map_.symbol_of, number) != family_map_.symbol_of.end();
    if (used || std::ranges::any_of(family_map_.absent, is_declared)) return;
    report_.warning("W0201", symbol.place, std::string{"symbol '"} + symbol.glyph + "' is nowhere on the map");
  }

  // --- what depends on the MDP ---

  static bool has_optional(const std::vector<Spot>& spots) {
    return std::ranges::any_of(spots, [](const Spot& spot) { return spot.group >= 0; });
  }

  [[nodiscard]] std::size_t number_there(const std::vector<Spot>& spots, std::size_t mdp) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(spots, [&](const Spot& spot) { return family_map_.is_there(spot.group, mdp); }));
  }

  [[nodiscard]] std::string in_world(std::size_t mdp) const {
    const std::string world = world_text(family_map_, mdp);
    return world.empty() ? "" : "in world " + world;
  }

  void check_starts() {
    for (std::size_t mdp = 0; mdp < family_map_.num_mdps(); ++mdp) {
      const std::size_t number = number_there(family_map_.starts, mdp);
      if (number == 1) continue;
      report_.error(number == 0 ? "E0206" : "E0208", family_map_.start_place,
                    number == 0 ? "some worlds have no start" : "some worlds have several starts", in_world(mdp));
      return;
    }
  }

  void check_homes(const Item& item) {
    for (std::size_t mdp = 0; mdp < family_map_.num_mdps(); ++mdp) {
      if (number_there(item.homes, mdp) < 2) continue;
      report_.error("E0211", family_map_.source_place, "in some worlds item '" + item.name + "' lies on two cells",
                    in_world(mdp));
      return;
    }
  }

  void check_carried(const Item& item) {
    for (std::size_t mdp = 0; mdp < family_map_.num_mdps(); ++mdp) {
      const auto home = family_map_.find(item.homes, mdp);
      if (!home) continue;
      if (*home != family_map_.start_in(mdp)) {
        report_.error("E0272", family_map_.source_place,
                      "item '" + item.name + "' is carried from the beginning, but is not where the robot starts",
                      "put both on one symbol: { start = true, item = \"" + item.name + "\", carried = true }");
        return;
      }
      const auto is_carried_too = [&](const Item& other) {
        return &other != &item && other.carried && family_map_.find(other.homes, mdp).has_value();
      };
      if (std::ranges::none_of(family_map_.items, is_carried_too)) continue;
      report_.error("E0272", family_map_.source_place, "the robot would carry two items from the beginning",
                    "it carries one at a time");
      return;
    }
  }

  FamilyMap& family_map_;
  TomlReport& report_;
  LayersReader layers_;
  std::unordered_map<std::size_t, std::string> station_at_;  // by cell
  std::unordered_map<std::string, std::size_t> group_of_name_;
};

void thin_out(FamilyMap& family_map, TomlReport& report) {
  const auto& worlds = family_map.thinning.worlds;
  if (!worlds) return;
  const std::size_t num_groups = family_map.groups.size();
  const std::size_t most = num_groups <= kMaxGroups ? std::size_t{1} << num_groups : *worlds;
  if (*worlds > most) {
    report.warning("W0203", family_map.thinning.worlds_place,
                   "there are only " + std::to_string(most) + " worlds, and all of them are built",
                   "make more things optional, or ask for fewer worlds");
  }
  family_map.masks = choose_masks(family_map, std::min(*worlds, most), family_map.thinning.seed);
}

// [map] absent = ["NAME", ...]
void read_absent(TomlReader& map, FamilyMap& family_map) {
  const auto names = map.strings("absent", Presence::kOptional);
  if (names) family_map.absent = *names;
}

void check_absent(const TomlReader& map, const FamilyMap& family_map, TomlReport& report) {
  const TomlValue* list = map.content().find("absent");
  if (list == nullptr || list->array() == nullptr) return;
  for (const TomlValue& element : *list->array()) {
    if (element.string() == nullptr) continue;
    const std::string& name = *element.string();
    const auto is_it = [&](std::size_t symbol) { return is_called(family_map.symbols[symbol].content, name); };
    const bool is_there =
        std::ranges::any_of(family_map.symbol_of, is_it) ||
        std::ranges::any_of(family_map.painted, [&](const MapThing& thing) { return is_it(thing.symbol); }) ||
        std::ranges::any_of(family_map.rasters, [&](const Raster& raster) { return raster.name == name; });
    if (is_there) {
      report.error("E0274", element.place(), "'" + name + "' is declared absent, but it is on the map",
                   "remove the name from 'absent'");
    }
  }
}

}  // namespace

FamilyMap read_world(TomlReader& file, NamedFiles& files, ModelReport& model_report) {
  FamilyMap family_map;
  auto map = file.table("map", Presence::kRequired);
  if (!map) return family_map;
  TomlReport& report = file.report();
  const std::size_t errors_before = report.num_errors();
  family_map.map_place = family_map.source_place = map->place();
  family_map.thinning = read_thinning(file);
  read_absent(*map, family_map);
  if (auto legend = map->table("legend", Presence::kRequired)) read_legend(legend->content(), family_map, report);
  family_map.legend_is_sound = report.num_errors() == errors_before;
  MapReader reader{family_map, report, files, model_report};
  reader.read(*map);
  read_rasters(*map, family_map, files, report, model_report);
  map->finish();
  const auto is_sound = [&] { return report.num_errors() == errors_before && !model_report.has_errors(); };
  if (is_sound()) {
    check_absent(*map, family_map, report);
    list_worlds(family_map, report);
    thin_out(family_map, report);
  }

  if (is_sound()) reader.check_worlds();
  if (is_sound()) compute_rasters(family_map, report);
  if (is_sound()) name_combinations(family_map);
  family_map.is_sound = is_sound();
  return family_map;
}

FamilyMap read_picture(TomlReader& file, NamedFiles& files, ModelReport& model_report) {
  FamilyMap family_map;
  family_map.is_picture = true;
  auto map = file.table("map", Presence::kRequired);
  if (!map) return family_map;
  TomlReport& report = file.report();
  const std::size_t errors_before = report.num_errors();
  family_map.map_place = family_map.source_place = map->place();
  if (auto legend = map->table("legend", Presence::kRequired)) read_legend(legend->content(), family_map, report);
  family_map.legend_is_sound = report.num_errors() == errors_before;
  MapReader{family_map, report, files, model_report}.read(*map);
  map->finish();
  family_map.is_sound = report.num_errors() == errors_before && !model_report.has_errors();
  if (family_map.is_sound) name_combinations(family_map);
  return family_map;
}

}  // namespace kith::detail
