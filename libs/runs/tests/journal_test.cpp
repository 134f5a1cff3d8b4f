#include "kith/runs/journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/sqlite.hpp"
#include "kith/runs/team_codec.hpp"
#include "run_support.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ScratchFolder;

namespace fs = std::filesystem;

constexpr std::size_t kMostOfForty = 25;   // in all pages of records but one
constexpr std::size_t kRootOfRecords = 4;  // the page that leads to them

JournalIdentity identity(std::size_t teams = 100) { return {{"study", "domain"}, "kith 1", teams, {}}; }

// Of other work on the same teams.
JournalIdentity other_identity() { return {{"another study", "domain"}, "kith 1", 100, {}}; }

JournalEntry entry(std::size_t team, const JournalIdentity& whose = identity()) {
  TeamRecord record;
  record.address.team = team;
  record.seed_address = std::string(200, 'x');
  record.knowledge = 1.0 / static_cast<double>(team);
  return {team, encode_team(record, whose.key())};
}

std::vector<JournalEntry> entries(std::size_t from, std::size_t to, const JournalIdentity& whose = identity()) {
  std::vector<JournalEntry> result;
  for (auto team = from; team <= to; ++team) result.push_back(entry(team, whose));
  return result;
}

void execute(const fs::path& file, const std::string& sql) {
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &handle), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(handle);
  sqlite3_close(handle);
}

std::string message_of(const std::function<void()>& action, ErrorKind kind = ErrorKind::kIo) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

// Runs it where no file can become longer: what a full disk is like.
std::string with_file_limit(rlim_t bytes, const std::function<std::string()>& action) {
  struct sigaction before = {}, ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &ignore, &before);
  rlimit unlimited = {};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  rlimit small = unlimited;
  small.rlim_cur = bytes;
  setrlimit(RLIMIT_FSIZE, &small);
  auto result = action();
  setrlimit(RLIMIT_FSIZE, &unlimited);
  sigaction(SIGXFSZ, &before, nullptr);
  return result;
}

class JournalTest : public ::testing::Test {
 protected:
  [[nodiscard]] Journal opened(const JournalIdentity& whose = identity()) const {
    auto journal = Journal::open(file_, whose);
    if (!journal) throw std::runtime_error{"nothing can be read"};
    return *std::move(journal);
  }
  [[nodiscard]] std::string bytes() const { return read_file(file_); }
  void put(const std::string& bytes) const {
    Journal::remove(file_);
    std::ofstream{file_, std::ios::binary} << bytes;
  }
  // Its bytes with a page overwritten that holds no records: the last table that was made begins there.
  [[nodiscard]] std::string damaged_elsewhere() const {
    constexpr std::size_t kBatches = 7;
    return bytes().replace((kBatches - 1) * kSqlitePageSize, kSqlitePageSize, kSqlitePageSize, '\xA5');
  }
  // A journal of 40 teams, closed.
  void write_forty() const {
    auto journal = Journal::create(file_, identity(40));
    journal.write(entries(1, 40, identity(40)));
    journal.close();
  }

  ScratchFolder scratch_;
  fs::path file_ = scratch_.path() / "study.sqlite";
};

TEST_F(JournalTest, HoldsWhatWasWrittenWhoeverLooks) {
  auto journal = Journal::create(file_, identity());
  journal.write(entries(3, 5));
  journal.write(entries(1, 1), std::vector<TeamFailure>{{7, "why"}});
  EXPECT_EQ(journal.num_done(), 4u);
  const auto reader = Journal::read(file_);  // while the writer has it open
  EXPECT_EQ(reader.identity(), identity());
  EXPECT_EQ(reader.find(4), entry(4).bytes);
  EXPECT_EQ(reader.find(2), std::nullopt);
  std::vector<std::size_t> teams;
  reader.for_each([&](std::size_t team, std::string_view bytes) {
    teams.push_back(team);
    EXPECT_EQ(bytes, entry(team).bytes);
  });
  EXPECT_THAT(teams, ElementsAre(1, 3, 4, 5));
  EXPECT_THAT(reader.progress().failures, ElementsAre(TeamFailure{7, "why"}));
}

