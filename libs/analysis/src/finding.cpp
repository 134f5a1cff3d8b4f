#include "kith/analysis/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string real_text(double value, ResultKind kind) {
  switch (kind) {
    case ResultKind::kFraction:
      return fmt::format("{:.3f}", value);
    case ResultKind::kP:
      return value < kSmallestShownP ? "< 0.001" : fmt::format("{:.3f}", value);
    default:
      return number_text(value);
  }
}

}  // namespace

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

std::string p_text(double p) { return p < kSmallestShownP ? std::string{"p < 0.001"} : fmt::format("p = {:.3f}", p); }

}  // namespace kith
