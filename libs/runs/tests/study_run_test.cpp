#include "kith/runs/study_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kith/files/published_run.hpp"
#include "study_runs.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::expected;
using testing::failure_of;
using ::testing::HasSubstr;
using testing::how;
using testing::item_delivery;
using testing::kind_of_failure;
using testing::quick_study;
using testing::run;
using testing::run_partly;
using ::testing::SizeIs;
using testing::StudyRunTest;
using testing::tables_in;

namespace fs = std::filesystem;

TEST_F(StudyRunTest, GivesTheTablesOfAPlainRunOnAnyNumberOfThreadsAndInAnyOrder) {
  for (const std::size_t threads : {1u, 2u, 7u}) {
    auto options = how();
    options.threads = threads;
    if (threads > 1) options.shuffle = threads;
    EXPECT_EQ(run(scratch_.path() / std::to_string(threads), options), expected());
  }
}

TEST_F(StudyRunTest, SumsUpWhatIsInTheTables) {
  const auto reading = quick_study();
  const auto teams = run_teams(item_delivery(), *reading.study, team_addresses(*reading.study)).teams;
  const auto plain = summarize(teams);
  StudyRun run{folder_, quick_study(), how()};
  ASSERT_TRUE(run.teach(item_delivery()));
  const auto summary = run.publish({});
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->cells.size(), plain.cells.size());
  EXPECT_EQ(summary->cells[1].knowledge->mean, plain.cells[1].knowledge->mean);
  EXPECT_EQ(summary->group->area_sr->sd, plain.group->area_sr->sd);
}

TEST_F(StudyRunTest, GoesOnWhereItWasStopped) {
  run_partly(folder_, 2);
  run_partly(folder_, 4);
  EXPECT_FALSE(fs::exists(folder_ / "tables"));
  StudyRun run{folder_, quick_study(), how()};
  EXPECT_EQ(run.num_resumed(), 4u);
  EXPECT_EQ(run.num_teams(), 6u);
  EXPECT_TRUE(run.teach(item_delivery()));
  (void)run.publish({});
  EXPECT_EQ(tables_in(folder_), expected());
}

TEST_F(StudyRunTest, GoesOnOnlyIfToldSo) {
  auto require = how();
  require.resume = Resume::kRequire;
  EXPECT_EQ(kind_of_failure([&] { StudyRun{folder_, quick_study(), require}; }), ErrorKind::kUsage);
  EXPECT_FALSE(fs::exists(folder_));
  run_partly(folder_, 3);
  EXPECT_EQ((StudyRun{folder_, quick_study(), require}).num_resumed(), 3u);
  auto never = how();
  never.resume = Resume::kNever;
  EXPECT_EQ(run(folder_, never), expected());
  EXPECT_EQ((StudyRun{folder_, quick_study(), require}).num_resumed(), 6u);
}

