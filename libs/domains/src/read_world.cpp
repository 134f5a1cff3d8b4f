#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "thinning.hpp"
#include "world.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMaxCells = 1'000'000;
constexpr std::size_t kMaxGroups = 16;         // every combination of them is an MDP
constexpr std::size_t kMaxThinnedGroups = 64;  // bits of a variant

// Reads the rows and finds what stands where.
class RowsReader {
 public:
  RowsReader(World& world, TomlReport& report) : world_{world}, report_{report} {}

  void read(const TomlValue& value) {
    const TomlArray* rows = read_array(value, "'rows'", report_);
    if (rows == nullptr || !check_shape(value, *rows)) return;
    fill(*rows);
    find_things(value);
    group_optional_cells(value);
    for (const Symbol& symbol : world_.symbols) warn_if_unused(symbol);
  }

 private:
  // A character outside ASCII is several bytes, so lengths cannot be compared before it is mended.
  bool has_other_characters(const TomlArray& rows) {
    constexpr unsigned char kLastAscii = 0x7F;
    bool found = false;
    for (const TomlValue& row : rows) {
      if (row.string() == nullptr) continue;
      const auto& text = *row.string();
      const auto other =
          std::find_if(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) > kLastAscii; });
      if (other == text.end()) continue;
      found = true;
      report_.error("E0203", report_.document().inside(row, static_cast<std::size_t>(other - text.begin())),
                    "this row contains a non-ASCII character", "use one ASCII character per cell");
    }
    return found;
  }

  bool check_shape(const TomlValue& value, const TomlArray& rows) {
    const std::size_t errors_before = report_.num_errors();
    if (rows.empty()) report_.error("E0201", value.place(), "the map has no rows");
    if (has_other_characters(rows)) return false;
    for (const TomlValue& row : rows) {
      if (!read_string(row, "a row of the map", report_)) continue;
      const std::size_t width = rows.front().string() == nullptr ? 0 : rows.front().string()->size();
      if (row.string()->empty()) {
        report_.error("E0201", row.place(), "a row of the map is empty");
      } else if (rows.front().string() != nullptr && row.string()->size() != width) {
        report_.error("E0202", row.place(),
                      "this row has " + std::to_string(row.string()->size()) + " cells, the first one has " +
                          std::to_string(width),
                      "all rows must have the same length, with one ASCII character per cell");
      }
    }
    if (report_.num_errors() > errors_before) return false;
    const std::size_t num_cells = rows.size() * rows.front().string()->size();
    if (num_cells <= kMaxCells) return true;
    report_.error("E0217", value.place(),
                  "the map has " + std::to_string(num_cells) + " cells; at most 1000000 are read");
    return false;
  }

  void fill(const TomlArray& rows) {
    world_.width = static_cast<int>(rows.front().string()->size());
    world_.height = static_cast<int>(rows.size());
    std::array<int, 256> number{};
    number.fill(-1);
    for (std::size_t i = 0; i < world_.symbols.size(); ++i) {
      number[static_cast<unsigned char>(world_.symbols[i].glyph)] = static_cast<int>(i);
    }
    for (const TomlValue& row : rows) {
      world_.row_places.push_back(row.place());
      const std::string& text = *row.string();
      for (std::size_t x = 0; x < text.size(); ++x) {
        int& symbol = number[static_cast<unsigned char>(text[x])];
        if (symbol == -1) {
          report_.error("E0203", report_.document().inside(row, x),
                        "symbol " + shown(text[x]) + " is not declared in [map.legend]", suggestion_for_undeclared());
          symbol = -2;  // once per symbol
        }
        world_.symbol_of.push_back(static_cast<std::uint8_t>(std::max(symbol, 0)));
      }
    }
    if (world_.symbols.empty()) world_.symbols.emplace_back();
  }

  // The character in quotes, or its code if it cannot be seen.
  static std::string shown(char c) {
    static constexpr char kHex[] = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) return std::string{"'"}.append(1, c).append("'");
    return std::string{"0x"}.append(1, kHex[byte >> 4U]).append(1, kHex[byte & 0xFU]);
  }

  [[nodiscard]] std::string suggestion_for_undeclared() const {
    std::string hint = "declared:";
    for (const Symbol& symbol : world_.symbols) hint += std::string{" '"} + symbol.glyph + "'";
    return world_.symbols.empty() ? "" : hint;
  }

  void find_things(const TomlValue& rows) {
    std::optional<std::size_t> start;
    for (std::size_t cell = 0; cell < world_.num_cells(); ++cell) {
      const SymbolContent& content = world_.content(cell);
      if (content.start && start) {
        report_.error("E0208", place_of_cell(world_, cell), "there is a second start");
      } else if (content.start) {
        start = cell;
      }
      if (!content.station.empty()) world_.stations.push_back({content.station, cell});
      if (content.goal || !content.destination.empty()) world_.some_goal = world_.some_goal.value_or(cell);
      find_item(content, cell);
    }
    if (!start) report_.error("E0206", rows.place(), "the map has no start", "declare a symbol with start = true");
    world_.start = start.value_or(0);
  }

  void find_item(const SymbolContent& content, std::size_t cell) {
    for (Item& item : world_.items) {
      if (item.name == content.destination) item.has_destination = true;
      if (item.name != content.item) continue;
      if (item.home) {
        report_.error("E0211", place_of_cell(world_, cell), "item '" + item.name + "' lies on two cells");
      }
      item.home = cell;
    }
  }

  void group_optional_cells(const TomlValue& rows) {
    world_.group_of.assign(world_.num_cells(), -1);
    std::vector<std::vector<std::size_t>> cells_of(world_.symbols.size());
    for (std::size_t cell = 0; cell < world_.num_cells(); ++cell) {
      if (world_.symbols[world_.symbol_of[cell]].is_optional()) cells_of[world_.symbol_of[cell]].push_back(cell);
    }
    std::vector<std::pair<std::string, std::size_t>> named;
    for (std::size_t i = 0; i < world_.symbols.size(); ++i) {
      for (const std::size_t cell : cells_of[i]) {
        const std::size_t group = group_for(world_.symbols[i], named);
        world_.groups[group].cells.push_back(cell);
        world_.group_of[cell] = static_cast<std::int32_t>(group);
      }
    }
    check_groups(rows);
  }

  void check_groups(const TomlValue& rows) {
    const std::string number = std::to_string(world_.groups.size());
    if (!world_.thinning.worlds && world_.groups.size() > kMaxGroups) {
      report_.error("E0218", rows.place(),
                    number + " optional things make about " + power_of_two() + " MDPs; at most 65536 are built",
                    "toggle cells together: optional = \"NAME\"; or build some of them: [family] worlds = NUMBER");
    } else if (world_.groups.size() > kMaxThinnedGroups) {
      report_.error("E0218", rows.place(), number + " optional things; at most 64 are supported",
                    "toggle cells together: optional = \"NAME\"");
    }
  }

  std::size_t group_for(const Symbol& symbol, std::vector<std::pair<std::string, std::size_t>>& named) {
    if (!symbol.toggle.empty()) {
      for (const auto& [name, group] : named) {
        if (name == symbol.toggle) return group;
      }
      named.emplace_back(symbol.toggle, world_.groups.size());
    }
    world_.groups.emplace_back();
    return world_.groups.size() - 1;
  }

  [[nodiscard]] std::string power_of_two() const {
    const std::size_t n = world_.groups.size();
    return n < 60 ? std::to_string(std::size_t{1} << n) : "2^" + std::to_string(n);
  }

  // Walls and floor may be declared and not used; other things are there to be used.
  void warn_if_unused(const Symbol& symbol) {
    SymbolContent wall;
    wall.wall = true;
    if (symbol.content.is_floor() || symbol.content == wall) return;
    const auto number = static_cast<std::uint8_t>(&symbol - world_.symbols.data());
    if (std::find(world_.symbol_of.begin(), world_.symbol_of.end(), number) != world_.symbol_of.end()) return;
    report_.warning("W0201", symbol.place, std::string{"symbol '"} + symbol.glyph + "' is nowhere on the map");
  }

  World& world_;
  TomlReport& report_;
};

}  // namespace

