// Bits that flip in the files of a session: noticed, and what is intact is recovered.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "kith/files/sqlite.hpp"
#include "kith/store/session_review.hpp"
#include "store_support.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

using testing::batch_of;
using testing::event_of;
using testing::events_in;
using testing::flip_bit;
using testing::identity_of;
using testing::room_of;
using testing::ScratchFolder;

constexpr std::int64_t kDamagedRooms = 3;
constexpr std::uint64_t kEventsOfARoom = 14;

// A session with events in the file and in the write-ahead log, as a killed server leaves it.
void make_session(const fs::path& folder) {
  fs::create_directories(folder);
  const ScratchFolder scratch;
  auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
  for (std::int64_t room = 1; room <= kDamagedRooms; ++room) {
    const auto first = batch_of({}, {room_of(room)});
    file.write({&first, 1});
  }
  for (std::uint64_t seq = 1; seq <= kEventsOfARoom; ++seq) {
    for (std::int64_t room = 1; room <= kDamagedRooms; ++room) {
      const auto batch = batch_of({event_of(room, seq)});
      file.write({&batch, 1});
    }
    if (seq == kEventsOfARoom - 4) {
      Database checkpoint{file.path(), Database::Mode::kWrite};
      checkpoint.empty_log();
    }
  }
  for (const auto& name : {"session.sqlite", "session.sqlite-wal", "session.json"})
    fs::copy_file(scratch.path() / name, folder / name);
}

std::vector<StoredEvent> all_events() {
  std::vector<StoredEvent> events;
  for (std::int64_t room = 1; room <= kDamagedRooms; ++room) {
    for (std::uint64_t seq = 1; seq <= kEventsOfARoom; ++seq) events.push_back(event_of(room, seq));
  }
  return events;
}

// The events as kith reads them, or nothing if it says that the session is damaged.
std::optional<std::vector<StoredEvent>> read_or_refuse(const fs::path& folder, const std::string& story) {
  try {
    auto file = EventFile::read(folder);
    file.verify();
    return events_in(file);
  } catch (const Error& error) {
    const bool is_known = !error.diagnostics().empty() &&
                          (error.diagnostics().front().id == "E1612" || error.diagnostics().front().id == "E1613");
    EXPECT_TRUE(is_known) << story << ": " << error.what();
    return std::nullopt;
  }
}

// What a salvage recovers is as it was, of each room the beginning; or SQLite reads nothing any more, and that is said.
void check_salvage(const fs::path& folder, const fs::path& target, const std::string& story) {
  SalvageReport report;
  try {
    report = salvage_session(folder, target);
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().front().id, "E1619") << story << error.what();
    EXPECT_NE(error.diagnostics().front().hint.find(".recover"), std::string::npos) << story;
    return;
  }
  auto file = EventFile::read(target);
  ASSERT_NO_THROW(file.verify()) << story;
  std::map<std::int64_t, std::uint64_t> recovered;
  for (const auto& event : events_in(file)) {
    EXPECT_EQ(event, event_of(event.room, event.seq)) << story;
    ++recovered[event.room];
  }
  std::size_t incomplete = 0;
  for (std::int64_t room = 1; room <= kDamagedRooms; ++room) incomplete += recovered[room] < kEventsOfARoom ? 1u : 0u;
  EXPECT_LE(report.lost.size(), incomplete) << story;  // of a lost end nothing after it can tell
}