TEST_F(StudyRunTest, LeavesNothingBehindWithoutAFinishedTeam) {
  { const StudyRun run{folder_, quick_study(), how()}; }
  EXPECT_FALSE(fs::exists(folder_));
  fs::create_directories(folder_);
  { const StudyRun run{folder_, quick_study(), how()}; }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(StudyRunTest, RefusesUnfinishedWorkOfAnotherProgramAndReplacesFinished) {
  run_partly(folder_, 2);
  auto newer = how();
  newer.program = "kith newer";
  const auto refusal = failure_of([&] { StudyRun{folder_, quick_study(), newer}; });
  EXPECT_EQ(refusal.kind(), ErrorKind::kUsage);
  EXPECT_THAT(refusal.what(), AllOf(HasSubstr("2 of 6 teams"), HasSubstr("kith test")));
  EXPECT_EQ(refusal.remedy(), Remedy::kStartOver);
  EXPECT_EQ(run(folder_), expected());
  {
    StudyRun again{folder_, quick_study(), newer};
    EXPECT_EQ(again.num_resumed(), 0u);
    EXPECT_THAT(again.notes(), ElementsAre(HasSubstr("all teams are rerun")));
  }
  EXPECT_EQ(tables_in(folder_), expected());  // as long as nothing new is published
}

TEST_F(StudyRunTest, RefusesUnfinishedWorkOfAnotherStudyUnlessTold) {
  run_partly(folder_, 2);
  const auto other = [] { return quick_study({"seed=2"}); };
  EXPECT_EQ(kind_of_failure([&] { StudyRun{folder_, other(), how()}; }), ErrorKind::kUsage);
  EXPECT_EQ((StudyRun{folder_, quick_study(), how()}).num_resumed(), 2u);
  auto replace = how();
  replace.replace = true;
  EXPECT_EQ((StudyRun{folder_, other(), replace}).num_resumed(), 0u);
}

// Twenty teams more, later, are the same as all of them at once.
TEST_F(StudyRunTest, AddsTeamsToFewerReplicatesWithTheSameBytes) {
  for (const bool is_finished : {true, false}) {
    const auto folder = scratch_.path() / (is_finished ? "whole" : "part");
    auto options = how();
    options.threads = 1;
    std::atomic<bool> stop{false};
    options.on_progress = [&](std::size_t, std::size_t, std::size_t) { stop = !is_finished; };
    options.stopped = [&] { return stop.load(); };
    {
      StudyRun first{folder, quick_study({"replicates=2"}), options};
      EXPECT_EQ(first.teach(item_delivery()), is_finished);
      if (is_finished) (void)first.publish({});
    }
    // A run that is published again has still grown. Only what was published before can have been analysed.
    for (const bool again : {false, true}) {
      StudyRun rest{folder, quick_study(), how()};
      EXPECT_GE(rest.num_resumed(), is_finished || again ? 4u : 1u);
      ASSERT_TRUE(rest.teach(item_delivery()));
      (void)rest.publish({});
      EXPECT_EQ(tables_in(folder), expected());
      const auto manifest = nlohmann::json::parse(PublishedRun::open(folder).manifest());
      EXPECT_EQ(manifest.value("grown", std::vector<std::string>{}).size(), is_finished ? 1u : 0u);
    }
    EXPECT_FALSE(fs::exists(folder / "study.extended.sqlite"));
  }
}

TEST_F(StudyRunTest, NamesTheKeysInWhichAnotherStudyDiffers) {
  (void)run(folder_);
  const auto said = [&](const std::vector<std::string>& sets) {
    return std::string{failure_of([&] { StudyRun{folder_, quick_study(sets), how()}; }).what()};
  };
  EXPECT_THAT(said({"seed=2", "teacher.particles=400"}),
              AllOf(HasSubstr("it differs in seed 1 -> 2, teacher.particles "), HasSubstr(" -> 400")));
  EXPECT_THAT(said({"replicates=2"}), HasSubstr("replicates 3 -> 2"));
  EXPECT_THAT(said({"replicates=4", "seed=2"}), HasSubstr("replicates 3 -> 4"));
}

// Results of another study stay until those of the new one are complete, whatever happens in between.
TEST_F(StudyRunTest, KeepsOtherResultsUntilItsOwnAreComplete) {
  (void)run(folder_);
  const auto other = [] { return quick_study({"seed=2"}); };
  auto options = how();
  options.replace = true;
  std::atomic<bool> stop{false};
  options.on_progress = [&](std::size_t done, std::size_t, std::size_t) { stop = stop || done >= 2; };
  options.stopped = [&] { return stop.load(); };
  {
    StudyRun begun{folder_, other(), options};
    EXPECT_FALSE(begun.teach(item_delivery()));
  }
  EXPECT_EQ(tables_in(folder_), expected());
  StudyRun rest{folder_, other(), how()};  // needs no permission again
  EXPECT_GE(rest.num_resumed(), 2u);
  EXPECT_TRUE(rest.teach(item_delivery()));
  (void)rest.publish({});
  EXPECT_NE(tables_in(folder_), expected());
}

TEST_F(StudyRunTest, TeachesDamagedTeamsAgainAndNamesThem) {
  run_partly(folder_, 5);
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open((folder_ / kJournalFile).c_str(), &handle), SQLITE_OK);
  sqlite3_exec(handle, "UPDATE units SET record = x'0102030405060708090a0b' WHERE team = 4", nullptr, nullptr, nullptr);
  sqlite3_close(handle);
  {
    StudyRun run{folder_, quick_study(), how()};
    EXPECT_THAT(run.notes(), ElementsAre(HasSubstr("team 4 (common, NP, replicate 1)")));
    EXPECT_EQ(run.num_resumed(), 4u);
  }
  EXPECT_EQ(run(folder_), expected());
}

