#include "kith/runs/merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>

#include "kith/files/published_run.hpp"
#include "study_runs.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::expected;
using ::testing::HasSubstr;
using testing::how;
using testing::item_delivery;
using testing::kind_of_failure;
using testing::quick_study;
using testing::run;
using ::testing::SizeIs;
using testing::StudyRunTest;
using testing::tables_in;

namespace fs = std::filesystem;

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
  for (const auto& journal : shards.journals) merged.take_up(journal);
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

}  // namespace
}  // namespace kith