void flip_bits(std::size_t cases, unsigned seed) {
  const ScratchFolder scratch;
  make_session(scratch.path() / "whole");
  const auto events = all_events();
  ASSERT_EQ(read_or_refuse(scratch.path() / "whole", "whole"), events);
  std::mt19937 random{seed};
  std::size_t noticed = 0;
  for (std::size_t i = 0; i < cases; ++i) {
    const auto folder = scratch.path() / ("case-" + std::to_string(i));
    fs::copy(scratch.path() / "whole", folder);
    const auto* name = i % 2 == 0 ? "session.sqlite" : "session.sqlite-wal";
    const auto byte = random() % fs::file_size(folder / name);
    const auto bit = static_cast<unsigned>(random() % 8);
    flip_bit(folder / name, byte, bit);
    const auto story = std::string{name} + ", byte " + std::to_string(byte) + ", bit " + std::to_string(bit);
    const auto read = read_or_refuse(folder, story);
    if (read) {
      EXPECT_EQ(*read, events) << story << ": a wrong value was not noticed";
    } else {
      ++noticed;
      check_salvage(folder, folder / "salvaged", story);
    }
    fs::remove_all(folder);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(noticed, cases / 4);
}

// In parts, so that none takes long on a busy machine.
class FlippedBits : public ::testing::TestWithParam<unsigned> {};
TEST_P(FlippedBits, AreNoticedAndIntactEventsAreRecovered) { flip_bits(50, GetParam()); }
INSTANTIATE_TEST_SUITE_P(Seeds, FlippedBits, ::testing::Values(1u, 2u, 3u, 4u));

TEST(SlowDamagedSession, IsNoticedAndItsIntactEventsAreRecovered) { flip_bits(2000, 8); }

TEST(DamagedSession, IsNoticedIfAFileIsCutShort) {
  const ScratchFolder scratch;
  make_session(scratch.path() / "whole");
  const auto events = all_events();
  std::mt19937 random{9};
  for (std::size_t i = 0; i < 60; ++i) {
    const auto folder = scratch.path() / ("case-" + std::to_string(i));
    fs::copy(scratch.path() / "whole", folder);
    const auto size = fs::file_size(folder / kEventFile);
    fs::resize_file(folder / kEventFile, random() % size);
    const auto story = "cut to " + std::to_string(fs::file_size(folder / kEventFile));
    const auto read = read_or_refuse(folder, story);
    if (read) {
      EXPECT_EQ(*read, events) << story;
      continue;
    }
    check_salvage(folder, folder / "salvaged", story);
  }
}

TEST(DamagedSession, IsNoticedIfTheLogIsAnotherOne) {
  const ScratchFolder scratch;
  make_session(scratch.path() / "one");
  make_session(scratch.path() / "other");
  fs::copy_file(scratch.path() / "other" / "session.sqlite-wal", scratch.path() / "one" / "session.sqlite-wal",
                fs::copy_options::overwrite_existing);
  EXPECT_FALSE(read_or_refuse(scratch.path() / "one", "swapped").has_value());
}

// SQLite takes such a frame for one of an earlier log, where this one ends.
TEST(DamagedSession, IsNoticedIfTheSaltOfTheLastFrameIsWrong) {
  constexpr std::uintmax_t kHeader = 32, kFrame = 24 + 4096;
  const ScratchFolder scratch;
  make_session(scratch.path() / "whole");
  const auto size = fs::file_size(scratch.path() / "whole" / "session.sqlite-wal");
  ASSERT_EQ((size - kHeader) % kFrame, 0u);
  for (const std::uintmax_t byte : {8u, 11u, 12u, 15u}) {
    const auto folder = scratch.path() / ("case-" + std::to_string(byte));
    fs::copy(scratch.path() / "whole", folder);
    flip_bit(folder / "session.sqlite-wal", size - kFrame + byte, 6);
    EXPECT_FALSE(read_or_refuse(folder, "salt").has_value()) << byte;
    check_salvage(folder, folder / "salvaged", "salt");
  }
}

TEST(DamagedSession, IsRecoveredWithoutTheFileBesideItButNotWithoutItsIdentity) {
  const ScratchFolder scratch;
  const auto session = scratch.path() / "session";
  make_session(session);
  fs::remove(session / kIdentityFile);
  const auto report = salvage_session(session, scratch.path() / "salvaged");
  EXPECT_EQ(report.events, kDamagedRooms * kEventsOfARoom);
  EXPECT_EQ(report.rooms, static_cast<std::size_t>(kDamagedRooms));
  EXPECT_TRUE(report.lost.empty());
  std::ofstream{session / kEventFile, std::ios::trunc} << std::string(8192, 'x');
  fs::remove(session / "session.sqlite-wal");
  EXPECT_EQ(testing::id_of_error([&] { (void)salvage_session(session, scratch.path() / "other"); }), "E1619");
}

TEST(DamagedSession, IsNotRecoveredIntoAFolderThatHoldsSomething) {
  const ScratchFolder scratch;
  make_session(scratch.path() / "session");
  EXPECT_EQ(testing::id_of_error([&] { (void)salvage_session(scratch.path() / "session", scratch.path()); }), "E1620");
  EXPECT_EQ(testing::id_of_error([&] { (void)salvage_session(scratch.path() / "none", scratch.path() / "x"); }),
            "E1616");
}

// A page that holds no rows of the session.
TEST(DamagedSession, IsRecoveredWholeIfOnlyAnIndexIsDamaged) {
  const ScratchFolder scratch;
  const auto folder = scratch.path() / "session";
  make_session(folder);
  {
    Database checkpoint{folder / kEventFile, Database::Mode::kWrite};
    checkpoint.empty_log();
    auto page = checkpoint.prepare("SELECT rootpage FROM sqlite_schema WHERE name = 'message'");
    ASSERT_TRUE(page.step());
    std::fstream file{folder / kEventFile, std::ios::in | std::ios::out | std::ios::binary};
    file.seekp((page.integer(0) - 1) * kSqlitePageSize);
    file << std::string(kSqlitePageSize, '\xA5');
  }
  EXPECT_FALSE(read_or_refuse(folder, "index").has_value());
  const auto report = salvage_session(folder, scratch.path() / "salvaged");
  EXPECT_EQ(report.events, kDamagedRooms * kEventsOfARoom);
  EXPECT_TRUE(report.lost.empty());
}

}  // namespace
}  // namespace kith