// Halfway through, its first page names pages that are not there yet.
TEST_F(JournalTest, CanBeReadWhileItsLogIsPutIntoTheFile) {
  const auto lock = FolderLock::try_acquire(scratch_.path());
  std::string log;
  std::uintmax_t size = 0;
  {
    auto journal = Journal::create(file_, identity());
    journal.write(entries(1, 100));
    log = read_file(fs::path{file_}.concat("-wal"));
    size = fs::file_size(file_);
  }
  fs::resize_file(file_, size);
  std::ofstream{fs::path{file_}.concat("-wal"), std::ios::binary} << log;
  EXPECT_EQ(Journal::identify(file_), std::nullopt);  // from the file alone
  EXPECT_EQ(Journal::read(file_).find(100), entry(100).bytes);
}

TEST_F(JournalTest, KnowsAfterwardsWhatIsDone) {
  {
    auto journal = Journal::create(file_, identity());
    journal.write(entries(10, 20), std::vector<TeamFailure>{{30, "why"}});
    journal.write(entries(30, 30));
  }
  const auto again = opened();
  EXPECT_EQ(again.num_done(), 12u);
  EXPECT_FALSE(again.done()[8]);
  EXPECT_TRUE(again.done()[9]);
  EXPECT_TRUE(again.progress().failures.empty());  // it was taught after all
  EXPECT_THAT(again.damaged(), IsEmpty());
  EXPECT_FALSE(again.was_recovered());
}

TEST_F(JournalTest, CanBeClosedWithoutAnythingDone) {
  for (int times = 0; times < 3; ++times) {
    auto journal = times == 0 ? Journal::create(file_, identity()) : opened();
    EXPECT_NO_THROW(journal.close());
  }
}

TEST_F(JournalTest, CountsTheTeamsOfAShard) {
  auto shard = identity(10);
  shard.shard = {2, 3};
  auto journal = Journal::create(file_, shard);  // teams 2, 5, 8
  EXPECT_EQ(journal.progress().total, 3u);
  shard.shard = {1, 3};
  EXPECT_EQ(Journal::create(file_, shard).progress().total, 4u);
}

