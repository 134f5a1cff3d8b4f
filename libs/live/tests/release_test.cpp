// What a room holds when its group is not taught any more, and that nobody can tell the difference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "live_play.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they bring their own
#define KITH_COUNTS_BYTES 1

namespace {
std::atomic<std::ptrdiff_t> num_bytes{0};  // on the heap
}  // namespace

// Inlined without its partner, the compiler takes one of them for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc{};
  num_bytes += static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  if (memory != nullptr) num_bytes -= static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { ::operator delete(memory); }
#endif

namespace kith::testing {
namespace {

constexpr const char* kReleased =
    "[group]\nask_name = true\ndropout = { policy = \"simulate\" }\n"
    "questions = [{ id = \"a\", kind = \"text\", text = \"?\" }]\n";

// The pages that people, facilitators and observers have in front of them.
Json pages_of(const Room& room, std::int64_t now) {
  Json pages = Json::array();
  for (std::size_t seat = 1; seat <= room.num_seats(); ++seat) {
    if (room.is_person(seat)) pages.push_back(room.view({Viewer::Role::kParticipant, seat}, now));
  }
  for (const auto role : {Viewer::Role::kFacilitator, Viewer::Role::kObserver}) {
    pages.push_back(room.view({role, 0}, now));
    pages.push_back(room.row({role, 0}));
  }
  return pages;
}

// A session up to a point after its end.
struct Ending {
  const char* name;
  void (*bring)(Play&);
};

void teach(Play& play) {
  play.start(3);
  play.play_on({1, 2, 3});
}

const Ending kEndings[] = {
    {"questions", teach},
    {"all questions answered",
     [](Play& play) {
       teach(play);
       for (std::size_t i = 1; i <= 3; ++i) play.act(i);
     }},
    {"ended by a facilitator",
     [](Play& play) {
       play.start(3);
       play.play_on({1, 2, 3}, false, 7);
       ASSERT_EQ(play.facilitator("end"), "");
     }},
    {"with a stand-in, during a test",
     [](Play& play) {
       play.start(3);
       ASSERT_EQ(play.seat(2, "leave"), "");
       for (const std::size_t i : {1u, 3u}) play.watch(i);
       play.answer(1);
       ASSERT_EQ(play.facilitator("end"), "");
     }},
    {"in the lobby",
     [](Play& play) {
       play.start(2, 1);
       ASSERT_EQ(play.facilitator("end"), "");
     }},
};

TEST(Release, ChangesNothingThatAnybodySees) {
  for (const auto& ending : kEndings) {
    SCOPED_TRACE(ending.name);
    Play play{live_study(kReleased)};
    ending.bring(play);
    auto released = play.room();
    released.release();
    EXPECT_TRUE(play.room().holds_session()) << "copies are independent";
    EXPECT_FALSE(released.holds_session());
    EXPECT_EQ(pages_of(released, play.now()), pages_of(play.room(), play.now()));
    EXPECT_EQ(released.digest(), play.room().digest());
    EXPECT_EQ(released.stage(), play.room().stage());
    EXPECT_EQ(released.next_due(), play.room().next_due());
    EXPECT_FALSE(released.teaching());
    EXPECT_TRUE(released.likely_teaching().empty());
  }
}

TEST(Release, LeavesCommandsAndEventsAsTheyWere) {
  for (const auto& ending : kEndings) {
    SCOPED_TRACE(ending.name);
    Play play{live_study(kReleased)};
    ending.bring(play);
    auto released = play.room();
    released.release();
    const std::vector<RoomCommand> commands{
        {"server", "away", {{"seat", 1}}, {}},
        {"seat:1", "questions", {{"answers", {{"a", "clear"}}}}, {}},
        {"seat:1", "answer", {{"test", 0}, {"actions", {0}}, {"keys", Json::array()}, {"ms", 3}}, {}},
        {"seat:1", "watched", {{"demo", 0}}, {}},
        {"seat:1", "draft", {{"test", 0}, {"actions", {0}}}, {}},
        {"seat:1", "continue", Json::object(), {}},
        {"seat:2", "name", {{"name", "Ada"}}, {}},
        {"facilitator", "message", {{"text", "Thank you."}, {"reason", "thanks"}}, {}},
        {"facilitator", "pause", {{"reason", "a break"}}, {}},
        {"facilitator", "resume", {{"reason", "a break"}}, {}},
        {"facilitator", "extend", {{"seconds", 5}, {"reason", "slow"}}, {}},
        {"facilitator", "strategy", {{"name", "joint"}, {"reason", "too late"}}, {}},
        {"facilitator", "simulate", {{"seat", 1}, {"reason", "too late"}}, {}},
        {"facilitator", "readmit", {{"seat", 2}, {"reason", "too late"}}, {}},
        {"server", "join", Json::object(), {}},
        {"server", "present", {{"seat", 1}}, {}},
        {"seat:3", "leave", Json::object(), {}},
        {"facilitator", "end", {{"reason", "late"}}, {}},
    };
    for (const auto& command : commands) {
      const auto expected = play.room().decide(command, play.now());
      const auto decision = released.decide(command, play.now());
      EXPECT_EQ(decision.events, expected.events) << command.type;
      EXPECT_EQ(decision.refusal, expected.refusal) << command.type;
      for (const auto& event : expected.events) {
        play.apply(event);
        released.apply(event, play.cache());
      }
      EXPECT_EQ(released.digest(), play.room().digest()) << command.type;
      EXPECT_EQ(pages_of(released, play.now()), pages_of(play.room(), play.now())) << command.type;
    }
    play.expect_replay();
  }
}

TEST(Release, DoesNothingWhileTheGroupMayStillBeTaught) {
  Play play{live_study(kReleased)};
  const auto is_kept = [&] {
    auto room = play.room();
    room.release();
    return room.holds_session();
  };
  EXPECT_TRUE(is_kept());
  play.start(3);
  EXPECT_TRUE(is_kept());
  play.play_on({1, 2, 3}, true, 5);
  EXPECT_TRUE(is_kept());
}

#ifdef KITH_COUNTS_BYTES
// With 120 particles, 19 of 91 kB stay after the third ending, mostly for the facilitator's page.
TEST(Release, GivesBackMostBytes) {
  for (const auto& ending : {kEndings[1], kEndings[2]}) {
    SCOPED_TRACE(ending.name);
    Play play{live_study(kReleased)};
    ending.bring(play);
    const auto events = play.events();
    const auto bytes_of = [&](bool is_released) {
      const std::ptrdiff_t before = num_bytes;
      auto room = replay(live_study(kReleased), play.room().setup(), events, play.cache());
      if (is_released) room.release();
      // What the cache has learned meanwhile is not the room's: another replay fills nothing in.
      const std::ptrdiff_t after = num_bytes;
      return after - before;
    };
    static_cast<void>(bytes_of(false));  // fills the cache
    const auto whole = bytes_of(false);
    const auto released = bytes_of(true);
    RecordProperty("whole", static_cast<int>(whole));
    RecordProperty("released", static_cast<int>(released));
    EXPECT_LT(released, 32'000);
    EXPECT_LT(released, whole / 3);
  }
}
#endif

}  // namespace
}  // namespace kith::testing
