// What tables say of teams, read again.
#include "kith/study/read_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/study/outcomes.hpp"
#include "kith/study/tables.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// A study that records all that can be recorded.
Study recorded_study() {
  StudySpec spec;
  spec.id = "recorded";
  spec.seed = 5;
  spec.replicates = 1;
  spec.strategies = {strategy_named("baseline"), strategy_named("joint")};
  spec.compositions = {"LH"};
  for (const auto& [letter, ability] : {std::pair{'L', 0.62}, std::pair{'H', 0.92}}) {
    LearnerType type{.letter = letter, .label = {}};
    type.parameters.set("ability.mean", ability);
    spec.learner_types.push_back(std::move(type));
  }
  spec.teaching.max_periods = 4;
  spec.exam = ExamLevel::kPeriod;
  spec.estimates = true;
  spec.beliefs = true;
  spec.forecast_sessions = 2;
  return {{spec}};
}

const std::vector<TeamRecord>& recorded_teams() {
  static const auto kTeams = [] {
    const auto study = recorded_study();
    return run_teams(item_delivery(), study, team_addresses(study), {.threads = 1, .on_progress = {}}).teams;
  }();
  return kTeams;
}

std::map<std::string, std::string> written_tables(const std::vector<TeamRecord>& teams) {
  std::map<std::string, std::string> tables;
  write_study_tables(recorded_study(), teams,
                     [&](std::string_view file, std::string_view piece) { tables[std::string{file}] += piece; });
  return tables;
}

// Puts the records of a table where they belong in the teams.
template <typename Record>
void read_back(const std::map<std::string, std::string>& tables, const char* file, std::vector<TeamRecord>& teams,
               std::vector<Record> TeamRecord::*list) {
  const auto study = recorded_study();
  const auto addresses = team_addresses(study);
  const auto all = study_tables(study);
  std::vector<std::string_view> wanted;
  for (const auto& table : all) {
    if (table.file != file) continue;
    for (const auto& column : table.columns) wanted.push_back(column.name);
  }
  EXPECT_GT(read_records<Record>(
                {tables.at(file), file, &study, addresses}, wanted,
                [&](const RecordRow& row, Record& record) { (teams.at(row.team).*list).push_back(std::move(record)); }),
            0u);
}

TEST(ReadRecords, AreThoseThatWereWritten) {
  const auto tables = written_tables(recorded_teams());
  const auto study = recorded_study();
  const auto addresses = team_addresses(study);
  const auto all = study_tables(study);
  std::vector<std::string_view> wanted;
  for (const auto& column : all.front().columns) wanted.push_back(column.name);
  std::vector<TeamRecord> teams;
  read_records<TeamRecord>({tables.at("teams.csv"), "teams.csv", &study, addresses}, wanted,
                           [&](const RecordRow& /*row*/, TeamRecord& team) { teams.push_back(std::move(team)); });
  ASSERT_EQ(teams.size(), recorded_teams().size());
  read_back(tables, "learners.csv", teams, &TeamRecord::learners);
  read_back(tables, "periods.csv", teams, &TeamRecord::period_records);
  read_back(tables, "responses.csv", teams, &TeamRecord::responses);
  read_back(tables, "demonstrations.csv", teams, &TeamRecord::demonstration_records);
  read_back(tables, "progress.csv", teams, &TeamRecord::progress);
  read_back(tables, "exam.csv", teams, &TeamRecord::exams);
  read_back(tables, "estimates.csv", teams, &TeamRecord::estimates);
  for (std::size_t i = 0; i < teams.size(); ++i) {
    for (std::size_t k = 0; k < teams[i].responses.size(); ++k)
      teams[i].responses[k].regret = recorded_teams()[i].responses[k].regret;  // the table has it in other units
  }
  const auto again = written_tables(teams);
  for (const auto& [file, text] : tables) EXPECT_EQ(again.at(file), text) << file;
}

// Without a study, the header says what there is.
TEST(ReadRecords, OfTeamsNeedNoStudy) {
  const auto text = written_tables(recorded_teams()).at("teams.csv");
  std::vector<std::string_view> wanted{"status"};
  for (const auto& outcome : outcomes()) wanted.push_back(outcome.column);
  std::size_t i = 0;
  read_records<TeamRecord>({text, "teams.csv"}, wanted, [&](const RecordRow& row, const TeamRecord& team) {
    EXPECT_EQ(row.address.strategy, recorded_teams()[i].address.strategy);
    EXPECT_EQ(row.team, i);
    for (const auto& outcome : outcomes())
      EXPECT_EQ(outcome.of(team), outcome.of(recorded_teams()[i])) << outcome.column;
    ++i;
  });
  EXPECT_EQ(i, recorded_teams().size());
}

TEST(ReadRecords, NameTheRowThatSaysWhatCannotBe) {
  const auto text = written_tables(recorded_teams()).at("teams.csv");
  const auto fault = [&](const std::string& from, const std::string& to) {
    auto spoiled = text;
    spoiled.replace(spoiled.rfind(from), from.size(), to);
    try {
      read_records<TeamRecord>({spoiled, "teams.csv"}, {"status", "knowledge", "periods"},
                               [](const RecordRow& /*row*/, const TeamRecord& /*team*/) {});
    } catch (const Error& error) {
      return error.diagnostics().front().id + ":" + std::to_string(error.diagnostics().front().line);
    }
    return std::string{"none"};
  };
  const std::string status{name_of(recorded_teams().back().status)};
  const auto ended = "," + status + (recorded_teams().back().completed() ? ",true," : ",false,");
  EXPECT_EQ(fault("," + status + ",", ",bored,"), "E0621:3");
  EXPECT_EQ(fault(ended, ended + "-"), "E0621:3");
}

// Plans, analyses and reports take what they say of outcomes from one table.
TEST(Outcomes, AreColumnsOfTheTableOfTeams) {
  const auto tables = study_tables(recorded_study());
  const auto& columns = tables.front().columns;
  bool was_of_exam = false;
  std::vector<std::size_t> places;
  for (const auto& outcome : outcomes()) {
    EXPECT_EQ(std::ranges::count(columns, outcome.column, &Column::name), 1) << outcome.column;
    EXPECT_EQ(find_outcome(outcome.column), &outcome);
    EXPECT_FALSE(was_of_exam && !outcome.needs_exam) << "those of the exam come last";
    was_of_exam = outcome.needs_exam;
    if (outcome.place > 0) places.push_back(outcome.place);
    for (const auto& team : recorded_teams()) {
      EXPECT_GE(outcome.of(team), outcome.low) << outcome.column;
      EXPECT_LE(outcome.of(team), outcome.high) << outcome.column;
    }
    TeamRecord unexamined;
    if (outcome.needs_exam) {
      EXPECT_THROW((void)outcome.of(unexamined), std::invalid_argument) << outcome.column;
    }
  }
  std::ranges::sort(places);
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(places[i], i + 1) << "one behind the other";
  EXPECT_EQ(find_outcome("speed"), nullptr);
  EXPECT_THROW((void)outcome_named("speed"), std::invalid_argument);
  EXPECT_EQ(analysed_outcomes(true, true).front()->column, "exam_regret");
  EXPECT_EQ(analysed_outcomes(false, false).size(), 2u);
}

}  // namespace
}  // namespace kith