TEST_F(JournalTest, IsOneFileOnceClosedThatCanBeReadWhereNothingCanBeWritten) {
  {
    auto journal = Journal::create(file_, identity());
    journal.write(entries(1, 50));
    journal.close();
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& one : fs::directory_iterator{scratch_.path()}) ++files;
  EXPECT_EQ(files, 1u);
  fs::permissions(scratch_.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(Journal::read(file_).find(50), entry(50).bytes);
  fs::permissions(scratch_.path(), fs::perms::owner_all);
}

TEST_F(JournalTest, NamesADamagedRecordAndKeepsTheOthers) {
  {
    auto journal = Journal::create(file_, identity());
    journal.write(entries(1, 9));
    journal.close();
  }
  auto bytes = entry(4).bytes;
  bytes.at(20) = static_cast<char>(bytes.at(20) ^ 1);
  std::string hex;
  for (const char c : bytes) {
    constexpr const char* kHex = "0123456789abcdef";
    hex += kHex[static_cast<unsigned char>(c) >> 4];
    hex += kHex[static_cast<unsigned char>(c) & 15u];
  }
  execute(file_, "UPDATE units SET record = x'" + hex + "' WHERE team = 4");
  execute(file_, "UPDATE units SET team = 40 WHERE team = 7");  // an intact record of somebody else
  const auto again = opened();
  EXPECT_THAT(again.damaged(), ElementsAre(4, 40));
  EXPECT_EQ(again.num_done(), 7u);
  EXPECT_THAT(message_of([&] { again.for_each([](std::size_t, std::string_view) {}); }), HasSubstr("team 4 "));
}

TEST_F(JournalTest, RecoversWhatIsIntactFromADamagedFile) {
  {
    auto journal = Journal::create(file_, identity(2000));
    journal.write(entries(1, 2000));
    journal.close();
  }
  // A page in the middle is overwritten: it held some teams, all others are in other pages.
  {
    std::fstream file{file_, std::ios::in | std::ios::out | std::ios::binary};
    file.seekp(4096 * 60);
    file << std::string(4096, '\xA5');
  }
  const auto again = opened(identity(2000));
  EXPECT_TRUE(again.was_recovered());
  EXPECT_GT(again.num_done(), 1900u);
  EXPECT_LT(again.num_done(), 2000u);
  again.for_each([](std::size_t team, std::string_view bytes) { EXPECT_EQ(bytes, entry(team).bytes); });
  EXPECT_TRUE(fs::exists(file_.string() + ".damaged"));
  EXPECT_FALSE(opened(identity(2000)).was_recovered());
}

// One bit after the other is flipped, all over the file: whatever can still be read is right, and most of it can be.
// Where SQLite reads nothing any more, because of its header or the list of its tables, the file stays as it is.
TEST_F(JournalTest, NeverHandsOutAWrongRecordAndLosesAPageAtMostIfABitFlips) {
  write_forty();
  const auto good = bytes();
  std::size_t refused = 0;
  for (std::size_t at = 3; at < good.size(); at += good.size() / 197) {
    auto bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << (at % 8)));
    put(bad);
    const auto journal = Journal::open(file_, identity(40));
    if (!journal) {
      ++refused;
      EXPECT_EQ(bytes(), bad) << at;
      EXPECT_LT(at, std::size_t{kSqlitePageSize}) << "only what stands in the first page can hide all others";
      continue;
    }
    const auto page = at / kSqlitePageSize + 1;
    if (page != 1 && page != kRootOfRecords) {
      EXPECT_GE(journal->num_done(), kMostOfForty) << at;
    }
    for (std::size_t team = 1; team <= 40; ++team) {
      if (journal->done()[team - 1]) {
        EXPECT_EQ(journal->find(team), entry(team).bytes);
      }
    }
  }
  EXPECT_LE(refused, 20U);
}

TEST_F(JournalTest, KeepsTheRecordsInTheWholePagesOfATruncatedFile) {
  write_forty();
  const auto good = bytes();
  for (const std::size_t length : {good.size() - 1, good.size() - 4096, good.size() - 5000}) {
    put(good.substr(0, length));
    const auto journal = opened(identity(40));
    EXPECT_GE(journal.num_done(), length + 4096 < good.size() ? 10U : kMostOfForty) << length;
    for (std::size_t team = 1; team <= 40; ++team) {
      if (journal.done()[team - 1]) {
        EXPECT_EQ(journal.find(team), entry(team).bytes);
      }
    }
  }
}

TEST_F(JournalTest, IsLeftAsItIsWithoutItsHeader) {
  write_forty();
  auto bad = bytes();
  bad.replace(0, 100, 100, '\xA5');
  put(bad);
  EXPECT_FALSE(Journal::open(file_, identity(40)));
  EXPECT_EQ(bytes(), bad);
}

