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
  const auto list = run_kith({"session", "list", folder()});
  EXPECT_EQ(list.code, 0) << list.err;
  // Of r1 one person has joined, of r2 nobody; nothing was taught.
  EXPECT_THAT(list.out, ContainsRegex("\nr1 +common +NP +1 +0 +0 +0 +2023"));
  EXPECT_THAT(list.out, ContainsRegex("\nr2 +common +NP +0 +0 +0 +0 +- "));
  const auto shown = run_kith({"session", "show", folder(), "--room", "AAAAAA"}).out;
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 2) << shown;
  const auto several = run_kith({"session", "show", folder()});
  EXPECT_EQ(several.code, 2);
  EXPECT_THAT(several.err, HasSubstr("has 2 rooms; say which one with --room ID"));
  const auto none = run_kith({"session", "show", folder(), "--room", "r9"});
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("E1618"));
}

TEST_F(SessionCommand, ShowsTheOnlyRoom) {
  make_session(scratch_ / "one", 1);
  const auto shown = run_kith({"session", "show", scratch_ / "one"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_EQ(shown.out, run_kith({"session", "show", scratch_ / "one", "--room", "r1"}).out);
  EXPECT_THAT(shown.out, HasSubstr("joined"));
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
  const auto ran = run_kith({"report", scratch_ / "tables", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document["overview"]["teams"], 0) << "nobody was taught yet";
  EXPECT_EQ(document["domain"], "item-delivery");
  EXPECT_EQ(run_kith({"report", scratch_ / "tables"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "tables/report.html"));
  const auto early = run_kith({"report", folder()});
  EXPECT_EQ(early.code, 3);
  EXPECT_THAT(early.err, HasSubstr("kith session export"));
}

TEST_F(SessionCommand, ReplaysAndSaysWhatDiffers) {
  const auto ran = run_kith({"session", "replay", folder()});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("all identical"));
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
  const auto wrong = run_kith({"session", "replay", folder()});
  EXPECT_EQ(wrong.code, 7);
  EXPECT_THAT(wrong.err, HasSubstr("E1614"));
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
  const auto busy = run_kith({"session", "redact", folder(), "--yes"});
  EXPECT_EQ(busy.code, 8);
  EXPECT_THAT(busy.err, HasSubstr("E1610"));
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
  const auto list = run_kith({"session", "list", folder()});
  EXPECT_EQ(list.code, 7);
  EXPECT_THAT(list.err, HasSubstr("E1612"));
  EXPECT_EQ(run_kith({"session", "salvage", folder()}).code, 2);
  const auto ran = run_kith({"session", "salvage", folder(), "-o", scratch_ / "saved"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("2 events"));
  EXPECT_EQ(run_kith({"session", "replay", scratch_ / "saved"}).code, 0);
  std::ofstream{path} << "this is no database any more";
  const auto nothing = run_kith({"session", "salvage", folder(), "-o", scratch_ / "other"});
  EXPECT_EQ(nothing.code, 7);
  EXPECT_THAT(nothing.err, AllOf(HasSubstr("E1619"), HasSubstr("sqlite3 session.sqlite .recover")));
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
