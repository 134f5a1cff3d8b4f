#include "kith/analysis/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "kith/analysis/decimals.hpp"
#include "kith/core/text.hpp"

namespace kith {
namespace {

constexpr double kSmallestShownP = 0.0005;

// Three decimals or four significant digits, whichever is less; more where all would be zeros.
std::string number_text(double value) {
  const double size = std::abs(value);
  if (size == 0.0) return "0";
  if (size < 1e-4 || size >= 1e7) return fmt::format("{:.2e}", value);
  const int magnitude = static_cast<int>(std::floor(std::log10(size)));
  const int decimals = magnitude < -2 ? 1 - magnitude : std::clamp(3 - magnitude, 0, 3);
  return fmt::format("{:.{}f}", value, decimals);
}

constexpr int kMoreDecimals = 6;  // at most, than usual

template <typename Holds>
int decimals_until(int least, Holds holds) {
  int decimals = least;
  while (decimals < least + kMoreDecimals && !holds(decimals)) ++decimals;
  return decimals;
}

std::string real_text(double value, ResultKind kind) {
  switch (kind) {
    case ResultKind::kFraction:
      return fixed_text(value, share_decimals(std::array{value}, 3));
    case ResultKind::kP:
      return value < kSmallestShownP ? "< 0.001" : fmt::format("{:.3f}", value);
    default:
      return number_text(value);
  }
}

// Lower-case letters, digits and what is not ASCII, in words joined by underscores; apostrophes join.
std::string field_of(const std::string& name) {
  std::string field;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_upper = c >= 'A' && c <= 'Z';
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || is_upper || byte >= 0x80) {
      field += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (c != '\'' && !field.empty() && field.back() != '_') {
      field += '_';
    }
  }
  if (!field.empty() && field.back() == '_') field.pop_back();
  return field.empty() ? "column" : field;
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  auto text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (is_zero && text.front() == '-') text.erase(0, 1);
  return text;
}

int interval_decimals(double low, double high, int least) {
  return decimals_until(least, [&](int decimals) {
    const auto from = fixed_text(low, decimals), to = fixed_text(high, decimals), zero = fixed_text(0.0, decimals);
    return (low == high || from != to) && (!(low > 0.0) || from != zero) && (!(high < 0.0) || to != zero);
  });
}

std::string interval_text(double low, double high, int least) {
  const int decimals = interval_decimals(low, high, least);
  return "[" + fixed_text(low, decimals) + ", " + fixed_text(high, decimals) + "]";
}

int share_decimals(std::span<const double> shares, int least) {
  return decimals_until(least, [&](int decimals) {
    const auto zero = fixed_text(0.0, decimals), one = fixed_text(1.0, decimals);
    std::map<std::string, double> read;
    return std::all_of(shares.begin(), shares.end(), [&](double share) {
      const auto text = fixed_text(share, decimals);
      return (text != zero || share == 0.0) && (text != one || share == 1.0) &&
             read.emplace(text, share).first->second == share;
    });
  });
}

std::string formatted(const TableCell& cell, ResultKind kind) {
  if (const auto* const text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* const count = std::get_if<std::int64_t>(&cell)) return std::to_string(*count);
  if (const auto* const truth = std::get_if<bool>(&cell)) return *truth ? "yes" : "no";
  if (const auto* const value = std::get_if<double>(&cell)) return real_text(*value, kind);
  return "not estimable";
}

std::vector<std::vector<std::string>> formatted_rows(const ResultTable& table) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(table.rows.size());
  for (const auto& row : table.rows) {
    auto& texts = rows.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) texts.push_back(formatted(row[c], table.columns.at(c).kind));
  }
  return rows;
}

std::vector<std::string> field_names(const ResultTable& table) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const auto& column : table.columns) {
    const auto wanted = column.field.empty() ? field_of(column.name) : column.field;
    auto name = wanted;
    for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}_{}", wanted, number);
    names.push_back(std::move(name));
  }
  return names;
}

std::string p_text(double p) { return p < kSmallestShownP ? std::string{"p < 0.001"} : fmt::format("p = {:.3f}", p); }

std::string not_analysed_text(const Analysis& analysis) {
  const auto text = joined(analysis.not_analysed, "; ");
  return text.empty() ? text : "Not analysed: " + text + ".";
}

}  // namespace kith
