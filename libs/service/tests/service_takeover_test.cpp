// Somebody on the waiting list takes over the seat of somebody who drops out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "faulty_disk.hpp"
#include "kith/store/session_review.hpp"
#include "service_hall.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using testing::exported;
using testing::FaultyDisk;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::num_rows;
using testing::Page;
using testing::pass_with_beats;
using testing::play;
using testing::Screened;
using testing::stored;

// A group of three who watch the first lesson, and whoever waits.
struct PooledHall : Screened {
  explicit PooledHall(const std::string& more = "")
      : Screened{"dropout = { policy = \"replace-from-pool\", grace_s = 20" + more + " }\n"} {
    come("able", true);
    come("first", false);
    come("second", false);
  }
  [[nodiscard]] Page& person(const std::string& name) {
    return **std::find_if(people.begin(), people.end(), [&](const auto& one) { return one->name() == name; });
  }
  // Somebody closes the page and does not return.
  void drop(const std::string& name, int seconds = 32) {
    person(name).disconnect(stage.service());
    pass_with_beats(stage, people, seconds);
    settle();
  }
  [[nodiscard]] std::vector<StoredEvent> events_of(const std::string& type) const {
    auto file = stored(stage);
    std::vector<StoredEvent> found;
    file.for_each_event([&](const StoredEvent& event) {
      if (event.type == type) found.push_back(event);
    });
    return found;
  }
  // What is wrong with what is stored: an event of one room without its counterpart in the other, or a room that does
  // not replay.
  [[nodiscard]] std::string problems() const {
    auto file = stored(stage);
    std::string found;
    std::vector<std::string> called, seated, replaced;
    file.for_each_event([&](const StoredEvent& event) {
      const auto body = Json::parse(event.json);
      if (event.type == "called") called.push_back("r1 " + std::to_string(body["seat"].get<int>()));
      if (event.type == "seated" && body["member"].is_null()) {
        seated.push_back(body["from"]["room"].get<std::string>() + " " +
                         std::to_string(body["from"]["seat"].get<int>()));
      }
      const bool is_departure = event.type == "dropped" || event.type == "left";
      if (is_departure && event.room != 1 && !body["by"].is_null()) replaced.push_back(event.json);
    });
    if (called != seated) found += "different people are called and seated; ";
    if (seated.size() != replaced.size()) found += "somebody is seated in nobody's place; ";
    TeachingCache cache{stage.study().study->atlas};
    for (const auto& room : file.rooms()) found += replay_room(file, room, stage.study().study, cache).problem;
    return found;
  }
};

TEST(TakeoverFromTheWaitingList, GivesTheSeatToWhoeverWaits) {
  PooledHall hall;
  auto& third = hall.come("third", false);
  auto& first = hall.person("first");
  EXPECT_EQ(third.stage(), "lobby");
  ASSERT_EQ(first.stage(), "watch");
  hall.drop("first", 29);
  EXPECT_EQ(third.stage(), "lobby") << "the grace period is not over";
  pass_with_beats(hall.stage, hall.people, 4);
  hall.settle();
  EXPECT_EQ(third.stage(), "wait");
  EXPECT_EQ(third.view()["wait"]["for"], "joining");
  EXPECT_EQ(third.view()["me"]["seat"], 4);
  EXPECT_EQ(third.view()["me"]["label"], "Learner A");
  EXPECT_EQ(hall.stage.service().num_rooms(), 1u);

  // The facilitator reads what happened and why.
  const auto page = hall.stage.facilitator();
  std::string log;
  for (const auto& line : page->view()["log"]) {
    log += line["actor"].get<std::string>() + " " + line["what"].get<std::string>() + " " + line.value("reason", "") +
           "\n";
  }
  EXPECT_THAT(log, AllOf(HasSubstr("seat:4 called takes over seat 1 of room r2, whose person was away for too long"),
                         HasSubstr("seat:1 dropped another person takes over as seat 4")));
  page->disconnect(hall.stage.service());

  // Both links lead to where they should, also after a restart.
  hall.restart();
  EXPECT_EQ(third.view()["me"]["seat"], 4);
  first.connect(hall.stage.service());
  hall.settle();
  EXPECT_EQ(first.stage(), "replaced");
  EXPECT_NE(first.view()["end"].value("code", ""), "");
  ASSERT_TRUE(play(hall.stage, hall.people, hall.solver));
  EXPECT_EQ(third.stage(), "debrief");
  EXPECT_NE(third.view()["debrief"]["code"], first.view()["end"]["code"]);
  EXPECT_EQ(hall.problems(), "");

  // Both people have a row of their own, and their answers are kept apart.
  const auto tables = exported(hall.stage, {.with_names = true});
  EXPECT_EQ(num_rows(tables.at("participants.csv")), 4u);
  EXPECT_THAT(tables.at("participants.csv"), AllOf(HasSubstr("r2,1,1,N,common,NNP"), HasSubstr("r2,4,1,N,common,NNP"),
                                                   HasSubstr("pid-first"), HasSubstr("pid-third")));
  EXPECT_THAT(tables.at("tests.csv"), AllOf(HasSubstr(",4,1,N,"), Not(HasSubstr(",1,1,N,"))));
  EXPECT_THAT(exported(hall.stage).at("events.csv"), Not(HasSubstr("pid-third")));
}

