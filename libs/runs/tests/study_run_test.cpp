#include "kith/runs/study_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <fstream>
#include <thread>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"
#include "kith/runs/merge.hpp"
#include "kith/runs/team_codec.hpp"
#include "kith/runs/verify.hpp"
#include "run_support.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::item_delivery;
using testing::quick_study;
using testing::ScratchFolder;
using ::testing::SizeIs;
using testing::tables_in;

namespace fs = std::filesystem;
using Tables = std::map<std::string, std::string>;

StudyRunOptions how() {
  StudyRunOptions options;
  options.program = "kith test";
  options.threads = 2;
  options.checkpoint_seconds = 0.0;  // every team for itself
  return options;
}

// What the study's tables are when nothing happens.
const Tables& expected() {
  static const Tables kTables = [] {
    const ScratchFolder scratch;
    const auto reading = quick_study();
    const auto result = run_teams(item_delivery(), *reading.study, team_addresses(*reading.study));
    RunFolder{scratch.path() / "run", freeze(reading)}.publish(*reading.study, result.teams, {});
    return tables_in(scratch.path() / "run");
  }();
  return kTables;
}

// Runs it to the end and returns the tables.
Tables run(const fs::path& folder, StudyRunOptions options = how()) {
  StudyRun run{folder, quick_study(), std::move(options)};
  EXPECT_TRUE(run.teach(item_delivery()));
  (void)run.publish({});
  return tables_in(folder);
}

// Stops it once so many teams are finished.
void run_partly(const fs::path& folder, std::size_t teams, StudyRunOptions options = how()) {
  std::atomic<bool> stop{false};
  options.threads = 1;
  options.on_progress = [&](std::size_t done, std::size_t, std::size_t) { stop = stop || done >= teams; };
  options.stopped = [&] { return stop.load(); };
  StudyRun run{folder, quick_study(), std::move(options)};
  EXPECT_FALSE(run.teach(item_delivery()));
  EXPECT_EQ(run.num_done(), teams);
}

Error failure_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return Error{ErrorKind::kUsage, ""};
}

ErrorKind kind_of_failure(const std::function<void()>& action) { return failure_of(action).kind(); }

class StudyRunTest : public ::testing::Test {
 protected:
  ScratchFolder scratch_;
  fs::path folder_ = scratch_.path() / "run";
};

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
  EXPECT_EQ(summary->cells[1].knowledge.mean, plain.cells[1].knowledge.mean);
  EXPECT_EQ(summary->group->area_sr.sd, plain.group->area_sr.sd);
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

