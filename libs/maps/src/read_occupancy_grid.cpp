// The files of ROS's map_server (http://wiki.ros.org/map_server, "Map format"). LibYAML splits the YAML file into
// events; only a flat table of scalars, one of which is a list of three numbers, is accepted.
#include <yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "kith/maps/occupancy_grid.hpp"

namespace kith::detail {
namespace {

std::string in_lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

// A value of the table.
struct YamlValue {
  std::vector<std::string> scalars;  // one, or those of a list
  bool is_list = false;
  std::size_t offset = 0;      // in bytes
  std::size_t key_offset = 0;  // of its key
};
using YamlTable = std::map<std::string, YamlValue>;

class YamlEvent {
 public:
  YamlEvent() = default;
  YamlEvent(const YamlEvent&) = delete;
  YamlEvent& operator=(const YamlEvent&) = delete;
  ~YamlEvent() { yaml_event_delete(&event_); }
  [[nodiscard]] yaml_event_t* get() { return &event_; }
  [[nodiscard]] yaml_event_type_t type() const { return event_.type; }
  [[nodiscard]] std::string scalar() const {
    return {reinterpret_cast<const char*>(event_.data.scalar.value), event_.data.scalar.length};
  }

 private:
  yaml_event_t event_{};
};

// Turns the text into a table of keys.
class YamlTableReader {
 public:
  YamlTableReader(const ModelText& file, ModelReport& report) : file_{file}, report_{report} {
    is_open_ = yaml_parser_initialize(&parser_) != 0;
    if (!is_open_) return;
    yaml_parser_set_encoding(&parser_, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(file.text.data()), file.text.size());
  }
  YamlTableReader(const YamlTableReader&) = delete;
  YamlTableReader& operator=(const YamlTableReader&) = delete;
  ~YamlTableReader() {
    if (is_open_) yaml_parser_delete(&parser_);
  }

  std::optional<YamlTable> read() {
    constexpr std::size_t kMostBytes = 65'536;  // those that map_server writes have 200
    if (!is_open_ || file_.text.size() > kMostBytes) {
      fail(0, "the file of an occupancy grid has at most 65536 bytes", "name the .yaml file that map_server wrote");
      return std::nullopt;
    }
    while (!failed_ && !ended_) {
      YamlEvent event;
      if (yaml_parser_parse(&parser_, event.get()) == 0) {
        fail(offset_of(parser_.problem_mark), "the text is not valid YAML",
             parser_.problem == nullptr ? "" : parser_.problem);
      } else {
        take(event);
      }
    }
    if (failed_) return std::nullopt;
    return std::move(table_);
  }

 private:
  void fail(std::size_t offset, const std::string& message, const std::string& hint) {
    if (!failed_) report_.error("E0268", place_at(file_, offset), message, hint);
    failed_ = true;
  }

  // Marks count lines from 0, and characters in them.
  [[nodiscard]] std::size_t offset_of(const yaml_mark_t& mark) const {
    const std::string_view text = file_.text;
    std::size_t at = 0;
    for (std::size_t line = 0; line < mark.line && at < text.size(); ++line) {
      at = std::min(text.find('\n', at), text.size() - 1) + 1;
    }
    const auto continues = [&] { return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
    for (std::size_t column = 0; column < mark.column && at < text.size() && text[at] != '\n'; ++column) {
      ++at;
      while (continues()) ++at;
    }
    return at;
  }

  void take(YamlEvent& event) {
    const std::size_t offset = offset_of(event.get()->start_mark);
    const auto not_flat = [&] {
      fail(offset, "the file of an occupancy grid is a table of keys with plain values",
           "write it as map_server does: image, resolution, origin, negate, occupied_thresh, free_thresh");
    };
    switch (event.type()) {
      case YAML_STREAM_START_EVENT:
      case YAML_DOCUMENT_START_EVENT:
        break;
      case YAML_STREAM_END_EVENT:
        ended_ = true;
        if (!was_table_) fail(0, "the file is empty", "name the .yaml file that map_server wrote");
        break;
      case YAML_DOCUMENT_END_EVENT:
        break;
      case YAML_MAPPING_START_EVENT:
        if (was_table_) return not_flat();
        was_table_ = in_table_ = true;
        break;
      case YAML_MAPPING_END_EVENT:
        in_table_ = false;
        break;
      case YAML_SEQUENCE_START_EVENT:
        if (!in_table_ || !key_ || in_list_) return not_flat();
        in_list_ = true;
        table_[*key_].is_list = true;
        table_[*key_].offset = offset;
        break;
      case YAML_SEQUENCE_END_EVENT:
        in_list_ = false;
        key_.reset();
        break;
      case YAML_SCALAR_EVENT:
        if (!in_table_) return not_flat();
        take_scalar(event.scalar(), offset);
        break;
      default:
        not_flat();  // an alias
    }
  }

  void take_scalar(std::string text, std::size_t offset) {
    if (!key_) {
      if (!table_.try_emplace(text, YamlValue{{}, false, offset, offset}).second) {
        fail(offset, "key '" + text + "' is given twice", "remove one of them");
      }
      key_ = std::move(text);
      return;
    }
    YamlValue& value = table_[*key_];
    value.scalars.push_back(std::move(text));
    if (in_list_) return;
    value.offset = offset;
    key_.reset();
  }

  const ModelText& file_;
  ModelReport& report_;
  yaml_parser_t parser_{};
  YamlTable table_;
  std::optional<std::string> key_;
  bool is_open_ = false;
  bool was_table_ = false;
  bool in_table_ = false;
  bool in_list_ = false;
  bool ended_ = false;
  bool failed_ = false;
};

// Makes an occupancy grid of what the keys say.
class OccupancyReader {
 public:
  OccupancyReader(const ModelText& yaml, const TomlPlace& place, NamedFiles& files, ModelReport& report)
      : yaml_{yaml}, place_{place}, files_{files}, report_{report} {}

  std::optional<OccupancyGrid> read() {
    auto table = YamlTableReader{yaml_, report_}.read();
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