TEST(TakeoverFromTheWaitingList, FollowsALeaverWhoIsAcknowledgedOnce) {
  PooledHall hall;
  auto& third = hall.come("third", false);
  auto& first = hall.person("first");
  const Page::Message leave{.id = "leave-1", .type = "leave", .body = Json::object()};
  first.send(hall.stage.service(), leave);
  hall.settle();
  EXPECT_THAT(first.acks(), ::testing::Contains("leave-1"));
  EXPECT_EQ(first.stage(), "ended");
  EXPECT_EQ(third.view()["wait"]["for"], "joining");
  hall.restart();
  first.send(hall.stage.service(), leave);  // as if the acknowledgement had been lost
  hall.settle();
  EXPECT_EQ(std::count(first.acks().begin(), first.acks().end(), "leave-1"), 2);
  EXPECT_EQ(hall.events_of("left").size(), 1u);
  ASSERT_TRUE(play(hall.stage, hall.people, hall.solver));
  EXPECT_EQ(hall.problems(), "");
}

TEST(TakeoverFromTheWaitingList, IsNotForPeopleWhomThePlaceDoesNotFit) {
  PooledHall hall;
  auto& other_able = hall.come("other", true);
  hall.drop("first");
  EXPECT_EQ(other_able.stage(), "lobby");
  EXPECT_THAT(hall.events_of("called"), IsEmpty());
  EXPECT_EQ(hall.person("able").stage(), "watch");
  hall.drop("able");
  EXPECT_EQ(other_able.view()["wait"]["for"], "joining");
  // Nobody took the first place: its link still leads back to it.
  hall.person("first").connect(hall.stage.service());
  hall.settle();
  EXPECT_EQ(hall.person("first").stage(), "wait");
  EXPECT_EQ(hall.problems(), "");
}

TEST(TakeoverFromTheWaitingList, LeavesTheRestToTheSecondChoice) {
  PooledHall hall{", otherwise = \"end-group\""};
  hall.drop("first");
  EXPECT_EQ(hall.person("able").stage(), "ended");
  EXPECT_NE(hall.person("able").view()["end"].value("code", ""), "");
}

// Two seats become free at the same moment, and one person waits.
TEST(TakeoverFromTheWaitingList, CallsNobodyTwice) {
  PooledHall hall;
  auto& third = hall.come("third", false);
  hall.person("first").disconnect(hall.stage.service());
  hall.drop("second");
  EXPECT_EQ(third.stage(), "wait");
  EXPECT_EQ(hall.events_of("called").size(), 1u);
  EXPECT_EQ(hall.events_of("dropped").size(), 2u);
  EXPECT_EQ(hall.problems(), "");
}

// The disk stops working at some moment of the takeover, and then the server: somebody has the seat or is on the list,
// never both or neither.
TEST(TakeoverFromTheWaitingList, HappensAsAWholeOrNotAtAll) {
  const FaultyDisk disk;
  std::size_t in_time = 0, too_late = 0;
  for (std::size_t n = 1; n <= 24; ++n) {
    PooledHall hall;
    auto& third = hall.come("third", false);
    hall.drop("first", 28);
    FaultyDisk::fail(n, 1'000'000, n % 2 == 0 ? FaultyDisk::Fault::kFull : FaultyDisk::Fault::kShortWrite);
    pass_with_beats(hall.stage, hall.people, 5);
    hall.stage.stop();
    FaultyDisk::heal();
    ASSERT_EQ(hall.problems(), "") << n;
    const bool was_called = !hall.events_of("called").empty();
    ++(was_called ? in_time : too_late);
    hall.stage.start();
    for (const auto* name : {"able", "second", "third"}) {
      hall.person(name).lose();
      hall.person(name).connect(hall.stage.service());
    }
    // In the end the seat is taken over, before or after the restart.
    pass_with_beats(hall.stage, hall.people, 5);
    hall.settle();
    EXPECT_EQ(hall.events_of("called").size(), 1u) << n;
    EXPECT_EQ(third.stage(), "wait") << n;
    EXPECT_EQ(hall.problems(), "") << n;
  }
  EXPECT_GT(in_time, 0u);
  EXPECT_GT(too_late, 0u);
}

// Nobody waits any more: the second seat is not filled by whoever has the first.
TEST(TakeoverFromTheWaitingList, LeavesWhoHasASeatThere) {
  PooledHall hall;
  auto& third = hall.come("third", false);
  hall.drop("first");
  ASSERT_EQ(third.stage(), "wait");
  hall.restart();
  EXPECT_EQ(third.stage(), "wait");
  hall.drop("second");
  EXPECT_EQ(hall.events_of("called").size(), 1u);
  EXPECT_EQ(third.view()["me"]["seat"], 4);
}

}  // namespace
}  // namespace kith
