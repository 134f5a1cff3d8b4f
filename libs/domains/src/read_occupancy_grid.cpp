// Occupancy grids of ROS's map_server, beside the table of keys that says how to read them.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>

#include "kith/domains/occupancy_grid.hpp"

namespace kith::detail {
namespace {

std::string in_lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

// Makes an occupancy grid of what the keys say.
class OccupancyReader {
 public:
  OccupancyReader(const ModelText& yaml, const TomlPlace& place, NamedFiles& files, ModelReport& report)
      : yaml_{yaml}, place_{place}, files_{files}, report_{report} {}

  std::optional<OccupancyGrid> read() {
    auto table = read_yaml_table(yaml_, report_);
    if (!table) return std::nullopt;
    table_ = *std::move(table);

    const std::size_t errors_before = report_.num_errors();
    const auto image_name = scalar("image");
    check_resolution();
    const bool negated = read_negate();
    const auto occupied = threshold("occupied_thresh");
    const auto free = threshold("free_thresh");
    if (occupied && free && *free > *occupied) {
      fail(table_.at("free_thresh").offset, "'free_thresh' is larger than 'occupied_thresh'",
           "map_server writes 0.196 and 0.65");
    }
    check_mode();
    note_other_keys();
    if (report_.num_errors() > errors_before) return std::nullopt;

    const auto image = read_image(*image_name);
    if (!image) return std::nullopt;

    const auto occupancy = [&](std::uint8_t grey) {
      const double share = static_cast<double>(grey) / image->white;
      const double probability = negated ? share : 1.0 - share;
      return probability > *occupied ? Occupancy::kOccupied
             : probability < *free   ? Occupancy::kFree
                                     : Occupancy::kUnknown;
    };
    OccupancyGrid grid{image->width, image->height, {}};
    grid.pixels.reserve(image->grey.size());
    for (const std::uint8_t grey : image->grey) grid.pixels.push_back(occupancy(grey));
    if (occupancy(kUnexplored) == Occupancy::kFree) note_unexplored(*image);
    return grid;
  }

 private:
  // The grey that map_saver and slam_toolbox write where nothing was seen. 1 - 205 / 255 is just below .196.
  static constexpr std::uint8_t kUnexplored = 205;

  void fail(std::size_t offset, const std::string& message, const std::string& hint) {
    report_.error("E0268", place_at(yaml_, offset), message, hint);
  }

  void note_unexplored(const GreyImage& image) {
    const auto count = std::count(image.grey.begin(), image.grey.end(), kUnexplored);
    if (count == 0) return;
    report_.warning("W0208", place_at(yaml_, table_.at("free_thresh").offset),
                    std::to_string(count) + (count == 1 ? " pixel is" : " pixels are") +
                        " 205, which tools write for unexplored; this 'free_thresh' makes them free",
                    "write 0.196 to keep the robot out of what was not explored");
  }

  // The value of a key that must be there and no list.
  const std::string* scalar(const std::string& key) {
    const auto at = table_.find(key);
    if (at == table_.end()) {
      fail(0, "key '" + key + "' is missing", "name the .yaml file that map_server wrote");
      return nullptr;
    }
    if (!at->second.is_list && at->second.scalars.size() == 1) return &at->second.scalars.front();
    fail(at->second.offset, "'" + key + "' must be a single value", "write it as map_server does");
    return nullptr;
  }

  std::optional<double> number(const std::string& key) {
    const std::string* text = scalar(key);
    if (text == nullptr) return std::nullopt;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (error == std::errc{} && end == text->data() + text->size() && std::isfinite(value)) return value;
    fail(table_.at(key).offset, "'" + key + "' must be a number, not '" + *text + "'", "write it as map_server does");
    return std::nullopt;
  }

  void check_resolution() {
    const auto metres = number("resolution");
    if (metres && *metres <= 0.0) {
      fail(table_.at("resolution").offset, "'resolution' must be above 0", "it is the side of a pixel in metres");
    }
  }

  bool read_negate() {
    const std::string* text = scalar("negate");
    if (text == nullptr) return false;
    const std::string word = in_lower_case(*text);
    if (word == "1" || word == "true") return true;
    if (word != "0" && word != "false") {
      fail(table_.at("negate").offset, "'negate' must be 0 or 1, not '" + *text + "'",
           "0 means that black is occupied");
    }
    return false;
  }

  std::optional<double> threshold(const std::string& key) {
    const auto value = number(key);
    if (!value || (*value >= 0.0 && *value <= 1.0)) return value;
    fail(table_.at(key).offset, "'" + key + "' must be between 0 and 1", "it is a probability");
    return std::nullopt;
  }

  void check_mode() {
    if (!table_.contains("mode")) return;
    const std::string* mode = scalar("mode");
    if (mode == nullptr || in_lower_case(*mode) == "trinary" || in_lower_case(*mode) == "scale") return;
    fail(table_.at("mode").offset, "'mode' must be trinary or scale, not '" + *mode + "'",
         "in raw grids no value means that a cell is free or occupied");
  }

  // map_server ignores them, too.
  void note_other_keys() {
    static const std::vector<std::string> kKeys{"image",       "resolution",      "origin", "negate",
                                                "free_thresh", "occupied_thresh", "mode"};
    for (const auto& [key, value] : table_) {
      if (std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end()) continue;
      report_.warning("W0209", place_at(yaml_, value.key_offset), "key '" + key + "' is not used",
                      suggestion(key, kKeys));
    }
  }

  // The image lies beside the YAML file or below.
  std::optional<GreyImage> read_image(const std::string& name) {
    const bool is_elsewhere = name.starts_with("~") || name.find("://") != std::string::npos;
    if (is_elsewhere || std::filesystem::path{name}.is_absolute()) {
      fail(table_.at("image").offset, "the image '" + name + "' does not lie beside this file or below",
           "put the image beside the .yaml file and write only its name");
      return std::nullopt;
    }
    const auto path = std::filesystem::path{yaml_.name}.parent_path() / name;
    const ModelText* text = files_.open(path.string(), place_, image_files());
    return text == nullptr ? std::nullopt : read_pgm(*text, report_);
  }

  const ModelText& yaml_;
  const TomlPlace& place_;
  NamedFiles& files_;
  ModelReport& report_;
  YamlTable table_;
};

}  // namespace

std::optional<OccupancyGrid> read_occupancy_grid(const ModelText& yaml, const TomlPlace& place, NamedFiles& files,
                                                 ModelReport& report) {
  return OccupancyReader{yaml, place, files, report}.read();
}

}  // namespace kith::detail