TEST_F(StudyRunTest, NamesTheTeamsThatADamagedJournalLost) {
  run_partly(folder_, 5);
  const auto file = folder_ / kJournalFile;
  const auto record = *Journal::read(file).find(4);
  auto content = read_file(file);
  content.replace(content.find(record), record.size(), record.size(), '?');
  content.replace(0, 100, 100, '?');
  std::ofstream{file, std::ios::binary} << content;
  {
    StudyRun run{folder_, quick_study(), how()};
    EXPECT_THAT(run.notes(), ElementsAre(AllOf(HasSubstr("4 teams were recovered"), HasSubstr("teams 4, 6"))));
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

// What ends the publication between any two of its steps leaves the old results or the new ones, never both.
TEST_F(StudyRunTest, IsPublishedAsAWholeWhateverEndsIt) {
  struct End : std::exception {};
  const auto other = [] { return quick_study({"seed=2"}); };
  const auto whole = scratch_.path() / "other";
  {
    StudyRun run{whole, other(), how()};
    ASSERT_TRUE(run.teach(item_delivery()));
    (void)run.publish({});
  }
  const auto after = tables_in(whole);
  (void)run(folder_);
  for (const std::string instant :
       {"staged", "generation", "inputs", "log.txt", "manifest.json", "tables", "timings.csv", "published"}) {
    const auto folder = scratch_.path() / instant;
    fs::copy(folder_, folder, fs::copy_options::recursive);
    auto options = how();
    options.replace = true;
    options.on_instant = [&](const std::string& now) {
      if (now == instant) throw End{};
    };
    {
      StudyRun run{folder, other(), options};
      ASSERT_TRUE(run.teach(item_delivery()));
      EXPECT_THROW((void)run.publish({}), End) << instant;
    }
    const auto published = PublishedRun::open(folder);
    const bool is_new = instant != "staged";
    EXPECT_EQ(tables_in(folder), is_new ? after : expected()) << instant;
    EXPECT_EQ(freeze(read_run_folder(folder)), freeze(is_new ? other() : quick_study())) << instant;
    for (const auto& [name, hash] : published.hashes()) EXPECT_EQ(sha256(published.read(name)), hash) << instant;
    StudyRun again{folder, other(), how()};
    EXPECT_EQ(again.num_resumed(), 6u);
    (void)again.publish({});
    EXPECT_EQ(tables_in(folder), after) << instant;
  }
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

TEST_F(StudyRunTest, MergesShardsInAnyOrder) {
  for (const std::size_t count : {1u, 3u, 7u}) {
    std::vector<fs::path> folders;
    for (std::size_t index = 1; index <= count; ++index) {
      auto options = how();
      options.shard = {index, count};
      folders.push_back(scratch_.path() / (std::to_string(index) + "of" + std::to_string(count)));
      StudyRun run{folders.back(), quick_study(), options};
      EXPECT_TRUE(run.teach(item_delivery()));
      run.publish_shard({});
    }
    std::reverse(folders.begin(), folders.end());
    std::rotate(folders.begin(), folders.begin() + static_cast<std::ptrdiff_t>(count / 2), folders.end());
    const auto whole = scratch_.path() / ("all" + std::to_string(count));
    {
      StudyRun merged{whole, quick_study(), how()};
      const auto shards = open_shards(folders, "kith test");
      for (const auto& shard : shards.journals) merged.take_up(shard);
      (void)merged.publish({});
    }
    EXPECT_EQ(tables_in(whole), expected()) << count;
    EXPECT_EQ((StudyRun{whole, quick_study(), how()}).num_resumed(), 6u);
  }
}

class ShardTest : public StudyRunTest {
 protected:
  fs::path shard(const std::string& name, Shard which, const std::string& program = "kith test",
                 const std::vector<std::string>& overrides = {}, bool finish = true) {
    auto options = how();
    options.shard = which;
    options.program = program;
    std::atomic<bool> stop{false};
    options.on_progress = [&](std::size_t, std::size_t, std::size_t) { stop = !finish; };
    options.stopped = [&] { return stop.load(); };
    options.threads = 1;
    StudyRun run{scratch_.path() / name, quick_study(overrides), options};
    EXPECT_EQ(run.teach(item_delivery()), finish);
    if (finish) run.publish_shard({});
    return scratch_.path() / name;
  }

  void expect_refused(const std::vector<fs::path>& folders, const std::string& id,
                      ErrorKind kind = ErrorKind::kInvalidInput) {
    try {
      (void)open_shards(folders, "kith test");
      ADD_FAILURE() << "not refused: " << id;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      ASSERT_FALSE(error.diagnostics().empty());
      EXPECT_EQ(error.diagnostics()[0].id, id) << error.what();
    }
  }
};

TEST_F(ShardTest, AreRefusedUnlessTheyFitTogether) {
  const auto first = shard("1", {1, 3});
  const auto second = shard("2", {2, 3});
  const auto third = shard("3", {3, 3});
  EXPECT_THAT(open_shards(std::vector{third, first, second}, "kith test").journals, SizeIs(3));
  expect_refused({first, second, scratch_.path()}, "E0630");
  expect_refused({first, second, shard("seed", {3, 3}, "kith test", {"seed=2"})}, "E0631");
  expect_refused({first, second, shard("program", {3, 3}, "kith other")}, "E0632");
  expect_refused({first, second, shard("parts", {3, 4})}, "E0633");
  expect_refused({first, second, third, second}, "E0634");
  expect_refused({first, third}, "E0635", ErrorKind::kInfeasible);
  expect_refused({first, second, shard("begun", {3, 3}, "kith test", {}, false)}, "E0636", ErrorKind::kInfeasible);
}

TEST_F(ShardTest, AreRefusedWithADamagedRecordUnlessToldToLeaveItOut) {
  const std::vector folders{shard("1", {1, 2}), shard("2", {2, 2})};
  const auto file = folders[1] / kJournalFile;
  const auto record = *Journal::read(file).find(4);
  auto content = read_file(file);
  const auto at = content.find(record);
  ASSERT_NE(at, std::string::npos);
  content[at + record.size() / 2] = static_cast<char>(content[at + record.size() / 2] ^ 1);
  std::ofstream{file, std::ios::binary} << content;
  expect_refused(folders, "E0637", ErrorKind::kMismatch);
  const auto shards = open_shards(folders, "kith test", true);
  EXPECT_THAT(shards.missing, ElementsAre(AllOf(HasSubstr("shard 2/2"), HasSubstr("team 4"))));
  StudyRun merged{folder_, quick_study(), how()};
  for (const auto& one : shards.journals) merged.take_up(one);
  EXPECT_EQ(kind_of_failure([&] { (void)merged.publish({}); }), ErrorKind::kMismatch);
  EXPECT_FALSE(fs::exists(folder_ / "tables"));
  RunFacts facts;
  facts.missing = shards.missing;
  (void)merged.publish(facts);
  const auto run = PublishedRun::open(folder_);
  EXPECT_EQ(run.missing(), shards.missing);
  const auto teams = run.read("tables/teams.csv");
  EXPECT_EQ(std::count(teams.begin(), teams.end(), '\n'), 6);  // the header and five teams
}

TEST_F(ShardTest, SayWhatIsMissingIfTheyArePutTogetherAllTheSame) {
  const std::vector folders{shard("1", {1, 3}), shard("3", {3, 3}, "kith test", {}, false)};
  EXPECT_THAT(open_shards(folders, "kith test", true).missing,
              ElementsAre("shard 3/3 is not finished: team 6 of 2 are left", "shard 2/3 was not given"));
}

// The inputs in a shard's folder are those of its journal, whatever was there before.
TEST_F(ShardTest, ReplaceTheInputsAndTablesOfWhatWasThere) {
  (void)run(scratch_.path() / "1");
  const auto other = [] { return quick_study({"design.strategies=[\"common\",\"baseline\"]"}); };
  auto options = how();
  options.replace = true;
  options.shard = {1, 2};
  {
    StudyRun run{scratch_.path() / "1", other(), options};
    EXPECT_TRUE(run.teach(item_delivery()));
    run.publish_shard({});
  }
  EXPECT_EQ(freeze(read_run_folder(scratch_.path() / "1")), freeze(other()));
  EXPECT_FALSE(fs::exists(scratch_.path() / "1" / "tables"));
  EXPECT_EQ(kind_of_failure([&] { (void)PublishedRun::open(scratch_.path() / "1"); }), ErrorKind::kInvalidInput);
}

TEST_F(ShardTest, AreRefusedFromAMachineThatRoundsDifferently) {
  const std::vector folders{shard("1", {1, 2}), shard("2", {2, 2})};
  auto elsewhere = *Journal::identify(folders[1] / kJournalFile);
  elsewhere.arithmetic = "0123456789abcdef";
  (void)Journal::create(folders[1] / kJournalFile, elsewhere);
  expect_refused(folders, "E0639");
}

TEST_F(ShardTest, AreRefusedWithTheManifestOfAnotherStudy) {
  const std::vector folders{shard("1", {1, 2}), shard("2", {2, 2})};
  (void)shard("other", {2, 2}, "kith test", {"seed=2"});
  fs::copy_file(scratch_.path() / "other" / "manifest.json", folders[1] / "manifest.json",
                fs::copy_options::overwrite_existing);
  expect_refused(folders, "E0638", ErrorKind::kMismatch);
}

TEST_F(ShardTest, DoNotMixInOneFolder) {
  (void)shard("1", {1, 3});
  EXPECT_EQ(kind_of_failure([&] {
              auto options = how();
              options.shard = {2, 3};
              StudyRun{scratch_.path() / "1", quick_study(), options};
            }),
            ErrorKind::kUsage);
}

// Threads of one process that behave like ranks.
class ThreadRanks {
 public:
  explicit ThreadRanks(std::size_t size) : size_{size}, barrier_{static_cast<std::ptrdiff_t>(size)} {}

  class One final : public Ranks {
   public:
    One(ThreadRanks& all, std::size_t rank) : all_{all}, rank_{rank} {}
    std::uint64_t take(std::uint64_t n) override { return all_.counter_.fetch_add(n); }
    [[nodiscard]] std::size_t rank() const override { return rank_; }
    [[nodiscard]] std::size_t size() const override { return all_.size_; }
    [[nodiscard]] std::string broadcast(std::string bytes) override {
      if (rank_ == 0) all_.message_ = std::move(bytes);
      wait_for_all();
      auto result = all_.message_;
      wait_for_all();
      return result;
    }
    [[nodiscard]] bool any(bool mine) override {
      if (mine) all_.any_ = true;
      wait_for_all();
      const bool result = all_.any_;
      wait_for_all();
      all_.any_ = false;
      wait_for_all();
      return result;
    }
    void wait_for_all() override { all_.barrier_.arrive_and_wait(); }

   private:
    ThreadRanks& all_;
    std::size_t rank_;
  };

 private:
  std::size_t size_;
  std::barrier<> barrier_;
  std::atomic<std::uint64_t> counter_{0};
  std::string message_;
  std::atomic<bool> any_{false};
};

// Runs it on ranks; `stop_after` teams of a rank stop all of them.
bool run_on_ranks(const fs::path& folder, std::size_t size, std::size_t stop_after = 1000) {
  ThreadRanks ranks{size};
  std::atomic<bool> finished{true};
  std::vector<std::thread> threads;
  for (std::size_t rank = 0; rank < size; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadRanks::One one{ranks, rank};
      auto options = how();
      options.threads = 1;
      options.ranks = &one;
      std::size_t taught = 0;
      options.on_progress = [&](std::size_t, std::size_t, std::size_t) { ++taught; };
      options.stopped = [&] { return taught >= stop_after; };
      StudyRun run{folder, quick_study(), options};
      if (!run.teach(item_delivery())) finished = false;
      if (finished) (void)run.publish({});
    });
  }
  for (auto& thread : threads) thread.join();
  return finished;
}

TEST_F(StudyRunTest, GivesTheSameTablesOnAnyNumberOfRanks) {
  for (const std::size_t size : {1u, 2u, 4u}) {
    const auto folder = scratch_.path() / std::to_string(size);
    EXPECT_TRUE(run_on_ranks(folder, size));
    EXPECT_EQ(tables_in(folder), expected());
    EXPECT_THAT(rank_journals(folder), IsEmpty());
  }
}

TEST_F(StudyRunTest, TakesUpWhatRanksLeftWhenTheyWereStopped) {
  EXPECT_FALSE(run_on_ranks(folder_, 2, 1));
  {
    StudyRun run{folder_, quick_study(), how()};
    EXPECT_GE(run.num_resumed(), 1u);
    EXPECT_THAT(rank_journals(folder_), IsEmpty());
  }
  EXPECT_EQ(run(folder_), expected());
}

class VerifyTest : public StudyRunTest {
 protected:
  void SetUp() override { (void)run(folder_); }

  Verification verify(double sample = 1.0) {
    VerifyOptions options;
    options.sample = sample;
    return verify_run(folder_, read_run_folder(folder_), item_delivery(), options);
  }

  std::vector<std::string> ids() {
    std::vector<std::string> result;
    for (const auto& one : verify().mismatches) result.push_back(one.id);
    return result;
  }

  void change_journal(const std::string& sql) {
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / kJournalFile).c_str(), &handle), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(handle);
  }
};

