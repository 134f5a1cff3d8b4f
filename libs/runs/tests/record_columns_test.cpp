#include "kith/study/record_columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <type_traits>

#include "kith/runs/team_codec.hpp"
#include "kith/study/tables.hpp"
#include "run_support.hpp"

namespace kith {
namespace {

constexpr std::string_view kMarkKey = "whose work it is";

using Cells = std::map<std::string, std::string>;   // by column
using Expected = std::map<std::string, Cells>;      // by table
using Tables = std::map<std::string, std::string>;  // text by table

// The tables with one row per record. A record with a table that is not here does not compile.
std::string file_of(columns::Declared<TeamRecord>) { return "teams.csv"; }
std::string file_of(columns::Declared<LearnerRecord>) { return "learners.csv"; }
std::string file_of(columns::Declared<PeriodRecord>) { return "periods.csv"; }
std::string file_of(columns::Declared<ResponseRecord>) { return "responses.csv"; }
std::string file_of(columns::Declared<DiscussionRecord>) { return "discussions.csv"; }
std::string file_of(columns::Declared<DemonstrationRecord>) { return "demonstrations.csv"; }
std::string file_of(columns::Declared<ProgressRecord>) { return "progress.csv"; }
std::string file_of(columns::Declared<ExamRecord>) { return "exam.csv"; }
std::string file_of(columns::Declared<EstimateRecord>) { return "estimates.csv"; }

// Gives every member of a record another value, and remembers which cell must show it.
template <typename Record>
class Marks {
 public:
  Marks(Record& record, std::string file, const Study& study, Expected& expected, int& next)
      : record_{record}, file_{std::move(file)}, study_{study}, expected_{expected}, next_{next} {}

  void column(auto member, const ColumnWords& words, const RecordColumn& /*options*/ = {}) {
    expect(words.name, mark(record_.*member));
  }
  template <typename Values>
  void columns(Values Record::*member, std::vector<Column> (*list)(const Study&),
               const RecordColumn& /*options*/ = {}) {
    const auto all = list(study_);
    if constexpr (std::is_same_v<Values, std::vector<double>>) (record_.*member).resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) expect(all[i].name, mark((record_.*member).at(i)));
  }
  void traits(std::vector<double> Record::*member) { columns(member, trait_columns); }
  template <typename Part>
  void part(Part Record::*member, const RecordColumn& /*options*/ = {}) {
    mark_part(record_.*member);
  }
  void derived(auto /*function*/, const ColumnWords& /*words*/, const RecordColumn& /*options*/ = {}) {}
  void kept(std::size_t Record::*member, int /*since*/ = 0) { mark(record_.*member); }
  void kept(std::optional<double> Record::*member, int /*since*/ = 0) { mark(record_.*member); }
  template <typename Row>
  void kept(std::vector<Row> Record::*member, int /*since*/ = 0) {
    Row row;
    Marks<Row> marks{row, file_of(columns::Declared<Row>{}), study_, expected_, next_};
    declare(marks, columns::Declared<Row>{});
    (record_.*member).push_back(std::move(row));
  }
  void kept(std::vector<BeliefSnapshot> Record::*member, int /*since*/ = 0) {
    (record_.*member).push_back({.period = 1, .belief = "own 1", .points = {0.0, 0.6, 0.8}, .weights = {1.0}});
  }

 private:
  void expect(std::string_view name, std::string text) {
    const bool is_new = expected_[file_].emplace(name, std::move(text)).second;
    EXPECT_TRUE(is_new) << file_ << " has " << name << " twice";
  }
  template <typename Part>
  void mark_part(Part& part) {
    Marks<Part> marks{part, file_, study_, expected_, next_};
    declare(marks, columns::Declared<Part>{});
  }
  template <typename Part>
  void mark_part(std::optional<Part>& part) {
    mark_part(part.emplace());
  }

  std::string mark(std::size_t& value) {
    value = static_cast<std::size_t>(++next_);
    return std::to_string(value);
  }
  std::string mark(double& value) {
    value = ++next_ + 0.5;
    return std::to_string(next_) + ".5";
  }
  std::string mark(bool& value) {
    value = true;
    return "true";
  }
  std::string mark(char& letter) {
    letter = study_.variants.front().learner_types.front().letter;
    return {letter};
  }
  std::string mark(std::string& text) { return text = "text " + std::to_string(++next_); }
  std::string mark(SessionStatus& status) {
    status = SessionStatus::kSkipped;
    return "skipped";
  }
  std::string mark(IntegerVector& counts) {
    counts = {++next_, 1};
    return std::to_string(next_) + " 1";
  }
  std::string mark(std::vector<HalfSpace>& half_spaces) {
    half_spaces.emplace_back(IntegerVector{++next_, 1, 0});
    return std::to_string(next_) + " 1 0";
  }
  template <typename Value>
  std::string mark(std::optional<Value>& value) {
    return mark(value.emplace());
  }

