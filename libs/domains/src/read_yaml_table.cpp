// The files of ROS's map_server (http://wiki.ros.org/map_server, "Map format"). LibYAML splits the YAML file into
// events; only a flat table of scalars, one of which is a list of three numbers, is accepted.
#include <yaml.h>

#include <algorithm>
#include <string_view>

#include "kith/domains/occupancy_grid.hpp"

namespace kith::detail {
namespace {

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
    return failed_ ? std::nullopt : std::optional{std::move(table_)};
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
      case YAML_DOCUMENT_END_EVENT:
        break;
      case YAML_STREAM_END_EVENT:
        ended_ = true;
        if (!was_table_) fail(0, "the file is empty", "name the .yaml file that map_server wrote");
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

}  // namespace

std::optional<YamlTable> read_yaml_table(const ModelText& file, ModelReport& report) {
  return YamlTableReader{file, report}.read();
}

}  // namespace kith::detail