TEST_F(VerifyTest, FindsTheSameBytesAgain) {
  const auto all = verify();
  EXPECT_EQ(all.teams, 6u);
  EXPECT_EQ(all.checked, 6u);
  EXPECT_EQ(all.files, 9u);  // two inputs, six tables, the codebook
  EXPECT_THAT(all.mismatches, IsEmpty());
  EXPECT_EQ(verify(0.5).checked, 3u);
  EXPECT_EQ(verify(0.01).checked, 1u);
}

TEST_F(VerifyTest, NamesATeamThatComesOutDifferently) {
  const auto written = Journal::read(folder_ / kJournalFile);
  auto record = decode_team(team_address(*quick_study().study, 5), *written.find(5), written.key());
  record->knowledge += 1e-15;
  {
    auto journal = Journal::open(folder_ / kJournalFile, written.identity());
    const JournalEntry entry{5, encode_team(*record, written.key())};
    journal->write(std::span{&entry, 1});
    journal->close();
  }
  const auto result = verify();
  ASSERT_FALSE(result.mismatches.empty());
  EXPECT_EQ(result.mismatches[0].id, "E0640");
  EXPECT_THAT(result.mismatches[0].message, HasSubstr("team 5 (common, NP, replicate 2)"));
  EXPECT_THAT(ids(), ::testing::Contains("E0642"));
}

