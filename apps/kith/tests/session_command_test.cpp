#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "kith/files/folder_lock.hpp"
#include "kith/files/sqlite.hpp"
#include "kith/store/event_file.hpp"
#include "run_kith.hpp"
#include "small_session.hpp"

namespace kith::testing {
namespace {

using ::testing::ContainsRegex;

// A session in which two groups got a room and one person joined and gave a name.
class SessionCommand : public ::testing::Test {
 protected:
  void SetUp() override { make_session(folder(), 2); }

  [[nodiscard]] std::string folder() const { return scratch_ / "live"; }

  Scratch scratch_;
};

TEST_F(SessionCommand, ListsAndShowsRooms) {
  const auto list = out_of({"session", "list", folder()});
  // Of r1 one person has joined, of r2 nobody; nothing was taught.
  EXPECT_THAT(list, ContainsRegex("\nr1 +common +NP +1 +0 +0 +0 +2023"));
  EXPECT_THAT(list, ContainsRegex("\nr2 +common +NP +0 +0 +0 +0 +- "));
  const auto shown = run_kith({"session", "show", folder(), "--room", "AAAAAA"}).out;
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 2) << shown;
  EXPECT_THAT(err_of(2, {"session", "show", folder()}), HasSubstr("has 2 rooms; say which one with --room ID"));
  EXPECT_THAT(err_of(3, {"session", "show", folder(), "--room", "r9"}), HasSubstr("E1618"));
}

TEST_F(SessionCommand, ShowsTheOnlyRoom) {
  make_session(scratch_ / "one", 1);
  const auto shown = out_of({"session", "show", scratch_ / "one"});
  EXPECT_EQ(shown, run_kith({"session", "show", scratch_ / "one", "--room", "r1"}).out);
  EXPECT_THAT(shown, HasSubstr("joined"));
  make_session(scratch_ / "none", 0);
  EXPECT_THAT(run_kith({"session", "show", scratch_ / "none"}).err, HasSubstr("has 0 rooms"));
}

TEST_F(SessionCommand, ExportsTablesThatAreCompleteAndChecked) {
  EXPECT_EQ(run_kith({"session", "export", folder()}).code, 2);
  const auto ran = run_kith({"session", "export", folder(), "-o", scratch_ / "tables"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(ContainsRegex("\nsessions.csv +2\n"), ContainsRegex("\nevents.csv +2\n")));
  EXPECT_THAT(ran.err, Not(HasSubstr("identify people")));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "tables.partial"));
  ASSERT_EQ(std::system(("cd '" + (scratch_ / "tables") + "' && sha256sum --quiet -c SHA256SUMS").c_str()), 0);
  const auto again = run_kith({"session", "export", folder(), "-o", scratch_ / "tables"});
  EXPECT_EQ(again.code, 2) << "nothing is replaced";
  EXPECT_EQ(run_kith({"session", "export", folder(), "-o", scratch_ / "tables", "--yes"}).code, 0);
  const auto one = run_kith({"session", "export", folder(), "--room", "r1", "-o", scratch_ / "one"});
  EXPECT_THAT(one.out, ContainsRegex("\nsessions.csv +1\n"));
}

TEST_F(SessionCommand, ExportsTablesThatCanBeReported) {
  ASSERT_EQ(run_kith({"session", "export", folder(), "-o", scratch_ / "tables"}).code, 0);
  const auto document = json_of({"report", scratch_ / "tables"});
  EXPECT_EQ(document["overview"]["teams"], 0) << "nobody was taught yet";
  EXPECT_EQ(document["domain"], "item-delivery");
  EXPECT_EQ(run_kith({"report", scratch_ / "tables"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "tables/report.html"));
  EXPECT_THAT(err_of(3, {"report", folder()}), HasSubstr("kith session export"));
}

TEST_F(SessionCommand, ReplaysAndSaysWhatDiffers) {
  EXPECT_THAT(out_of({"session", "replay", folder()}), HasSubstr("all identical"));
  {
    auto file = EventFile::open(folder(), EventFile::read(folder()).identity(), 0);
    StoreBatch batch;
    batch.events.push_back({.room = 1,
                            .seq = 3,
                            .at_us = 1'700'000'004'000'000,
                            .actor = "seat:1",
                            .type = "answered",
                            .json = R"({"test":0,"actions":[],"keys":[],"ms":1})"});
    file.write({&batch, 1});
  }
  EXPECT_THAT(err_of(7, {"session", "replay", folder()}), HasSubstr("E1614"));
}

TEST_F(SessionCommand, ErasesOnlyWhenTold) {
  EXPECT_EQ(run_kith({"session", "redact", folder()}).code, 2);
  EXPECT_EQ(run_kith({"session", "redact", folder(), "--yes"}).code, 0);
  EXPECT_EQ(run_kith({"session", "redact", folder(), "--seat", "1", "--yes"}).code, 2) << "of which room?";
  EXPECT_EQ(run_kith({"session", "redact", folder(), "--room", "r1", "--seat", "1"}).code, 2);
  EXPECT_EQ(run_kith({"session", "redact", folder(), "--dry-run"}).code, 2);
  EXPECT_THAT(run_kith({"session", "redact", folder(), "--room", "r1", "--seat", "9", "--yes"}).err,
              HasSubstr("E1624"));
  const auto lock = FolderLock::try_acquire(folder());
  EXPECT_THAT(err_of(8, {"session", "redact", folder(), "--yes"}), HasSubstr("E1610"));
}

TEST_F(SessionCommand, RecoversADamagedSession) {
  const auto path = std::filesystem::path{folder()} / kEventFile;
  {
    Database database{path, Database::Mode::kWrite};
    database.empty_log();
    auto page = database.prepare("SELECT rootpage FROM sqlite_schema WHERE name = 'sqlite_autoindex_event_1'");
    ASSERT_TRUE(page.step());
    std::fstream file{path, std::ios::in | std::ios::out | std::ios::binary};
    file.seekp((page.integer(0) - 1) * kSqlitePageSize);
    file << std::string(kSqlitePageSize, '\xA5');
  }
  EXPECT_THAT(err_of(7, {"session", "list", folder()}), HasSubstr("E1612"));
  EXPECT_EQ(run_kith({"session", "salvage", folder()}).code, 2);
  EXPECT_THAT(out_of({"session", "salvage", folder(), "-o", scratch_ / "saved"}), HasSubstr("2 events"));
  EXPECT_EQ(run_kith({"session", "replay", scratch_ / "saved"}).code, 0);
  std::ofstream{path} << "this is no database any more";
  const auto nothing = err_of(7, {"session", "salvage", folder(), "-o", scratch_ / "other"});
  EXPECT_THAT(nothing, AllOf(HasSubstr("E1619"), HasSubstr("sqlite3 session.sqlite .recover")));
}

TEST_F(SessionCommand, RefusesFoldersThatHoldNoSession) {
  for (const std::string action : {"list", "show", "export", "replay", "redact", "salvage"}) {
    const auto ran = run_kith({"session", action, scratch_ / "none", "--room", "r1", "-o", scratch_ / "x", "--yes"});
    EXPECT_EQ(ran.code, 3) << action << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("E1616")) << action;
  }
  EXPECT_EQ(run_kith({"session", "lst", folder()}).code, 2);
}

}  // namespace
}  // namespace kith::testing
