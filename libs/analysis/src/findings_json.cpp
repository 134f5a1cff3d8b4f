#include <cmath>
#include <nlohmann/json.hpp>

#include "kith/analysis/finding.hpp"
#include "result_words.hpp"

namespace kith {
namespace {

using Json = nlohmann::ordered_json;

Json cell_json(const TableCell& cell) {
  return std::visit(
      [](const auto& value) -> Json {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::monostate>) {
          return nullptr;
        } else if constexpr (std::is_same_v<Value, double>) {
          return std::isfinite(value) ? Json(value) : Json(nullptr);
        } else {
          return value;
        }
      },
      cell);
}

// The residuals of an analysis of variance have no F: such cells of numbers hold an empty text.
bool applies(const TableCell& cell, ResultKind kind) {
  const auto* const text = std::get_if<std::string>(&cell);
  return kind == ResultKind::kText || text == nullptr || !text->empty();
}

Json table_json(const ResultTable& table) {
  const auto fields = field_names(table);
  Json columns = Json::array(), rows = Json::array();
  for (std::size_t c = 0; c < fields.size(); ++c) {
    const auto& column = table.columns[c];
    columns.push_back({{"field", fields[c]}, {"name", column.name}, {"kind", word_for(column.kind)}});
  }
  for (const auto& cells : table.rows) {
    Json row = Json::object();
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (applies(cells[c], table.columns[c].kind)) row[fields.at(c)] = cell_json(cells[c]);
    }
    rows.push_back(std::move(row));
  }
  return {{"caption", table.caption}, {"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

}  // namespace

std::string findings_json(const Analysis& analysis) {
  Json findings = Json::array();
  for (const auto& finding : analysis.findings) {
    Json tables = Json::array();
    for (const auto& table : finding.tables) tables.push_back(table_json(table));
    Json methods = Json::array();
    for (const auto& method : finding.methods) methods.push_back(method.text);
    findings.push_back({{"id", finding.id},
                        {"title", finding.title()},
                        {"question", finding.question},
                        {"model", finding.model},
                        {"sentence", finding.sentence},
                        {"results", finding.results},
                        {"warnings", finding.warnings},
                        {"tables", std::move(tables)},
                        {"methods", std::move(methods)}});
  }
  return findings.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kith
