// Any table with a model: the first line is the formula, the second the column that says what was observed in full (may
// be empty), the rest the table. An error with its place, or findings without a NaN.

#include <cmath>

#include "../fuzzing.hpp"
#include "kith/analysis/analysis.hpp"

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

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzzing::Bytes bytes{data, size};
  ModelQuestion question{.formula = std::string{bytes.line()}, .observed = {}};
  if (const auto observed = bytes.line(); !observed.empty()) question.observed = observed;
  fuzzing::reads(bytes.rest(), "table.csv", [&] {
    const auto table = Dataset::parse(bytes.rest(), "table.csv");
    const auto analysis = analyze_table(table, question, {.permutations = 3, .resamples = 3});
    fuzzing::require(!analysis.findings.empty(), "an analysis finds something");
    for (const auto& finding : analysis.findings) {
      fuzzing::require(!finding.sentence.empty(), "a finding is a sentence");
      for (const auto& result : finding.tables) check(result);
    }
  });
  return 0;
}
