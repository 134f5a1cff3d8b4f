// Any table with a model: the first line is the formula, the second the column that says what was observed in full (may
// be empty), the rest the table. An error with its place, or findings without a NaN.

#include <cmath>

#include "../fuzzing.hpp"
#include "kith/analysis/table_model.hpp"

using namespace kith;

namespace {

void check(const ResultTable& table) {
  for (const auto& row : formatted_rows(table)) {
    fuzzing::require(row.size() == table.columns.size(), "a row has a cell per column", table.caption);
  }
  for (const auto& row : table.rows) {
    for (const auto& cell : row) {
      const auto* const number = std::get_if<double>(&cell);
      fuzzing::require(number == nullptr || !std::isnan(*number), "what is not known is missing", table.caption);
    }
  }
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "effect", .head_lines = 2};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  ModelQuestion question{.formula = std::string{bytes.line()}, .observed = {}};
  if (const auto observed = bytes.line(); !observed.empty()) question.observed = observed;
  return fuzzing::reads(bytes.rest(), "table.csv", [&] {
    const auto table = Dataset::parse(bytes.rest(), "table.csv");
    fuzzing::require(!table_plan(table, question, {}).empty(), "every question has a plan");
    const auto again = Dataset::parse(table_csv(table), "again.csv");
    fuzzing::require(again.num_rows() == table.num_rows(), "a table reads as written");
    const auto analysis = analyze_balanced_table(table, question, {});
    if (!analysis) return;
    for (const auto& finding : analysis->findings) {
      fuzzing::require(!finding.sentence.empty(), "a finding is a sentence");
      for (const auto& result : finding.tables) check(result);
    }
  });
}
