#include "kith/runs/verify.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>

#include "kith/files/atomic_file.hpp"
#include "kith/files/published_run.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/run_folder.hpp"
#include "study_runs.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::how;
using ::testing::IsEmpty;
using testing::item_delivery;
using testing::quick_study;
using testing::run;
using testing::run_partly;
using testing::StudyRunTest;

namespace fs = std::filesystem;

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
    for (const auto& mismatch : verify().mismatches) result.push_back(mismatch.id);
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

// A run of an earlier program, whose records had no discussions.
TEST_F(VerifyTest, ComparesWhatRecordsOfAnEarlierLayoutSay) {
  const auto written = Journal::read(folder_ / kJournalFile);
  const auto current = written.find(5).value();
  const auto record = decode_team(team_address(*quick_study().study, 5), current, written.key()).value();
  {
    auto journal = Journal::open(folder_ / kJournalFile, written.identity());
    const JournalEntry entry{5, encode_team(record, written.key(), 8)};
    journal->write(std::span{&entry, 1});
    journal->close();
  }
  ASSERT_NE(Journal::read(folder_ / kJournalFile).find(5), current);
  EXPECT_THAT(ids(), IsEmpty());
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
