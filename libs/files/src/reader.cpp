#include "kith/files/reader.hpp"

#include <algorithm>
#include <cmath>

#include "kith/core/text.hpp"

namespace kith {
namespace {

std::string number_text(double value) { return to_toml(TomlValue{value}); }

void wrong_type(const TomlValue& value, std::string_view what, std::string_view expected, TomlReport& report) {
  report.error("E0108", value.place(),
               std::string{what} + " must be " + std::string{expected} + ", not " + std::string{value.kind_name()});
}

bool in_range(double value, const RealRange& range) {
  if (range.open_min ? value <= range.min : value < range.min) return false;
  return range.open_max ? value < range.max : value <= range.max;
}

std::string describe(const RealRange& range) {
  const bool below = std::isfinite(range.max);
  const bool above = std::isfinite(range.min);
  const std::string low = (range.open_min ? "greater than " : "at least ") + number_text(range.min);
  const std::string high = (range.open_max ? "less than " : "at most ") + number_text(range.max);
  if (above && below) return low + " and " + high;
  return above ? low : high;
}

std::string describe(const IntegerRange& range) {
  const IntegerRange any;
  const std::string low = "at least " + std::to_string(range.min);
  const std::string high = "at most " + std::to_string(range.max);
  if (range.min != any.min && range.max != any.max) return low + " and " + high;
  return range.min != any.min ? low : high;
}

}  // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  if (!nearest.empty()) return "did you mean '" + nearest + "'?";
  if (known.empty()) return "";
  std::string list = "known: ";
  for (std::size_t i = 0; i < known.size(); ++i) list += (i > 0 ? ", " : "") + known[i];
  return list;
}

std::optional<bool> read_boolean(const TomlValue& value, std::string_view what, TomlReport& report) {
  if (const bool* b = value.boolean()) return *b;
  wrong_type(value, what, "true or false", report);
  return std::nullopt;
}

std::optional<std::string> read_string(const TomlValue& value, std::string_view what, TomlReport& report) {
  if (const std::string* s = value.string()) return *s;
  wrong_type(value, what, "a string", report);
  return std::nullopt;
}

std::optional<std::int64_t> read_integer(const TomlValue& value, std::string_view what, const IntegerRange& range,
                                         TomlReport& report) {
  const std::int64_t* i = value.integer();
  if (i == nullptr) {
    wrong_type(value, what, "an integer", report);
    return std::nullopt;
  }
  if (*i < range.min || *i > range.max) {
    report.error("E0110", value.place(),
                 std::string{what} + " must be " + describe(range) + ", not " + std::to_string(*i));
    return std::nullopt;
  }
  return *i;
}

std::optional<double> read_real(const TomlValue& value, std::string_view what, const RealRange& range,
                                TomlReport& report) {
  if (!value.is_number()) {
    wrong_type(value, what, "a number", report);
    return std::nullopt;
  }
  const double number = value.real() != nullptr ? *value.real() : static_cast<double>(*value.integer());
  if (!std::isfinite(number)) {
    report.error("E0111", value.place(), std::string{what} + " must be finite, not " + number_text(number));
    return std::nullopt;
  }
  if (!in_range(number, range)) {
    report.error("E0110", value.place(), std::string{what} + " must be " + describe(range) + ", not " + to_toml(value));
    return std::nullopt;
  }
  return number;
}

std::optional<std::size_t> read_word(const TomlValue& value, std::string_view what,
                                     const std::vector<std::string>& allowed, TomlReport& report) {
  const auto word = read_string(value, what, report);
  if (!word) return std::nullopt;
  const auto it = std::find(allowed.begin(), allowed.end(), *word);
  if (it != allowed.end()) return static_cast<std::size_t>(it - allowed.begin());
  report.error("E0112", value.place(), std::string{what} + " cannot be '" + *word + "'", suggestion(*word, allowed));
  return std::nullopt;
}

const TomlTable* read_table(const TomlValue& value, std::string_view what, TomlReport& report) {
  if (value.table() == nullptr) wrong_type(value, what, "a table", report);
  return value.table();
}

const TomlArray* read_array(const TomlValue& value, std::string_view what, TomlReport& report) {
  if (value.array() == nullptr) wrong_type(value, what, "an array", report);
  return value.array();
}

void TomlReader::know(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
}

bool TomlReader::has(std::string_view key) {
  know(key);
  return table_.find(key) != nullptr;
}

const TomlValue* TomlReader::value(std::string_view key, Presence presence) {
  know(key);
  const TomlValue* value = table_.find(key);
  if (value == nullptr && presence == Presence::kRequired) report_.error("E0109", place_, missing(key));
  return value;
}

std::optional<bool> TomlReader::boolean(std::string_view key, Presence presence) {
  const TomlValue* v = value(key, presence);
  return v == nullptr ? std::nullopt : read_boolean(*v, in_quotes(key), report_);
}

std::optional<std::string> TomlReader::string(std::string_view key, Presence presence) {
  const TomlValue* v = value(key, presence);
  return v == nullptr ? std::nullopt : read_string(*v, in_quotes(key), report_);
}

std::optional<std::int64_t> TomlReader::integer(std::string_view key, Presence presence, const IntegerRange& range) {
  const TomlValue* v = value(key, presence);
  return v == nullptr ? std::nullopt : read_integer(*v, in_quotes(key), range, report_);
}

std::optional<double> TomlReader::real(std::string_view key, Presence presence, const RealRange& range) {
  const TomlValue* v = value(key, presence);
  return v == nullptr ? std::nullopt : read_real(*v, in_quotes(key), range, report_);
}

std::optional<std::size_t> TomlReader::word(std::string_view key, Presence presence,
                                            const std::vector<std::string>& allowed) {
  const TomlValue* v = value(key, presence);
  return v == nullptr ? std::nullopt : read_word(*v, in_quotes(key), allowed, report_);
}

const TomlArray* TomlReader::array(std::string_view key, Presence presence) {
  const TomlValue* v = value(key, presence);
  return v == nullptr ? nullptr : read_array(*v, in_quotes(key), report_);
}

std::optional<std::vector<std::string>> TomlReader::strings(std::string_view key, Presence presence) {
  const TomlArray* elements = array(key, presence);
  if (elements == nullptr) return std::nullopt;
  std::vector<std::string> strings;
  for (const TomlValue& element : *elements) {
    auto s = read_string(element, "every element of " + in_quotes(key), report_);
    if (s) strings.push_back(*std::move(s));
  }
  if (strings.size() != elements->size()) return std::nullopt;
  return strings;
}

std::optional<TomlReader> TomlReader::table(std::string_view key, Presence presence) {
  const TomlValue* v = value(key, presence);
  if (v == nullptr || read_table(*v, in_quotes(key), report_) == nullptr) return std::nullopt;
  const bool nested = name_.size() > 2 && name_.front() == '[';
  const std::string path = nested ? name_.substr(1, name_.size() - 2) + "." + std::string{key} : std::string{key};
  return TomlReader{*v->table(), v->place(), "[" + path + "]", report_};
}

std::string TomlReader::missing(std::string_view key) const {
  return "key " + in_quotes(key) + " is missing in " + name_;
}

void TomlReader::finish() {
  for (const TomlEntry& entry : table_.entries()) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    report_.error("E0107", entry.place, "unknown key '" + entry.key + "' in " + name_, suggestion(entry.key, known_));
    report_.withdraw("E0109", place_, missing(nearest_word(entry.key, known_)));  // the same mistake
  }
}

}  // namespace kith
