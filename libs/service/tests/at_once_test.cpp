// Everything happens at once: under ThreadSanitizer this shows whether each part keeps to its strand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <map>
#include <set>
#include <thread>

#include "kith/service/live_service.hpp"
#include "kith/store/session_review.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using testing::kQuestions;
using testing::Page;
using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;
using testing::stored;

constexpr std::size_t kPeople = 64;

// Somebody who comes in at the same moment as all others, says everything twice, loses the connection, and may leave.
struct Restless {
  void live(Stage& stage, const std::string& code, std::size_t number) {
    auto& service = stage.service();
    const Json query{{"PROLIFIC_PID", "pid-" + std::to_string(number)}};
    page.emplace(stage.join(code, query), "tab-" + std::to_string(number));
    page->connect(service);
    service.measured(page->connection(), std::chrono::microseconds{number});
    consent = page->ask(service, "consent", {{"accept", true}, {"version", "1"}});
    for (const auto& message : page->unsaved()) page->send(service, message);
    page->beat(service);
    if (number % 3 == 0) {
      page->disconnect(service);
      page->connect(service);  // sends again what is not acknowledged
    }
    if (number % 8 == 0) again = stage.join(code, query);
    page->ask(service, number % 5 == 0 ? "leave" : "checked", Json::object());
  }

  std::optional<Page> page;
  std::string consent, again;
};

// Looks at one room after the other, makes rooms, and changes its mind.
void look_around(Stage& stage, Page& page) {
  auto& service = stage.service();
  page.connect(service);
  page.ask(service, "room-make", {{"reason", "more"}, {"count", 2}});
  for (int room = 0; room <= 20; ++room) {
    page.ask(service, "room-select", {{"room", room == 0 ? "" : "r" + std::to_string(room)}});
    EXPECT_EQ(stage.get("/api/integrity", stage.facilitator_token()).status, 200);
    page.beat(service);
  }
  EXPECT_EQ(stage.get("/api/export", stage.facilitator_token()).status, 200);
  page.read();
}

TEST(LiveService, KeepsEverythingInOrderWhenItHappensAtOnce) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  const auto code = stage.join_code();
  std::vector<Restless> people(kPeople);
  std::vector<Page> facilitators;
  for (const auto* tab : {"1", "2", "3", "4"}) facilitators.emplace_back(stage.facilitator_token(), tab);
  std::atomic<bool> is_over = false;
  std::jthread time{[&] {
    while (!is_over) {
      stage.clock().advance_ms(1);
      stage.service().tick();
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
  }};
  {
    std::vector<std::jthread> all;
    for (std::size_t i = 0; i < kPeople; ++i) all.emplace_back([&, i] { people[i].live(stage, code, i); });
    for (auto& page : facilitators) all.emplace_back([&] { look_around(stage, page); });
  }
  is_over = true;
  time.join();
  stage.service().settle();

  // Everybody has a seat of their own, and what was said twice was heard once.
  std::set<std::string> tokens;
  for (auto& person : people) {
    person.page->read();
    tokens.insert(person.page->token());
    EXPECT_THAT(person.page->acks(), Contains(person.consent)) << person.page->last_nak();
    EXPECT_NE(person.page->stage(), "") << person.page->name();
  }
  EXPECT_EQ(tokens.size(), kPeople);
  for (auto& page : facilitators) {
    stage.show(page);
    EXPECT_GE(page.view()["rooms"].size(), (kPeople - kPeople / 5 - 1) / 3) << "every fifth leaves a seat to others";
    EXPECT_TRUE(page.unsaved().empty());
    EXPECT_TRUE(page.view()["integrity"]["problems"].empty()) << page.view()["integrity"];
  }
  stage.stop();

  auto file = stored(stage);
  std::map<std::string, std::size_t> events;
  file.for_each_event([&](const StoredEvent& event) { ++events[event.type]; });
  EXPECT_EQ(events["joined"], kPeople);
  EXPECT_EQ(events["consented"], kPeople);
  TeachingCache cache{stage.study().study->atlas};
  for (const auto& room : file.rooms())
    EXPECT_EQ(replay_room(file, room, stage.study().study, cache).problem, "") << room.number;
}

}  // namespace
}  // namespace kith
