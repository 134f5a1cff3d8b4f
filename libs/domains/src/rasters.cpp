#include "kith/domains/layers.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "kith/domains/grey_image.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMaxRasters = 16;
constexpr std::int64_t kLargestReach = 1'000;
constexpr std::int64_t kLargestSight = 64;
constexpr std::int64_t kMostLevels = 255;
constexpr std::size_t kMostValues = 64'000'000;       // of all rasters in all MDPs
constexpr std::size_t kMostSightSteps = 500'000'000;  // cells that lines of sight go through
constexpr std::uint16_t kFar = 0xFFFF;

// Reads the declarations.
class RastersReader {
 public:
  RastersReader(FamilyMap& family_map, std::size_t pixels_per_cell, NamedFiles& files, TomlReport& report,
                ModelReport& model_report)
      : family_map_{family_map},
        pixels_per_cell_{pixels_per_cell},
        files_{files},
        report_{report},
        model_report_{model_report} {}

  void read(const TomlArray& list) {
    for (const TomlValue& value : list) {
      if (read_table(value, "a raster", report_) != nullptr) read_one(value);
    }
    if (list.size() <= kMaxRasters) return;
    report_.error("E0273", list.back().place(),
                  "there are " + std::to_string(list.size()) + " rasters; at most 16 are supported",
                  "keep those that features and rules use");
  }

 private:
  void read_one(const TomlValue& value) {
    TomlReader reader{*value.table(), value.place(), "[[map.raster]]", report_};
    const std::size_t errors_before = report_.num_errors();
    Raster raster;
    raster.name = reader.string("name", Presence::kRequired).value_or("");
    raster.place = value.place();
    if (const TomlValue* name = reader.content().find("name")) raster.place = name->place();
    if (report_.num_errors() == errors_before) check_name(raster);
    read_kind(reader, raster);
    const auto symbol = reader.string("symbol", Presence::kOptional);
    reader.finish();
    if (report_.num_errors() > errors_before || model_report_.has_errors()) return;
    if (symbol) add_symbol(*symbol, reader.content().find("symbol")->place(), raster);
    family_map_.terrain_names.push_back(raster.name);
    family_map_.rasters.push_back(std::move(raster));
  }

  void check_name(const Raster& raster) {
    if (raster.name.empty() || !std::ranges::all_of(raster.name, is_name_character)) {
      report_.error("E0225", raster.place, "'" + raster.name + "' cannot be a name",
                    "use letters, digits, '_' and '-'");
      return;
    }
    for (const auto* names : {&family_map_.terrain_names, &family_map_.station_names}) {
      if (std::ranges::find(*names, raster.name) == names->end()) continue;
      report_.error("E0214", raster.place, "'" + raster.name + "' is already the name of something else",
                    "leave:" + raster.name + " could mean either");
      return;
    }
  }

  void read_kind(TomlReader& reader, Raster& raster) {
    struct Form {
      const char* key;
      const char* reach;
      std::int64_t largest;
      Raster::Kind kind;
    };
    static constexpr Form kForms[] = {{"near", "within", kLargestReach, Raster::Kind::kNear},
                                      {"distance_to", "most", kLargestReach, Raster::Kind::kDistance},
                                      {"seen_from", "within", kLargestSight, Raster::Kind::kSeen},
                                      {"image", "levels", kMostLevels, Raster::Kind::kImage}};

    const Form* found = nullptr;
    int number = 0;
    for (const Form& form : kForms) {
      if (!reader.has(form.key)) continue;
      found = &form;
      ++number;
    }
    if (number != 1) {
      report_.error("E0273", reader.place(),
                    number == 0 ? "the raster '" + raster.name + "' does not say what its values are"
                                : "the raster '" + raster.name + "' is declared in several ways",
                    "write one of near, distance_to, seen_from and image");
      for (const char* key : {"within", "most", "levels"}) reader.know(key);
      return;
    }

    raster.kind = found->kind;
    const bool is_image = raster.kind == Raster::Kind::kImage;
    const auto reach = reader.integer(found->reach, is_image ? Presence::kOptional : Presence::kRequired,
                                      {is_image || raster.kind == Raster::Kind::kDistance ? 1 : 0, found->largest});
    raster.reach = static_cast<std::size_t>(reach.value_or(1));
    if (is_image) {
      read_image(reader, raster);
    } else {
      read_names(*reader.value(found->key, Presence::kRequired), raster);
    }
  }

