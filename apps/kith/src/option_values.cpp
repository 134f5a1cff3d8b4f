#include "option_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "kith/core/diagnostic.hpp"

namespace kith::cli {
namespace {

bool same_ignoring_case(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

// The option that the parser calls `name`: "--seed", or "domain" for DOMAIN.
const OptionDescription* find_option(const CommandDescription& command, const std::string& name) {
  for (const auto& option : command.options) {
    for (const auto& one : option.names) {
      if (one == name || (option.positional && same_ignoring_case(one, name))) return &option;
    }
  }
  return nullptr;
}

bool is_given(const OptionDescription& option, const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    return std::any_of(option.names.begin(), option.names.end(), [&](const std::string& name) {
      const bool is_long = name.rfind("--", 0) == 0;
      if (is_long) return argument == name || argument.rfind(name + "=", 0) == 0;
      return argument.size() > 1 && argument[1] != '-' && argument.rfind(name, 0) == 0;
    });
  });
}

// Where a value came from, if not from the command line.
std::string origin(const OptionDescription& option, const std::vector<std::string>& arguments) {
  if (option.environment.empty() || is_given(option, arguments)) return "";
  if (std::getenv(option.environment.c_str()) == nullptr) return "";
  return " (set by the environment variable " + option.environment + ")";
}

// "A requires B", "A excludes B": the two names, or nothing.
bool split_at(const std::string& text, const std::string& verb, std::string& a, std::string& b) {
  const auto at = text.find(verb);
  if (at == std::string::npos) return false;
  a = text.substr(0, at);
  b = text.substr(at + verb.size());
  return true;
}

std::string shown(const CommandDescription& command, const std::string& name,
                  const std::vector<std::string>& arguments) {
  const auto* option = find_option(command, name);
  return option == nullptr ? name : option->names.back() + origin(*option, arguments);
}

}  // namespace

std::string wrong_integer(const std::string& text, std::int64_t min, std::int64_t max) {
  std::int64_t value = 0;
  const auto* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec == std::errc{} && result.ptr == end && value >= min && value <= max) return "";
  const bool bounded = max != std::numeric_limits<std::int64_t>::max();
  return "must be an integer" +
         (bounded ? " from " + std::to_string(min) + " to " + std::to_string(max)
                  : ", " + std::to_string(min) + " or more") +
         ", not '" + text + "'";
}

std::optional<ShardOption> shard_of(const std::string& text) {
  ShardOption shard;
  const auto* end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  if (index.ec != std::errc{} || index.ptr == end || *index.ptr != '/') return std::nullopt;
  const auto count = std::from_chars(index.ptr + 1, end, shard.count);
  constexpr std::size_t kMost = 1'000'000;
  if (count.ec != std::errc{} || count.ptr != end || shard.count > kMost) return std::nullopt;
  if (shard.index < 1 || shard.index > shard.count) return std::nullopt;
  return shard;
}

namespace {

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end ? std::optional{value} : std::nullopt;
}

}  // namespace

std::string wrong_number(const std::string& text, const NumberRange& range) {
  const auto value = number_of(text);
  const bool is_above = range.end == NumberRange::kAbove;
  if (value && (is_above ? *value > range.low : *value >= range.low) && *value <= range.high) return "";
  const auto shown = [](double bound) { return fmt::format("{:.{}f}", bound, bound == std::floor(bound) ? 0 : 6); };
  return "must be a number " +
         (is_above ? "above " + shown(range.low) + " and at most " + shown(range.high)
                   : "from " + shown(range.low) + " to " + shown(range.high)) +
         ", not '" + text + "'";
}

std::string wrong_word(const std::string& text, const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), text) != words.end()) return "";
  const auto nearest = nearest_word(text, words);
  std::string list;
  for (const auto& word : words) list += (list.empty() ? "one of: " : ", ") + word;
  return "cannot be '" + text + "'\n" + (nearest.empty() ? list : "did you mean '" + nearest + "'?");
}

UsageError explain_value(const CommandDescription& command, const std::string& complaint,
                         const std::vector<std::string>& arguments) {
  UsageError error{complaint, "", command.name};
  std::string a, b;
  if (complaint.size() > 12 && complaint.substr(complaint.size() - 12) == " is required") {
    for (const auto& option : command.options) {
      if (option.required) error.message = "kith " + command.name + " needs " + option.names.back();
    }
  } else if (split_at(complaint, " requires ", a, b)) {
    error.message = shown(command, a, arguments) + " needs " + b;
  } else if (split_at(complaint, " excludes ", a, b)) {
    error.message = shown(command, a, arguments) + " cannot be combined with " + shown(command, b, arguments);
  } else if (complaint.rfind("Could not convert: ", 0) == 0 && split_at(complaint.substr(19), " = ", a, b)) {
    const auto* option = find_option(command, a);
    error.message = a + " cannot be '" + b + "'" + (option == nullptr ? "" : origin(*option, arguments));
    if (option != nullptr && option->value.empty()) error.hint = "write it alone, or with true or false";
  } else if (split_at(complaint, ": ", a, b)) {
    const auto* option = find_option(command, a);
    if (option == nullptr) return error;
    if (b.find(" required ") != std::string::npos && b.find("missing") != std::string::npos) {
      error.message = option->names.back() + " needs a value";
      return error;
    }
    const auto line_end = b.find('\n');
    error.message = option->names.back() + " " + b.substr(0, line_end) + origin(*option, arguments);
    if (line_end != std::string::npos) error.hint = b.substr(line_end + 1);
  }
  return error;
}

}  // namespace kith::cli
