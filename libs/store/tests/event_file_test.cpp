#include "kith/store/event_file.hpp"

#include <gtest/gtest.h>

#include "kith/files/atomic_file.hpp"
#include "kith/files/sqlite.hpp"
#include "store_support.hpp"

namespace kith {
namespace {

using testing::batch_of;
using testing::event_of;
using testing::events_in;
using testing::id_of_error;
using testing::identity_of;
using testing::room_of;
using testing::ScratchFolder;

void write_one(EventFile& file, const StoreBatch& batch) { file.write({&batch, 1}); }

TEST(EventFile, GivesBackWhatWasWritten) {
  const ScratchFolder scratch;
  StoreBatch batch = batch_of({event_of(1, 1), event_of(1, 2), event_of(2, 1)}, {room_of(1), room_of(2)});
  batch.tokens.push_back({.hash = std::string(32, 'h'), .role = "participant", .room = 1, .seat = 2, .expires_us = 77});
  std::string id;
  {
    auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
    write_one(file, batch);
    id = file.id();
  }
  auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime + 1);
  EXPECT_EQ(file.id(), id);
  EXPECT_EQ(file.created_us(), testing::kSomeTime);
  EXPECT_EQ(file.identity().inputs, identity_of().inputs);
  EXPECT_EQ(file.rooms(), batch.rooms);
  EXPECT_EQ(file.tokens(), batch.tokens);
  EXPECT_EQ(events_in(file), batch.events);
  EXPECT_EQ(file.count_events(), 3u);
  EXPECT_EQ(file.count_events(2), 1u);
  EXPECT_NO_THROW(file.verify());
}

TEST(EventFile, IsReadWhileAnotherProcessWrites) {
  const ScratchFolder scratch;
  auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
  write_one(file, batch_of({event_of(1, 1)}, {room_of(1)}));
  auto reader = EventFile::read(scratch.path());
  write_one(file, batch_of({event_of(1, 2)}));
  EXPECT_EQ(events_in(reader).size(), 1u) << "all that is read is of one instant";
  auto later = EventFile::read(scratch.path());
  EXPECT_EQ(events_in(later).size(), 2u);
}

TEST(EventFile, SavesABatchAsAWholeOrNotAtAll) {
  const ScratchFolder scratch;
  auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
  write_one(file, batch_of({event_of(1, 1), event_of(1, 2)}, {room_of(1)}));
  EXPECT_THROW(write_one(file, batch_of({event_of(1, 3), event_of(1, 2)})), Error) << "a number that is taken";
  EXPECT_THROW(write_one(file, batch_of({event_of(1, 3), event_of(9, 1)})), Error) << "a room that is unknown";
  auto again = event_of(1, 3);
  again.actor = event_of(1, 2).actor;
  again.message = event_of(1, 2).message;
  EXPECT_THROW(write_one(file, batch_of({again})), Error) << "a message that was saved before";
  EXPECT_EQ(events_in(file).size(), 2u);
}

TEST(EventFile, RevokesLinks) {
  const ScratchFolder scratch;
  auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
  StoreBatch batch;
  batch.tokens.push_back({.hash = std::string(32, 'a'), .role = "observer", .expires_us = 5});
  batch.tokens.push_back({.hash = std::string(32, 'b'), .role = "facilitator", .expires_us = 5});
  write_one(file, batch);
  StoreBatch revoking;
  revoking.revoked.push_back(std::string(32, 'a'));
  write_one(file, revoking);
  EXPECT_TRUE(file.tokens()[0].revoked);
  EXPECT_FALSE(file.tokens()[1].revoked);
  EXPECT_NO_THROW(file.verify());
}

TEST(EventFile, RefusesWhatItIsNotMeantFor) {
  const ScratchFolder scratch;
  EXPECT_EQ(id_of_error([&] { (void)EventFile::read(scratch.path()); }), "E1616");
  { (void)EventFile::open(scratch.path(), identity_of(), testing::kSomeTime); }
  EXPECT_EQ(id_of_error([&] { (void)EventFile::open(scratch.path(), identity_of("other"), testing::kSomeTime); }),
            "E1611");
  Database{scratch.path() / kEventFile, Database::Mode::kWrite}.execute("PRAGMA user_version = 9");
  EXPECT_EQ(id_of_error([&] { (void)EventFile::open(scratch.path(), identity_of(), testing::kSomeTime); }), "E1613");
  EXPECT_EQ(id_of_error([&] { (void)EventFile::read(scratch.path()); }), "E1613");
}

TEST(EventFile, FindsRowsThatWereMovedOrAreMissing) {
  for (const auto* change : {"UPDATE event SET room = 2, seq = 2 WHERE room = 1 AND seq = 3",
                             "DELETE FROM event WHERE room = 1 AND seq = 2"}) {
    const ScratchFolder scratch;
    {
      auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
      write_one(file,
                batch_of({event_of(1, 1), event_of(1, 2), event_of(1, 3), event_of(2, 1)}, {room_of(1), room_of(2)}));
    }
    Database{scratch.path() / kEventFile, Database::Mode::kWrite}.execute(change);
    auto file = EventFile::read(scratch.path());
    EXPECT_EQ(id_of_error([&] { file.verify(); }), "E1612") << change;
  }
}

TEST(EventFile, LeavesNothingOfARewrittenTextBehind) {
  const ScratchFolder scratch;
  auto secret = event_of(1, 1);
  secret.json = "{\"name\":\"Wilhelmina Quackenbush\"}";
  {
    auto file = EventFile::open(scratch.path(), identity_of(), testing::kSomeTime);
    write_one(file, batch_of({secret, event_of(1, 2)}, {room_of(1)}));
    auto blank = secret;
    blank.json = "{\"name\":\"(erased)\"}";
    file.rewrite({&blank, 1});
    EXPECT_EQ(events_in(file).front(), blank);
  }
  for (const auto& entry : std::filesystem::directory_iterator{scratch.path()})
    EXPECT_EQ(read_file(entry.path()).find("Quackenbush"), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace kith