  // A name or a list of names of things in the legend.
  void read_names(const TomlValue& value, Raster& raster) {
    const TomlArray single{value};
    const TomlArray* list = value.array() != nullptr ? value.array() : &single;
    if (list->empty()) {
      report_.error("E0273", value.place(), "the raster '" + raster.name + "' is about nothing",
                    "name a terrain, a station, an item or a goal, or \"wall\" or \"goal\"");
    }
    for (const TomlValue& element : *list) {
      const auto name = read_string(element, "a name", report_);
      if (!name) continue;
      const auto is_it = [&](const Symbol& symbol) { return is_called(symbol.content, *name); };
      const bool known = std::ranges::any_of(family_map_.symbols, is_it) ||
                         std::ranges::find(family_map_.absent, *name) != family_map_.absent.end();
      if (known || *name == "wall" || *name == "goal") {
        raster.of.push_back(*name);
      } else if (family_map_.legend_is_sound) {
        report_.error("E0273", element.place(), "nothing in [map.legend] is called '" + *name + "'",
                      suggestion(*name, known_names()));
      }
    }
  }

  [[nodiscard]] std::vector<std::string> known_names() const {
    std::vector<std::string> names = family_map_.terrain_names;
    for (const auto* more : {&family_map_.station_names, &family_map_.goal_names}) {
      names.insert(names.end(), more->begin(), more->end());
    }
    for (const Item& item : family_map_.items) names.push_back(item.name);
    names.insert(names.end(), {"wall", "goal"});
    return names;
  }

  void read_image(TomlReader& reader, Raster& raster) {
    const auto name = reader.string("image", Presence::kRequired);
    const TomlPlace place = reader.content().find("image")->place();
    const ModelText* text = name ? files_.open(*name, place, image_files()) : nullptr;
    const auto image = text == nullptr ? std::nullopt : read_pgm(*text, model_report_);
    if (!image) return;
    const GreyImage cells = scaled_down(*image, pixels_per_cell_);
    if (cells.grey.size() != family_map_.num_cells() || cells.width != static_cast<std::size_t>(family_map_.width)) {
      if (family_map_.num_cells() == 0) return;
      report_.error("E0265", place,
                    "the image has " + std::to_string(cells.width) + " x " + std::to_string(cells.height) +
                        " cells, and the map " + std::to_string(family_map_.width) + " x " +
                        std::to_string(family_map_.height),
                    "an image has one pixel per cell, or pixels_per_cell in each direction");
      return;
    }
    // White is 0, black is the largest value.
    for (const std::uint8_t grey : cells.grey) {
      const std::size_t dark = std::size_t{cells.white} - grey;
      raster.values.push_back(static_cast<std::uint16_t>((dark * raster.reach * 2 + cells.white) / (cells.white * 2U)));
    }
  }

  void add_symbol(const std::string& text, const TomlPlace& place, Raster& raster) {
    const bool printable = text.size() == 1 && text[0] >= 0x20 && text[0] < 0x7F && text[0] != '@';
    const auto is_it = [&](const Symbol& symbol) { return text.size() == 1 && symbol.glyph == text[0]; };
    if (!printable) {
      report_.error("E0204", place,
                    "'" + text + "' cannot be a symbol: it must be one printable ASCII character other than '@'");
    } else if (std::ranges::any_of(family_map_.symbols, is_it)) {
      report_.error("E0273", place, "symbol '" + text + "' already stands for something else",
                    "choose a character that is not in [map.legend]");
    } else {
      Symbol symbol;
      symbol.glyph = text[0];
      symbol.content.terrain = raster.name;
      symbol.place = place;
      raster.symbol = static_cast<std::int32_t>(family_map_.symbols.size());
      family_map_.symbols.push_back(std::move(symbol));
    }
  }