  Record& record_;
  std::string file_;
  const Study& study_;
  Expected& expected_;
  int& next_;
};

// One variant that has every column there can be.
Study full_study() {
  auto study = *testing::quick_study().study;
  auto& spec = study.variants.front();
  spec.record = RecordLevel::kParticles;
  spec.teaching.hypotheses_about = HypothesesAbout::kKinds;
  spec.exam = ExamLevel::kPeriod;
  spec.estimates = spec.beliefs = true;
  spec.forecast_sessions = 10;
  spec.group.discussion.choice.model = &discussion_models().back();
  return study;
}

Tables marked_tables(const Study& study, const TeamRecord& team) {
  Tables tables;
  write_study_tables(study, std::span{&team, 1},
                     [&](std::string_view file, std::string_view piece) { tables[std::string{file}] += piece; });
  return tables;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream{line};
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

Cells first_row(const std::string& csv) {
  std::istringstream lines{csv};
  std::string header, row;
  std::getline(lines, header);
  std::getline(lines, row);
  Cells result;
  const auto names = cells_of(header), values = cells_of(row);
  EXPECT_EQ(names.size(), values.size()) << csv;
  for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) result[names[i]] = values[i];
  return result;
}

struct MarkedTeam {
  Study study = full_study();
  TeamRecord team;
  Expected expected;

  MarkedTeam() {
    team.address.strategy = study.variants.front().strategies.front().name;
    team.address.composition = study.variants.front().compositions.front();
    int next = 0;
    Marks<TeamRecord> marks{team, file_of(columns::Declared<TeamRecord>{}), study, expected, next};
    declare(marks, columns::Declared<TeamRecord>{});
  }
};

TEST(RecordColumns, EveryLineIsACellOfItsTable) {
  const MarkedTeam marked;
  const auto tables = marked_tables(marked.study, marked.team);
  for (const auto& [file, cells] : marked.expected) {
    const auto row = first_row(tables.at(file));
    for (const auto& [name, text] : cells) {
      const auto found = row.find(name);
      EXPECT_EQ(found == row.end() ? "no column" : found->second, text) << file << ": " << name;
    }
  }
}

TEST(RecordColumns, EveryLineIsAnEntryOfTheCodebook) {
  const MarkedTeam marked;
  for (const auto& table : study_tables(marked.study)) {
    for (const auto& column : table.columns)
      EXPECT_TRUE(column.type != ColumnType::kReal || !column.unit.empty()) << table.file << ": " << column.name;
    for (const auto& [name, text] : marked.expected.count(table.file) != 0 ? marked.expected.at(table.file) : Cells{}) {
      const auto is_it = [&, &name = name](const Column& column) { return column.name == name; };
      const auto found = std::find_if(table.columns.begin(), table.columns.end(), is_it);
      ASSERT_NE(found, table.columns.end()) << table.file << ": " << name;
      EXPECT_FALSE(found->description.empty()) << table.file << ": " << name;
    }
  }
}

TEST(RecordColumns, EveryLineIsKeptByTheJournal) {
  const MarkedTeam marked;
  const auto bytes = encode_team(marked.team, kMarkKey);
  const auto again = decode_team(marked.team.address, bytes, kMarkKey);
  ASSERT_TRUE(again);
  EXPECT_EQ(marked_tables(marked.study, *again), marked_tables(marked.study, marked.team));
  EXPECT_EQ(encode_team(*again, kMarkKey), bytes);
}

// Journals of before must be read: a member that is added says RecordColumn::since, which makes another layout.
TEST(RecordColumns, AnotherLayoutHasAnotherNumber) {
  const MarkedTeam marked;
  const auto bytes = encode_team(marked.team, kMarkKey);
  EXPECT_EQ(std::pair(static_cast<int>(bytes.front()), bytes.size()), std::pair(11, std::size_t{569}));
}

}  // namespace
}  // namespace kith
