// The tables of a run folder as reports read them, against a small study. Teams come in ascending order, every cell has
// its column's type, and every row is one of the design.

#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/study/read_tables.hpp"
#include "kith/study/tables.hpp"

using namespace kith;

namespace {

constexpr std::size_t kKeys = 5;  // strategy, composition, the varied key, replicate, team

void check_cells(const StudyRow& row, const std::vector<Column>& columns) {
  for (std::size_t i = 0; i + kKeys < columns.size(); ++i) {
    const auto& column = columns[i + kKeys];
    if (!column.required) continue;
    if (column.type == ColumnType::kText) static_cast<void>(row.text(column.name));
    if (column.type == ColumnType::kBoolean) static_cast<void>(row.boolean(column.name));
    if (column.type == ColumnType::kReal)
      fuzzing::require(row.real(column.name) == row.real(column.name), "no real cell is NaN");
    if (column.type == ColumnType::kInteger)
      fuzzing::require(row.count(column.name, 0, 99) <= 99, "counts are in range");
  }
}

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"run_table"};
  if (dice.one_in(20)) return mutate_bytes(input, dice);
  const auto [head, body] = behind_bytes(input, 1);
  return std::string{head} + mutate_csv(body, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  const auto [head, body] = behind_bytes(input, 1);
  return std::string{head} + cross_csv(body, behind_bytes(other, 1).body, dice);
}

// The first byte chooses the table.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto kStudy = fuzzing::tiny_study().study.value();
  static const auto kTables = study_tables(kStudy);
  static const auto kTeams = register_teams(kStudy);
  fuzzing::Bytes bytes{data, size};
  const auto& table = kTables[bytes.below(kTables.size())];
  std::vector<std::string_view> wanted;
  for (std::size_t i = kKeys; i < table.columns.size(); ++i) wanted.push_back(table.columns[i].name);
  const auto outcome = fuzzing::reads(bytes.rest(), table.file, [&] {
    std::size_t last = 0;
    std::size_t seen = 0;
    const auto rows =
        read_study_table(bytes.rest(), table.file, kStudy, kTeams, table.file, wanted, [&](const StudyRow& row) {
          fuzzing::require(row.team() >= last, "teams come in ascending order");
          fuzzing::require(row.address().team == row.team() + 1, "with their number");
          last = row.team();
          ++seen;
          check_cells(row, table.columns);
        });
    fuzzing::require(rows == seen, "every row is handed out");
  });
  fuzzing::note({reinterpret_cast<const char*>(data), size}, outcome);
  return 0;
}
