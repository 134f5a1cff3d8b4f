#include "kith/analysis/contrasts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "kith/core/error.hpp"

namespace kith {
namespace {

constexpr double kZeroSum = 1e-6;  // of the largest weight

[[noreturn]] void refuse_contrast(std::string_view text, const std::string& why) {
  throw Error{
      ErrorKind::kUsage,
      fmt::format("contrast '{}': {}; write levels with signs between blanks, such as 'joint + common - baseline'",
                  text, why)};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// What stands between blanks; back-quotes keep blanks together.
std::vector<std::string> pieces_of(std::string_view text, std::string_view whole) {
  std::vector<std::string> pieces;
  std::string piece;
  bool quoted = false;
  for (const char c : text) {
    if (c == '`') quoted = !quoted;
    if (c == ' ' && !quoted) {
      if (!piece.empty()) pieces.push_back(std::move(piece));
      piece.clear();
    } else {
      piece += c;
    }
  }
  if (quoted) refuse_contrast(whole, "a back-quote is not closed");
  if (!piece.empty()) pieces.push_back(std::move(piece));
  return pieces;
}

struct Term {
  PlannedContrast::Weight weight;
  bool has_number = false;
};

Term term_of(const std::string& piece, double sign) {
  Term term{{piece, sign}};
  const auto star = piece.find('*');
  if (star != std::string::npos) {
    if (const auto number = number_in(piece.substr(0, star))) term = {{piece.substr(star + 1), sign * *number}, true};
  }
  auto& level = term.weight.level;
  level.erase(std::remove(level.begin(), level.end(), '`'), level.end());
  return term;
}

std::vector<Term> terms_of(std::string_view text, std::string_view whole) {
  std::vector<Term> terms;
  double sign = 1.0;
  bool expects_level = true;
  for (const auto& piece : pieces_of(text, whole)) {
    const bool is_sign = piece == "+" || piece == "-";
    if (is_sign && expects_level && !terms.empty()) refuse_contrast(whole, "two signs follow each other");
    if (!is_sign && !expects_level) refuse_contrast(whole, "there is no sign before '" + piece + "'");
    if (is_sign) {
      sign = piece == "+" ? 1.0 : -1.0;
    } else {
      terms.push_back(term_of(piece, sign));
    }
    expects_level = is_sign;
  }
  if (terms.empty() || expects_level) refuse_contrast(whole, "a level is missing at the end");
  return terms;
}

// Divides the positive weights by their sum, and the negative ones.
void average(std::vector<PlannedContrast::Weight>& weights) {
  double added = 0.0, subtracted = 0.0;
  for (const auto& weighted : weights) (weighted.weight > 0.0 ? added : subtracted) += std::abs(weighted.weight);
  for (auto& one : weights) one.weight /= one.weight > 0.0 ? added : subtracted;
}

}  // namespace

PlannedContrast difference_of_means(std::string name, const std::vector<std::string>& of,
                                    const std::vector<std::string>& against) {
  PlannedContrast contrast{.name = std::move(name)};
  for (const auto& level : of) contrast.weights.push_back({level, 1.0});
  for (const auto& level : against) contrast.weights.push_back({level, -1.0});
  average(contrast.weights);
  return contrast;
}

PlannedContrast parse_contrast(std::string_view text) {
  PlannedContrast contrast;
  auto rest = text;

  // "name [factor]: terms", or terms alone.
  if (const auto colon = text.find(": "); colon != std::string_view::npos) {
    auto head = trimmed(text.substr(0, colon));
    rest = text.substr(colon + 1);
    if (!head.empty() && head.back() == ']') {
      const auto bracket = head.rfind('[');
      if (bracket == std::string_view::npos) refuse_contrast(text, "a bracket is not opened");
      contrast.factor = trimmed(head.substr(bracket + 1, head.size() - bracket - 2));
      head = trimmed(head.substr(0, bracket));
    }
    contrast.name = head;
  }
  rest = trimmed(rest);
  if (contrast.name.empty()) contrast.name = rest;

  bool any_number = false, any_added = false, any_subtracted = false;
  double sum = 0.0, largest = 0.0;
  for (auto& term : terms_of(rest, text)) {
    auto& weight = term.weight;
    const auto same = [&](const auto& other) { return other.level == weight.level; };
    if (std::any_of(contrast.weights.begin(), contrast.weights.end(), same))
      refuse_contrast(text, "'" + weight.level + "' occurs twice");
    any_number = any_number || term.has_number;
    (weight.weight > 0.0 ? any_added : any_subtracted) = true;
    sum += weight.weight;
    largest = std::max(largest, std::abs(weight.weight));
    contrast.weights.push_back(std::move(weight));
  }

  if (!any_added || !any_subtracted) refuse_contrast(text, "it compares nothing: all signs are alike");
  if (!any_number) {
    average(contrast.weights);
  } else if (std::abs(sum) > kZeroSum * largest) {
    refuse_contrast(text, fmt::format("the weights sum to {:.4g}, not to 0", sum));
  }
  return contrast;
}

SmallestEffect parse_smallest_effect(std::string_view text) {
  const bool standardized = text.substr(0, 2) == "d=";
  const auto size = number_in(standardized ? text.substr(2) : text);
  if (!size || *size <= 0.0) {
    throw Error{
        ErrorKind::kUsage,
        fmt::format("'{}' is not a smallest effect; write a number above 0 in units of the response, such as 0.5, or "
                    "in standard deviations, such as d=0.3",
                    text)};
  }
  return {*size, standardized};
}

}  // namespace kith