TEST_F(JournalTest, IsRecoveredWithRecordsOfManyPages) {
  TeamRecord record;
  record.address.team = 7;
  record.seed_address = std::string(50'000, 'y');
  const JournalEntry large{7, encode_team(record, identity().key())};
  {
    auto journal = Journal::create(file_, identity());
    journal.write({&large, 1});
    journal.write(entries(1, 6));
    journal.close();
  }
  put(damaged_elsewhere());
  const auto journal = opened();
  EXPECT_TRUE(journal.was_recovered());
  EXPECT_EQ(journal.num_done(), 7u);
  EXPECT_EQ(journal.find(7), large.bytes);
}

// A salvage that is ended between any two of its steps goes on the next time.
TEST_F(JournalTest, LosesNothingIfASalvageIsInterrupted) {
  write_forty();
  const auto damaged = damaged_elsewhere();
  put(damaged);
  (void)opened(identity(40));
  const auto fresh = bytes();
  const auto old = fs::path{file_.string() + ".damaged"};
  for (const bool moved_away : {false, true}) {
    fs::rename(file_, file_.string() + ".salvaged");
    if (!moved_away) std::ofstream{file_, std::ios::binary} << damaged;
    EXPECT_TRUE(Journal::exists(file_));
    EXPECT_EQ(Journal::read(file_).find(40), entry(40).bytes);
    EXPECT_EQ(opened(identity(40)).num_done(), 40u);
    EXPECT_EQ(bytes(), fresh);
    EXPECT_EQ(read_file(old), damaged);
    EXPECT_FALSE(fs::exists(file_.string() + ".salvaged"));
  }
}

// Records of other work pass every test of SQLite, and must not pass ours.
TEST_F(JournalTest, DoesNotTakeTheLogOfAnotherJournalForItsOwn) {
  const auto other = scratch_.path() / "other.sqlite";
  auto foreign = Journal::create(other, other_identity());
  foreign.write(entries(1, 70, other_identity()));
  {
    auto journal = Journal::create(file_, identity());
    journal.write(entries(1, 20));
    journal.close();
  }
  fs::copy_file(other.string() + "-wal", file_.string() + "-wal");
  EXPECT_EQ(Journal::identify(file_), identity());
  const auto again = opened();
  EXPECT_EQ(again.num_done(), 20u);
  again.for_each([](std::size_t team, std::string_view bytes) { EXPECT_EQ(bytes, entry(team).bytes); });
}

TEST_F(JournalTest, KeepsTheRecordsOfItsFileBesideAnOlderLog) {
  const auto log = file_.string() + "-wal", older = (scratch_.path() / "older").string();
  {
    auto journal = Journal::create(file_, identity());
    journal.write(entries(1, 3));
    fs::copy_file(log, older);
    journal.write(entries(4, 9));
    journal.close();
  }
  fs::copy_file(older, log, fs::copy_options::overwrite_existing);
  const auto again = opened();
  EXPECT_TRUE(again.was_recovered());
  EXPECT_EQ(again.num_done(), 9u);
}

TEST_F(JournalTest, StartsFromItsOwnFileIfTheLogOfAnotherHasReplacedAllOfIts) {
  const auto other = scratch_.path() / "other.sqlite";
  auto foreign = Journal::create(other, other_identity());
  foreign.write(entries(1, 70, other_identity()));
  (void)Journal::create(file_, identity());
  fs::copy_file(other.string() + "-wal", file_.string() + "-wal");
  const auto again = opened();
  EXPECT_TRUE(again.was_recovered());
  EXPECT_EQ(again.num_done(), 0u);
}

TEST_F(JournalTest, LeavesNothingBehindIfTheDiskIsFullWhileItIsMade) {
  const auto message =
      with_file_limit(20'000, [&] { return message_of([&] { (void)Journal::create(file_, identity()); }); });
  EXPECT_THAT(message, HasSubstr(file_.string()));
  EXPECT_TRUE(fs::is_empty(scratch_.path()));
}

TEST_F(JournalTest, LosesNothingIfTheDiskIsFullDuringASalvage) {
  write_forty();
  const auto damaged = damaged_elsewhere();
  put(damaged);
  (void)with_file_limit(30'000, [&] { return message_of([&] { (void)opened(identity(40)); }); });
  EXPECT_EQ(bytes(), damaged);
  EXPECT_EQ(opened(identity(40)).num_done(), 40u);
}

TEST_F(JournalTest, RefusesTheWorkOfOthers) {
  (void)Journal::create(file_, other_identity());
  EXPECT_THAT(message_of([&] { (void)opened(); }, ErrorKind::kUsage), HasSubstr("another study"));
}

TEST_F(JournalTest, RefusesNumbersThatCannotBe) {
  for (const auto* change :
       {"UPDATE meta SET value = '0' WHERE key = 'shards'", "UPDATE meta SET value = '0' WHERE key = 'shard'",
        "UPDATE meta SET value = '4000000000' WHERE key = 'teams'",
        "UPDATE meta SET value = '18446744073709551617' WHERE key = 'teams'"}) {
    (void)Journal::create(file_, identity());
    execute(file_, change);
    EXPECT_EQ(Journal::identify(file_), std::nullopt) << change;
    EXPECT_THAT(message_of([&] { (void)Journal::read(file_); }), HasSubstr("error[E0643]: the journal is damaged"))
        << change;
  }
}

TEST_F(JournalTest, IsNothingIfNoRecordCanBeRead) {
  for (const auto& content :
       {"this is no database, and long enough to look like one: " + std::string(5000, '-'), std::string{}}) {
    put(content);
    EXPECT_FALSE(Journal::open(file_, identity()));
    EXPECT_EQ(bytes(), content);  // it is left as it is
    EXPECT_EQ(Journal::identify(file_), std::nullopt);
  }
}

TEST_F(JournalTest, IsOfAnotherVersionOnlyIfMoreThanItsSchemaIsDifferent) {
  write_forty();
  execute(file_, "UPDATE meta SET value = 'kith.journal/4' WHERE key = 'schema'");  // a flipped bit
  EXPECT_EQ(opened(identity(40)).num_done(), 40u);
  write_forty();
  execute(file_, "UPDATE meta SET value = 'kith.jour' WHERE key = 'schema'");
  EXPECT_EQ(opened(identity(40)).num_done(), 40u);
  (void)Journal::create(file_, identity());
  execute(file_, "UPDATE meta SET value = 'kith.journal/1' WHERE key = 'schema'; DELETE FROM meta WHERE key = 'run'");
  EXPECT_THAT(message_of([&] { (void)opened(); }, ErrorKind::kUsage), HasSubstr("kith.journal/1"));
}

TEST_F(JournalTest, IsNotWaitedForIfItIsNoRegularFile) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_TRUE(Journal::exists(file_));
  EXPECT_THAT(message_of([&] { (void)Journal::read(file_); }), HasSubstr("not a regular file"));
  EXPECT_THAT(message_of([&] { (void)opened(); }), HasSubstr("not a regular file"));
  EXPECT_EQ(Journal::create(file_, identity()).num_done(), 0u);
}

TEST_F(JournalTest, DoesNotCountAFailureThatWasChanged) {
  auto journal = Journal::create(file_, identity());
  journal.write({}, std::vector<TeamFailure>{{7, "why"}, {8, "why not"}});
  execute(file_, "UPDATE failures SET team = 9 WHERE team = 8");
  EXPECT_THAT(journal.progress().failures, ElementsAre(TeamFailure{7, "why"}));
}

TEST_F(JournalTest, TakesUpWhatAnotherHoldsOnce) {
  auto journal = Journal::create(file_, identity());
  journal.write(entries(1, 10));
  auto other = Journal::create(scratch_.path() / "other.sqlite", identity());
  other.write(entries(5, 20), std::vector<TeamFailure>{{50, "why"}});
  journal.absorb(other);
  journal.absorb(other);
  EXPECT_EQ(journal.num_done(), 20u);
  EXPECT_THAT(opened().progress().failures, ElementsAre(TeamFailure{50, "why"}));
}

TEST_F(JournalTest, KeepsWhatItHasWhenTheDiskIsFull) {
  auto journal = Journal::create(file_, identity(10'000));
  journal.write(entries(1, 100));
  const auto message = with_file_limit(300'000, [&] { return message_of([&] { journal.write(entries(101, 5000)); }); });
  EXPECT_THAT(message, HasSubstr(file_.string()));
  EXPECT_EQ(journal.num_done(), 100u);
  journal.write(entries(101, 200));  // space again
  EXPECT_EQ(opened(identity(10'000)).num_done(), 200u);
}

}  // namespace
}  // namespace kith