TEST_F(StudyRunTest, StopsIfItsJournalIsBeyondHelp) {
  run_partly(folder_, 2);
  std::ofstream{folder_ / kJournalFile} << "no database";
  const auto refusal = failure_of([&] { StudyRun{folder_, quick_study(), how()}; });
  EXPECT_EQ(refusal.kind(), ErrorKind::kIo);
  EXPECT_THAT(refusal.what(), HasSubstr(kJournalFile));
  EXPECT_EQ(refusal.remedy(), Remedy::kStartOver);
  auto never = how();
  never.resume = Resume::kNever;
  EXPECT_EQ(run(folder_, never), expected());
}

TEST_F(StudyRunTest, StartsOverIfItsJournalIsBeyondHelpAndItMayReplace) {
  run_partly(folder_, 2);
  std::ofstream{folder_ / kJournalFile} << "no database";
  auto options = how();
  options.replace = true;
  StudyRun run{folder_, quick_study(), options};
  EXPECT_THAT(run.notes(), ElementsAre(HasSubstr("starts over")));
  EXPECT_EQ(run.num_resumed(), 0u);
}

TEST_F(StudyRunTest, SaysThatTheJournalOfAFinishedRunIsMissing) {
  (void)run(folder_);
  fs::remove(folder_ / kJournalFile);
  StudyRun run{folder_, quick_study(), how()};
  EXPECT_THAT(run.notes(), ElementsAre(AllOf(HasSubstr(kJournalFile), HasSubstr("is missing"))));
}

TEST_F(StudyRunTest, NamesTheTeamWhoseRecordIsDamaged) {
  run_partly(folder_, 5);
  const auto file = folder_ / kJournalFile;
  const auto record = *Journal::read(file).find(4);
  auto content = read_file(file);
  content.replace(content.find(record), record.size(), record.size(), '?');
  std::ofstream{file, std::ios::binary} << content;
  {
    StudyRun run{folder_, quick_study(), how()};
    EXPECT_THAT(run.notes(), ElementsAre(HasSubstr("the record of team 4 ")));
    EXPECT_EQ(run.num_resumed(), 4u);
  }
  EXPECT_EQ(run(folder_), expected());
}

TEST_F(StudyRunTest, DoesNotPublishIntoAnotherFolderOfTheSameName) {
  StudyRun run{folder_, quick_study(), how()};
  ASSERT_TRUE(run.teach(item_delivery()));
  fs::rename(folder_, scratch_.path() / "moved");
  fs::create_directory(folder_);
  EXPECT_EQ(kind_of_failure([&] { (void)run.publish({}); }), ErrorKind::kIo);
  EXPECT_TRUE(fs::is_empty(folder_));
}

// Learners of type P cannot be drawn, so every team with one of them fails.
StudyReading failing_study() {
  auto reading = quick_study({"design.compositions=[\"NN\",\"NP\"]"});
  for (auto& type : reading.study->variants[0].learner_types) {
    if (type.letter == 'P') type.parameters.set("gain_max", 1e-9);
  }
  return reading;
}

TEST_F(StudyRunTest, NamesTheTeamThatFailsAndSavesTheOthers) {
  std::string message;
  auto options = how();
  options.threads = 1;
  try {
    StudyRun run{folder_, failing_study(), options};
    (void)run.teach(item_delivery());
    ADD_FAILURE() << "no team failed";
  } catch (const std::exception& error) {
    message = error.what();
  }
  EXPECT_THAT(message, HasSubstr("team 4 (baseline, NP, replicate 1) failed: "));
  EXPECT_EQ((StudyRun{folder_, failing_study(), how()}).num_resumed(), 3u);
}

TEST_F(StudyRunTest, GoesOnAfterFailuresIfToldAndTriesThemAgain) {
  auto options = how();
  options.keep_going = true;
  StudyRun run{folder_, failing_study(), options};
  EXPECT_TRUE(run.teach(item_delivery()));
  EXPECT_THAT(run.failures(), SizeIs(6));
  EXPECT_EQ(run.failures()[0].team, 4u);
  const auto summary = run.publish({});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->cells.size(), 2u);
  EXPECT_THAT(read_file(folder_ / "manifest.json"),
              AllOf(HasSubstr("\"teams failed\""), HasSubstr("team 4 (baseline, NP, replicate 1): ")));
}

}  // namespace
}  // namespace kith
