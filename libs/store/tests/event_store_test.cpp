#include "kith/store/event_store.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <set>
#include <thread>

#include "faulty_disk.hpp"
#include "store_support.hpp"

namespace kith {
namespace {

using testing::batch_of;
using testing::event_of;
using testing::events_in;
using testing::FaultyDisk;
using testing::id_of_error;
using testing::identity_of;
using testing::room_of;
using testing::ScratchFolder;

std::int64_t no_time() { return 1'700'000'000'000'000; }

TEST(EventStore, SavesWhatManyThreadsHandIn) {
  constexpr std::int64_t kRooms = 8;
  constexpr std::uint64_t kEvents = 40;
  const ScratchFolder scratch;
  std::atomic<std::size_t> saved = 0;
  {
    EventStore store{scratch.path(), identity_of(), no_time};
    std::vector<std::thread> threads;
    for (std::int64_t room = 1; room <= kRooms; ++room) {
      threads.emplace_back([&, room] {
        store.write(batch_of({}, {room_of(room)}), [&](bool ok) { saved += ok ? 1u : 0u; });
        for (std::uint64_t seq = 1; seq <= kEvents; ++seq)
          store.write(batch_of({event_of(room, seq)}), [&](bool ok) { saved += ok ? 1u : 0u; });
      });
    }
    for (auto& thread : threads) thread.join();
    store.flush();
    const auto counters = store.counters();
    EXPECT_EQ(counters.events, kRooms * kEvents);
    EXPECT_EQ(counters.waiting, 0u);
    EXPECT_LE(counters.commits, kRooms * (kEvents + 1));
  }
  EXPECT_EQ(saved, kRooms * (kEvents + 1));
  auto file = EventFile::read(scratch.path());
  EXPECT_NO_THROW(file.verify());
  EXPECT_EQ(file.count_events(), kRooms * kEvents);
}

TEST(EventStore, RefusesAFolderThatIsBeingServed) {
  const ScratchFolder scratch;
  EventStore store{scratch.path(), identity_of(), no_time};
  EXPECT_EQ(id_of_error([&] { EventStore other{scratch.path(), identity_of(), no_time}; }), "E1610");
  auto saved = std::make_shared<bool>(false);
  store.write(batch_of({event_of(1, 1)}, {room_of(1)}), [saved](bool ok) { *saved = ok; });
  store.flush();
  EXPECT_TRUE(*saved) << "the first is not affected";
  EXPECT_EQ(saved.use_count(), 1) << "what waits for a batch is let go before flush() returns";
}

TEST(EventStore, DoesNotLetOneWrongBatchTakeOthersWithIt) {
  const ScratchFolder scratch;
  EventStore store{scratch.path(), identity_of(), no_time};
  std::atomic<int> right = 0, wrong = 0;
  store.write(batch_of({event_of(1, 1)}, {room_of(1)}), [&](bool ok) { right += ok ? 1 : 0; });
  store.write(batch_of({event_of(7, 1)}), [&](bool ok) { wrong += ok ? 0 : 1; });  // there is no such room
  store.write(batch_of({event_of(1, 2)}), [&](bool ok) { right += ok ? 1 : 0; });
  store.flush();
  EXPECT_EQ(right, 2);
  EXPECT_EQ(wrong, 1);
  EXPECT_EQ(store.counters().events, 2u);
}

// What a store was asked to save, what it said it saved, and what is then in the file.
struct Attempt {
  std::set<std::pair<std::int64_t, std::uint64_t>> acknowledged;
  bool opened = false;
};

// Two rooms whose events are handed in one after the other while the disk fails; what is refused is handed in again
// once, as the service does. The failures begin with the n-th operation, that of making the file included.
Attempt write_to_failing_disk(const std::filesystem::path& folder, std::size_t n, std::size_t times,
                              FaultyDisk::Fault fault) {
  constexpr std::uint64_t kEvents = 10;
  Attempt outcome;
  FaultyDisk::fail(n, times, fault);
  try {
    EventStore store{folder, identity_of(), no_time};
    outcome.opened = true;
    std::mutex mutex;
    const auto save = [&](const StoreBatch& batch) {
      bool result = false;
      store.write(batch, [&](bool saved) {
        const std::lock_guard lock{mutex};
        result = saved;
        if (!saved) return;
        for (const auto& event : batch.events) outcome.acknowledged.insert({event.room, event.seq});
      });
      store.flush();
      return result;
    };
    for (const std::int64_t room : {1, 2}) {
      const auto first = batch_of({}, {room_of(room)});
      if (!save(first) && !save(first)) continue;
      for (std::uint64_t seq = 1; seq <= kEvents; seq += 2) {
        const auto batch = batch_of({event_of(room, seq), event_of(room, seq + 1)});
        if (!save(batch) && !save(batch)) break;
      }
    }
  } catch (const Error&) {  // it could not be opened
  }
  FaultyDisk::heal();
  return outcome;
}

// After the disk has healed, the file opens, holds what was acknowledged, and nothing that was not handed in.
void check_after(const std::filesystem::path& folder, const Attempt& outcome, const std::string& story) {
  EventStore store{folder, identity_of(), no_time};
  ASSERT_NO_THROW(store.file().verify()) << story;
  std::set<std::pair<std::int64_t, std::uint64_t>> stored;
  for (const auto& event : events_in(store.file())) {
    EXPECT_EQ(event, event_of(event.room, event.seq)) << story;
    EXPECT_TRUE(stored.insert({event.room, event.seq}).second) << story;
  }
  for (const auto& place : outcome.acknowledged)
    EXPECT_EQ(stored.count(place), 1u) << story << ": event " << place.second << " of room " << place.first;
  for (const auto& [room, seq] : stored)
    EXPECT_EQ(stored.count({room, seq % 2 == 1 ? seq + 1 : seq - 1}), 1u) << story << ": half of a batch";
}

// How many operations the same takes on a disk that does not fail.
std::size_t num_operations() {
  const ScratchFolder scratch;
  const auto before = FaultyDisk::count();
  const auto outcome = write_to_failing_disk(scratch.path() / "session", 0, 0, FaultyDisk::Fault::kFull);
  EXPECT_EQ(outcome.acknowledged.size(), 20u);
  return FaultyDisk::count() - before;
}

// Case number i, from 0, begins to fail at operation 1 + i / 2.
// @return whether an operation failed.
bool fail_in_case(std::size_t i) {
  const auto n = 1 + i / 2;
  const std::size_t times = i % 2 == 0 ? 1 : 3;
  const auto fault = i % 3 == 0   ? FaultyDisk::Fault::kInputOutput
                     : i % 3 == 1 ? FaultyDisk::Fault::kFull
                                  : FaultyDisk::Fault::kShortWrite;
  const auto story =
      "operation " + std::to_string(n) + ", " + std::to_string(times) + " failures, kind " + std::to_string(i % 3);
  const ScratchFolder scratch;
  const auto before = FaultyDisk::num_failed();
  const auto outcome = write_to_failing_disk(scratch.path() / "session", n, times, fault);
  const bool has_failed = FaultyDisk::num_failed() > before;
  check_after(scratch.path() / "session", outcome, story);
  return has_failed;
}

// Until the operation that fails, a run is like any other: every failure up to the last operation of an undisturbed run
// must hit one.
void fail_in_cases(std::size_t first, std::size_t end, std::size_t operations) {
  for (std::size_t i = first; i < end; ++i) {
    EXPECT_EQ(fail_in_case(i), 1 + i / 2 <= operations) << "case " << i << " of " << operations << " operations";
    if (::testing::Test::HasFatalFailure()) return;
  }
}

class FailingDisk : public ::testing::TestWithParam<std::size_t> {};
TEST_P(FailingDisk, NeverHasWhatWasNotSavedAcknowledged) {
  const FaultyDisk disk;
  fail_in_cases(GetParam(), GetParam() + 50, num_operations());
}
INSTANTIATE_TEST_SUITE_P(Cases, FailingDisk, ::testing::Values(0u, 50u, 100u, 150u));

// From there to the last operation, and a few beyond it.
TEST(SlowFailingDisk, NeverHasWhatWasNotSavedAcknowledged) {
  const FaultyDisk disk;
  const auto operations = num_operations();
  ASSERT_GT(operations, 100u) << "nothing is left to fail";
  fail_in_cases(200, 2 * operations + 10, operations);
}

}  // namespace
}  // namespace kith