  FamilyMap& family_map_;
  std::size_t pixels_per_cell_;
  NamedFiles& files_;
  TomlReport& report_;
  ModelReport& model_report_;
};

// What the value of a raster depends on, in one MDP.
struct Scene {
  std::vector<bool> is_wall;
  std::vector<std::size_t> sources;  // cells with what the raster is about
};

class RasterComputer {
 public:
  RasterComputer(const FamilyMap& family_map, const Raster& raster) : family_map_{family_map}, raster_{raster} {
    for (std::size_t cell = 0; cell < family_map.num_cells(); ++cell) {
      note({cell, family_map.symbol_of[cell], family_map.group_of[cell]});
    }
    for (const MapThing& thing : family_map.painted) note(thing);
  }

  // The groups on which the values depend.
  [[nodiscard]] std::uint64_t relevant_groups() const { return raster_.kind == Raster::Kind::kImage ? 0 : groups_; }

  // At most so many cells are looked at for lines of sight.
  [[nodiscard]] std::size_t most_sight_steps() const {
    if (raster_.kind != Raster::Kind::kSeen) return 0;
    const std::size_t side = 2 * raster_.reach + 1;
    return sources_.size() * side * side * (raster_.reach + 1);
  }

  [[nodiscard]] std::vector<std::uint16_t> values(std::size_t mdp) const {
    if (raster_.kind == Raster::Kind::kImage) return raster_.values;
    Scene scene{std::vector<bool>(family_map_.num_cells(), false), {}};
    for (const MapThing& wall : walls_) {
      if (family_map_.is_there(wall.group, mdp)) scene.is_wall[wall.cell] = true;
    }
    for (const MapThing& source : sources_) {
      if (family_map_.is_there(source.group, mdp)) scene.sources.push_back(source.cell);
    }
    if (raster_.kind == Raster::Kind::kSeen) return seen(scene);
    auto steps = distances(scene);
    for (std::uint16_t& one : steps) {
      if (raster_.kind == Raster::Kind::kNear) {
        one = one <= raster_.reach ? 1 : 0;
      } else {
        one = static_cast<std::uint16_t>(std::min<std::size_t>(one, raster_.reach));
      }
    }
    return steps;
  }

 private:
  void note(const MapThing& thing) {
    const SymbolContent& content = family_map_.symbols[thing.symbol].content;
    const bool is_source =
        std::ranges::any_of(raster_.of, [&](const std::string& name) { return is_called(content, name); });
    if (content.wall) walls_.push_back(thing);
    if (is_source) sources_.push_back(thing);
    if ((content.wall || is_source) && thing.group >= 0)
      groups_ |= family_map_.bit_of(static_cast<std::size_t>(thing.group));
  }

