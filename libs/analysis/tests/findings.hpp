#pragma once

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kith/core/error.hpp"

namespace kith::testing {

[[nodiscard]] inline Finding finding(const Analysis& analysis, const std::string& id) {
  for (const auto& finding : analysis.findings) {
    if (finding.id == id) return finding;
  }
  throw std::out_of_range{"no finding " + id};
}

[[nodiscard]] inline bool has_finding(const Analysis& analysis, const std::string& id) {
  return std::any_of(analysis.findings.begin(), analysis.findings.end(), [&](const auto& one) { return one.id == id; });
}

[[nodiscard]] inline std::vector<std::string> methods_of(const Finding& finding) {
  std::vector<std::string> texts;
  for (const auto& method : finding.methods) texts.push_back(method.text);
  return texts;
}

[[nodiscard]] inline std::pair<ErrorKind, std::string> failure_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return {error.kind(), error.diagnostics().empty() ? "" : error.diagnostics().front().id};
  }
  return {ErrorKind::kPartial, "nothing was thrown"};
}

[[nodiscard]] inline const ResultTable& table_named(const Finding& finding, const std::string& part) {
  for (const auto& table : finding.tables) {
    if (table.caption.find(part) != std::string::npos) return table;
  }
  throw std::out_of_range{"no table " + part};
}

// The number in a table, by the texts of its row's first cell and of its column.
[[nodiscard]] inline double cell_at(const ResultTable& table, const std::string& row, const std::string& column) {
  for (const auto& cells : table.rows) {
    if (std::get<std::string>(cells.front()) != row) continue;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (table.columns[c].name == column) return std::get<double>(cells[c]);
    }
  }
  throw std::out_of_range{"no cell " + row + "/" + column};
}

[[nodiscard]] inline double number(const Finding& finding, std::size_t table, const std::string& row,
                                   const std::string& column) {
  return cell_at(finding.tables.at(table), row, column);
}

}  // namespace kith::testing
