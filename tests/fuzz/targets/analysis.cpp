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

// The first two lines are words, the rest is a table.
std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"effect"};
  const auto [head, body] = behind_lines(input, 2);
  if (dice.one_in(4)) return mutate_text(head, kVocabulary, dice) + std::string{body};
  return std::string{head} + mutate_text(body, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  const auto [head, body] = behind_lines(input, 2);
  const auto [other_head, other_body] = behind_lines(other, 2);
  if (dice.one_in(4)) return std::string{other_head} + std::string{body};
  return std::string{head} + cross_text(body, other_body, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzzing::Bytes bytes{data, size};
  ModelQuestion question{.formula = std::string{bytes.line()}, .observed = {}};
  if (const auto observed = bytes.line(); !observed.empty()) question.observed = observed;
  const auto outcome = fuzzing::reads(bytes.rest(), "table.csv", [&] {
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
  fuzzing::note({reinterpret_cast<const char*>(data), size}, outcome);
  return 0;
}