  // Steps around walls to the nearest source; sources may be walls themselves.
  [[nodiscard]] std::vector<std::uint16_t> distances(const Scene& scene) const {
    std::vector<std::uint16_t> steps(family_map_.num_cells(), kFar);
    std::vector<std::size_t> queue;
    for (const std::size_t source : scene.sources) {
      if (steps[source] == 0) continue;
      steps[source] = 0;
      queue.push_back(source);
    }
    const auto width = static_cast<std::size_t>(family_map_.width);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::size_t at = queue[i];
      if (steps[at] >= raster_.reach) continue;
      const auto reach = [&](bool exists, std::size_t next) {
        if (!exists || steps[next] != kFar || scene.is_wall[next]) return;
        steps[next] = static_cast<std::uint16_t>(steps[at] + 1);
        queue.push_back(next);
      };
      reach(at >= width, at - width);
      reach(at + width < steps.size(), at + width);
      reach(at % width > 0, at - 1);
      reach(at % width + 1 < width, at + 1);
    }
    return steps;
  }

  [[nodiscard]] std::vector<std::uint16_t> seen(const Scene& scene) const {
    std::vector<std::uint16_t> result(family_map_.num_cells(), 0);
    const auto reach = static_cast<int>(raster_.reach);
    for (const std::size_t source : scene.sources) {
      const int x = static_cast<int>(source) % family_map_.width;
      const int y = static_cast<int>(source) / family_map_.width;
      for (int to_y = std::max(0, y - reach); to_y <= std::min(family_map_.height - 1, y + reach); ++to_y) {
        for (int to_x = std::max(0, x - reach); to_x <= std::min(family_map_.width - 1, x + reach); ++to_x) {
          const int dx = to_x - x;
          const int dy = to_y - y;
          if (dx * dx + dy * dy > reach * reach || !is_clear(scene, {x, y}, {to_x, to_y})) continue;
          const auto cell = cell_at(to_x, to_y);
          if (!scene.is_wall[cell]) result[cell] = 1;
        }
      }
    }
    return result;
  }

  [[nodiscard]] std::size_t cell_at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(family_map_.width) + static_cast<std::size_t>(x);
  }

  // Whether no cell between the two is a wall: the cells of Bresenham's line.
  [[nodiscard]] bool is_clear(const Scene& scene, std::pair<int, int> from, std::pair<int, int> to) const {
    auto [x, y] = from;
    const int dx = std::abs(to.first - x);
    const int dy = -std::abs(to.second - y);
    const int step_x = x < to.first ? 1 : -1;
    const int step_y = y < to.second ? 1 : -1;
    int error = dx + dy;
    while (std::pair{x, y} != to) {
      if (std::pair{x, y} != from && scene.is_wall[cell_at(x, y)]) return false;
      const int twice = 2 * error;
      if (twice >= dy) {
        error += dy;
        x += step_x;
      }
      if (twice <= dx) {
        error += dx;
        y += step_y;
      }
    }
    return true;
  }

  const FamilyMap& family_map_;
  const Raster& raster_;
  std::vector<MapThing> walls_;
  std::vector<MapThing> sources_;
  std::uint64_t groups_ = 0;
};

}  // namespace

void read_rasters(TomlReader& map, FamilyMap& family_map, NamedFiles& files, TomlReport& report,
                  ModelReport& model_report) {
  const TomlArray* list = map.array("raster", Presence::kOptional);
  if (list == nullptr) return;
  const TomlValue* pixels = map.content().find("pixels_per_cell");
  const bool has_pixels = pixels != nullptr && pixels->integer() != nullptr && *pixels->integer() > 0;
  const auto pixels_per_cell = has_pixels ? static_cast<std::size_t>(*pixels->integer()) : std::size_t{1};
  RastersReader{family_map, pixels_per_cell, files, report, model_report}.read(*list);
}

void compute_rasters(FamilyMap& family_map, TomlReport& report) {
  const std::size_t num_mdps = family_map.num_mdps();
  std::size_t sight_steps = 0;
  const auto report_size = [&](const Raster& raster) {
    report.error("E0219", raster.place, "the rasters of all worlds are too large to compute",
                 "use a smaller map, a smaller 'within', or [family] worlds = NUMBER");
  };
  for (const Raster& raster : family_map.rasters) {
    const RasterComputer computer{family_map, raster};
    std::map<std::uint64_t, std::uint32_t> known;  // by the relevant groups that are on
    bool is_zero = true;
    for (std::size_t mdp = 0; mdp < num_mdps; ++mdp) {
      const std::uint64_t key = family_map.mask(mdp) & computer.relevant_groups();
      const auto [at, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(family_map.raster_grids.size()));
      family_map.raster_grid_of.push_back(at->second);
      if (!is_new) continue;
      sight_steps += computer.most_sight_steps();
      if ((family_map.raster_grids.size() + 1) * family_map.num_cells() > kMostValues ||
          sight_steps > kMostSightSteps) {
        return report_size(raster);
      }
      family_map.raster_grids.push_back(computer.values(mdp));
      is_zero = is_zero && std::ranges::all_of(family_map.raster_grids.back(), [](std::uint16_t v) { return v == 0; });
    }
    const bool is_about_absent_things = !raster.of.empty() && std::ranges::all_of(raster.of, [&](const auto& name) {
      return std::ranges::find(family_map.absent, name) != family_map.absent.end();
    });
    if (is_zero && !is_about_absent_things) {
      report.warning("W0206", raster.place, "raster '" + raster.name + "' is 0 everywhere",
                     "check where the things are that it is about");
    }
  }
}

}  // namespace kith::detail
