// The tables of a run folder as reports read them, against a small study. Teams come in ascending order, every cell has
// its member's type, and every row is one of the design.

#include <map>

#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/study/read_records.hpp"
#include "kith/study/tables.hpp"

using namespace kith;

namespace {

// Reads all columns of a table; returns the number of rows.
template <typename Record>
std::size_t read_all(std::string_view text, const TableDescription& table, const Study& study,
                     const std::vector<TeamAddress>& teams) {
  std::vector<std::string_view> wanted;
  for (const auto& column : table.columns) wanted.push_back(column.name);
  std::size_t last = 0, seen = 0;
  const auto rows = read_records<Record>({text, table.file, &study, teams}, wanted,
                                         [&](const RecordRow& row, const Record& /*record*/) {
                                           fuzzing::require(row.team >= last, "teams come in ascending order");
                                           fuzzing::require(row.address.team == row.team + 1, "with their number");
                                           last = row.team;
                                           ++seen;
                                         });
  fuzzing::require(rows == seen, "every row is handed out");
  return rows;
}

using Read = std::size_t (*)(std::string_view, const TableDescription&, const Study&, const std::vector<TeamAddress>&);
const std::map<std::string, Read> kReaders{
    {"teams.csv", read_all<TeamRecord>},        {"learners.csv", read_all<LearnerRecord>},
    {"periods.csv", read_all<PeriodRecord>},    {"responses.csv", read_all<ResponseRecord>},
    {"progress.csv", read_all<ProgressRecord>}, {"demonstrations.csv", read_all<DemonstrationRecord>},
    {"exam.csv", read_all<ExamRecord>},         {"estimates.csv", read_all<EstimateRecord>}};

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "run_table", .head_bytes = 1};

// The first byte chooses the table.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  static const auto kStudy = fuzzing::tiny_study().study.value();
  static const auto kTables = study_tables(kStudy);
  static const auto kTeams = team_addresses(kStudy);
  fuzzing::Bytes bytes{input};
  const auto& table = kTables[bytes.below(kTables.size())];
  const auto reader = kReaders.find(table.file);
  if (reader == kReaders.end()) return Outcome::kRefused;  // particles.csv is for people
  return fuzzing::reads(bytes.rest(), table.file,
                        [&] { static_cast<void>(reader->second(bytes.rest(), table, kStudy, kTeams)); });
}
