// The one place that includes toml++: header-only, without exceptions and
// without assertions (see CMakeLists.txt), behind the scan of scan.hpp.
#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "diagnostic_at.hpp"
#include "kith/files/document.hpp"
#include "scan.hpp"

namespace kith {
namespace {

TomlPlace place_of(const ::toml::source_region& region) {
  TomlPlace place;
  place.line = region.begin.line;
  place.column = region.begin.column;
  if (region.end.line == region.begin.line && region.end.column > region.begin.column) {
    place.length = region.end.column - region.begin.column;
  }
  return place;
}

template <typename DateOrTime>
TomlDateTime as_written(const DateOrTime& value) {
  std::ostringstream text;
  text << value;
  return TomlDateTime{text.str()};
}

// Copies toml++'s tree into ours; `too_deep_` is set where the depth limit was reached.
class Converter {
 public:
  TomlTable table(const ::toml::table& from, std::size_t depth) {
    std::vector<TomlEntry> entries;
    for (const auto& [key, node] : from) {
      TomlEntry entry{std::string{key.str()}, place_of(key.source()), value(node, depth + 1)};
      entries.push_back(std::move(entry));
    }
    // toml++ sorts by name; people expect their own order.
    std::stable_sort(entries.begin(), entries.end(), [](const TomlEntry& a, const TomlEntry& b) {
      return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
    });
    TomlTable to;
    for (TomlEntry& entry : entries) to.append(std::move(entry));
    return to;
  }

  [[nodiscard]] const std::optional<TomlPlace>& too_deep() const { return too_deep_; }

 private:
  TomlValue value(const ::toml::node& node, std::size_t depth) {
    const TomlPlace place = place_of(node.source());
    if ((node.is_table() || node.is_array()) && depth > kMaxTomlDepth) {
      if (!too_deep_) too_deep_ = place;
      return TomlValue{false, place};
    }
    if (const auto* t = node.as_table()) return TomlValue{table(*t, depth), place};
    if (const auto* a = node.as_array()) {
      TomlArray elements;
      for (const ::toml::node& element : *a) elements.push_back(value(element, depth + 1));
      return TomlValue{std::move(elements), place};
    }
    if (const auto* b = node.as_boolean()) return TomlValue{b->get(), place};
    if (const auto* i = node.as_integer()) return TomlValue{i->get(), place};
    if (const auto* f = node.as_floating_point()) return TomlValue{f->get(), place};
    if (const auto* s = node.as_string()) return TomlValue{s->get(), place};
    if (const auto* d = node.as_date()) return TomlValue{as_written(d->get()), place};
    if (const auto* t = node.as_time()) return TomlValue{as_written(t->get()), place};
    return TomlValue{as_written(node.as_date_time()->get()), place};
  }

  std::optional<TomlPlace> too_deep_;
};

// toml++ reports a key given twice at its value; people look for the key.
void point_at_key(Diagnostic& d, const std::string& message) {
  const auto open = message.find('\'');
  const auto close = open == std::string::npos ? open : message.find('\'', open + 1);
  if (close == std::string::npos) return;
  const std::string key = message.substr(open + 1, close - open - 1);
  d.message = "'" + key + "' is given twice";
  auto last = d.source_line.rfind(key, d.column);
  if (last == std::string::npos) last = d.source_line.find(key);
  if (key.empty() || last == std::string::npos) return;
  d.column = last + 1;
  d.length = key.size();
}

// "'99999999999999999999' is not representable in 64 bits", said at its end.
void tell_range(Diagnostic& d) {
  const auto open = d.message.find('\''), close = d.message.find('\'', open + 1);
  const auto number = d.message.substr(open + 1, close - open - 1);
  d.id = "E0110";
  d.message = "the number is too large: whole numbers go from -9223372036854775808 to 9223372036854775807";
  d.hint = "write a number in this range, or a real number such as 1e20";
  const auto at = d.source_line.rfind(number, d.column);
  if (at == std::string::npos) return;
  const std::size_t sign = at > 0 && (d.source_line[at - 1] == '-' || d.source_line[at - 1] == '+') ? 1 : 0;
  d.column = at + 1 - sign;
  d.length = number.size() + sign;
}

// toml++ places the end of a text that ends with a line break beyond that line.
TomlPlace within_line(const TomlSource& source, TomlPlace place) {
  const auto line = source.line(place.line);
  const auto characters = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
  place.column = std::min(place.column, static_cast<std::size_t>(characters) + 1);
  return place;
}

Diagnostic from_parse_error(const TomlSource& source, const ::toml::parse_error& error) {
  std::string message{error.description()};
  const bool twice = message.find("redefine") != std::string::npos;
  // "Error while parsing string: encountered ..." -> "encountered ..."
  if (const auto colon = message.find(": "); message.rfind("Error while", 0) == 0 && colon != std::string::npos) {
    message.erase(0, colon + 2);
  }
  if (!message.empty() && message[0] == 'E') message[0] = 'e';
  // Bare text is taken for the beginning of true, false, inf or nan.
  const auto has = [&](const char* part) { return message.find(part) != std::string::npos; };
  const bool no_value = has("could not determine value type") || has("expected 'true'") || has("expected 'false'") ||
                        has("expected 'inf'") || has("expected 'nan'");
  if (no_value) message = "this is not a value; text needs \"quotes\"";
  Diagnostic d = diagnostic_at(source, within_line(source, place_of(error.source())), twice ? "E0102" : "E0101",
                               twice ? "a key is given twice: " + message : "not valid TOML: " + message);
  if (twice) {
    point_at_key(d, message);
    d.hint = "keep one of them";
  } else if (has("not representable in 64 bits")) {
    tell_range(d);
  } else if (no_value) {
    d.hint = "text needs \"quotes\"";
  }
  return d;
}

}  // namespace

TomlParsing parse_toml(std::string_view text, const std::string& name) {
  if (auto refused = detail::scan_toml(text, name)) return {std::nullopt, {*std::move(refused)}};
  TomlDocument document{{TomlSource{name, std::string{text}}}, {}};
  const ::toml::parse_result result = ::toml::parse(text, std::string_view{name});
  if (!result) return {std::nullopt, {from_parse_error(document.sources[0], result.error())}};
  Converter converter;
  document.root = converter.table(result.table(), 0);
  if (converter.too_deep()) {
    const std::string message = "nested deeper than " + std::to_string(kMaxTomlDepth) + " levels";
    return {std::nullopt, {diagnostic_at(document.sources[0], *converter.too_deep(), "E0104", message)}};
  }
  return {std::move(document), {}};
}

}  // namespace kith
