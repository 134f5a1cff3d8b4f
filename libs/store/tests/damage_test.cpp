// Bits that flip in the files of a session are noticed.
#include <gtest/gtest.h>

#include <random>

#include "kith/files/sqlite.hpp"
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
  for (const auto& name : {"session.sqlite", "session.sqlite-wal"}) fs::copy_file(scratch.path() / name, folder / name);
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
    }
    fs::remove_all(folder);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(noticed, cases / 4);
}

// In parts, so that none takes long on a busy machine.
class FlippedBits : public ::testing::TestWithParam<unsigned> {};
TEST_P(FlippedBits, AreNoticed) { flip_bits(50, GetParam()); }
INSTANTIATE_TEST_SUITE_P(Seeds, FlippedBits, ::testing::Values(1u, 2u, 3u, 4u));

TEST(SlowDamagedSession, IsNoticed) { flip_bits(2000, 8); }

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
    EXPECT_EQ(read.value_or(events), events) << story;
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
  }
}

}  // namespace
}  // namespace kith