namespace {

void thin_out(World& world, TomlReport& report) {
  const auto& worlds = world.thinning.worlds;
  if (!worlds) return;
  const std::size_t num_groups = world.groups.size();
  const std::size_t most = num_groups <= kMaxGroups ? std::size_t{1} << num_groups : *worlds;
  if (*worlds > most) {
    report.warning("W0203", world.thinning.worlds_place,
                   "there are only " + std::to_string(most) + " worlds, and all of them are built",
                   "make more things optional, or ask for fewer worlds");
  }
  world.variants = choose_variants(world, std::min(*worlds, most), world.thinning.seed);
}

}  // namespace

World read_world(TomlReader& file) {
  World world;
  auto map = file.table("map", Presence::kRequired);
  if (!map) return world;
  TomlReport& report = file.report();
  const std::size_t errors_before = report.num_errors();
  world.map_place = map->place();
  world.thinning = read_thinning(file);
  if (auto legend = map->table("legend", Presence::kRequired)) read_legend(legend->content(), world, report);
  world.legend_is_sound = report.num_errors() == errors_before;
  if (const TomlValue* rows = map->value("rows", Presence::kRequired)) RowsReader{world, report}.read(*rows);
  map->finish();
  world.is_sound = report.num_errors() == errors_before;
  if (world.is_sound) thin_out(world, report);
  return world;
}

}  // namespace kith::detail