TEST_F(VerifyTest, NamesAFileThatWasChanged) {
  std::ofstream{folder_ / "tables" / "teams.csv", std::ios::app} << "\n";
  EXPECT_THAT(ids(), ElementsAre("E0641"));
}

TEST_F(VerifyTest, NamesADamagedRecord) {
  change_journal("UPDATE units SET record = x'00' WHERE team = 2");
  EXPECT_THAT(ids(), ElementsAre("E0643"));
}

TEST_F(VerifyTest, NamesATeamThatIsMissing) {
  change_journal("DELETE FROM units WHERE team = 2");
  const auto result = verify();
  ASSERT_FALSE(result.mismatches.empty());
  EXPECT_THAT(result.mismatches.back().message, HasSubstr("team 2 (baseline, NP, replicate 2) is missing"));
  EXPECT_THAT(ids(), ::testing::Contains("E0644"));
}

TEST_F(VerifyTest, NamesTheJournalOfAShardUnderTheTablesOfAWholeStudy) {
  auto options = how();
  options.shard = {2, 2};
  const auto shard = scratch_.path() / "shard";
  {
    StudyRun run{shard, quick_study(), options};
    ASSERT_TRUE(run.teach(item_delivery()));
    run.publish_shard({});
  }
  fs::copy_file(shard / kJournalFile, folder_ / kJournalFile, fs::copy_options::overwrite_existing);
  EXPECT_THAT(ids(), ::testing::Contains("E0644"));
}

TEST_F(VerifyTest, NamesTablesWithoutAManifest) {
  fs::remove(folder_ / kManifestFile);
  EXPECT_THAT(ids(), ElementsAre("E0641"));
}

TEST_F(VerifyTest, LooksAtUnfinishedRunsToo) {
  const auto folder = scratch_.path() / "partly";
  run_partly(folder, 3);
  const auto result = verify_run(folder, read_run_folder(folder), item_delivery(), {});
  EXPECT_EQ(result.checked, 3u);
  EXPECT_EQ(result.files, 0u);
  EXPECT_THAT(result.mismatches, IsEmpty());
}

}  // namespace
}  // namespace kith
