// What facilitators see and do.
#include "kith/service/live_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service_group.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using testing::Group;
using testing::Page;
using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;

TEST(LiveService, ShowsFacilitatorsEverythingAndDoesWhatTheyAsk) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  const auto made = facilitator->ask(
      stage.service(), "room-make",
      {{"strategy", "common"}, {"seats", {"person", "N", "P"}}, {"count", 2}, {"reason", "two groups"}});
  stage.show(*facilitator);
  stage.show(*facilitator);
  EXPECT_THAT(facilitator->acks(), Contains(made)) << facilitator->last_nak();
  const auto rooms = facilitator->view().at("rooms");
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_NE(rooms[0]["code"], rooms[1]["code"]);
  ASSERT_TRUE(rooms[0]["seats"][0].contains("link"));
  EXPECT_EQ(facilitator->view().at("log").back()["what"], "room-make");
  EXPECT_EQ(facilitator->view().at("log").back()["reason"], "two groups");

  // The link of a seat is enough to take it.
  const auto link = rooms[0]["seats"][0]["link"].get<std::string>();
  Page person{link.substr(link.find("#t=") + 3), "linked"};
  person.connect(stage.service());
  stage.service().settle();
  person.read();
  EXPECT_EQ(person.stage(), "consent");

  facilitator->ask(stage.service(), "room-select", {{"room", "r1"}});
  stage.show(*facilitator);
  stage.show(*facilitator);
  EXPECT_EQ(facilitator->view().at("room")["id"], "r1");

  stage.pass_ms(10);  // so that the log tells the order
  facilitator->ask(stage.service(), "message", {{"room", "r1"}, {"text", "Welcome"}, {"reason", "hello"}});
  stage.show(*facilitator);
  person.read();
  ASSERT_EQ(person.view().at("notices").size(), 1u) << facilitator->last_nak();
  EXPECT_EQ(person.view().at("notices")[0]["text"], "Welcome");

  stage.pass_ms(10);
  facilitator->ask(stage.service(), "link-revoke", {{"token", link}, {"reason", "lost"}});
  stage.show(*facilitator);
  person.read();
  EXPECT_EQ(person.bye(), "removed");
  Page again{person.token(), "again"};
  again.connect(stage.service());
  stage.service().settle();
  again.read();
  EXPECT_EQ(again.bye(), "bad-token");

  // The log survives a restart.
  stage.restart();
  facilitator = stage.facilitator();
  std::vector<std::string> what;
  for (const auto& entry : facilitator->view().at("log")) what.push_back(entry["what"]);
  EXPECT_EQ(what, (std::vector<std::string>{"room-make", "joined", "message", "link-revoke"}));
}

TEST(LiveService, ShowsManyRoomsLessOftenAndTheLastNewsSoon) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  facilitator->ask(stage.service(), "room-make",
                   {{"strategy", "common"}, {"seats", {"person", "N", "P"}}, {"count", 120}, {"reason", "many"}});
  stage.show(*facilitator);  // what is new, and the pictures that are taken meanwhile
  stage.show(*facilitator);
  ASSERT_EQ(facilitator->view().at("rooms").size(), 120u) << facilitator->last_nak();

  const auto before = facilitator->views().size();
  for (int i = 1; i <= 12; ++i) {  // something new at every tick
    stage.pass_ms(10);
    facilitator->ask(stage.service(), "message", {{"room", "r1"}, {"text", "Hello"}, {"reason", std::to_string(i)}});
  }
  facilitator->read();
  EXPECT_GE(facilitator->views().size() - before, 3u);
  EXPECT_LE(facilitator->views().size() - before, 5u);
  stage.show(*facilitator);
  EXPECT_EQ(facilitator->view().at("log").back()["reason"], "12") << facilitator->last_nak();

  // What a facilitator asks to see is there at once.
  facilitator->ask(stage.service(), "room-select", {{"room", "r7"}});
  stage.service().settle();
  stage.pass_ms(10);
  stage.pass_ms(10);
  facilitator->read();
  EXPECT_EQ(facilitator->view().at("room")["id"], "r7");
}

TEST(LiveService, GivesANewLinkToASeatWhoseLinkIsUnknownAfterARestart) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  facilitator->ask(stage.service(), "room-make", {{"seats", {"person", "person", "N"}}, {"count", 1}});
  const auto links = [&] {
    stage.show(*facilitator);
    std::vector<std::string> known;
    for (const auto& seat : facilitator->view().at("rooms")[0]["seats"]) known.push_back(seat.value("link", ""));
    return known;
  };
  const auto open = [&](const std::string& link) {
    auto page = std::make_unique<Page>(link.substr(link.find("#t=") + 3), "person");
    page->connect(stage.service());
    stage.service().settle();
    page->read();
    return page;
  };
  stage.show(*facilitator);
  const auto former = links();
  const auto first = open(former[0]);
  EXPECT_EQ(first->stage(), "consent");

  stage.restart();
  facilitator = stage.facilitator();
  EXPECT_EQ(links(), (std::vector<std::string>{"", "", ""}));
  for (const int seat : {1, 2}) {
    facilitator->ask(stage.service(), "readmit", {{"room", "r1"}, {"seat", seat}, {"reason", "lost the link"}});
  }
  const auto now = links();
  EXPECT_TRUE(facilitator->naks().empty()) << facilitator->last_nak();
  for (const auto& link : {now[0], now[1], former[0], former[1]}) EXPECT_EQ(open(link)->stage(), "consent") << link;
  EXPECT_EQ(now[2], "") << "stand-ins need none";
}

TEST(LiveService, LogsWhoCameAndWhoWentAway) {
  Group group{"dropout = { policy = \"continue-now\" }\n"};
  auto& [scratch, stage, solver, people] = group;
  auto facilitator = stage.facilitator();
  people[2]->disconnect(stage.service());
  group.pass(12);
  people[2]->connect(stage.service());
  const auto comings = [&] {
    std::vector<std::pair<std::string, std::string>> found;
    for (const auto& entry : facilitator->view().at("log")) {
      if (entry.value("room", "") == "r1") found.emplace_back(entry.value("actor", ""), entry.value("what", ""));
    }
    return found;
  };
  stage.show(*facilitator);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"seat:1", "joined"}, {"seat:2", "joined"}, {"seat:3", "joined"}, {"seat:3", "away"}, {"seat:3", "present"}};
  EXPECT_EQ(comings(), expected);
  stage.restart();
  facilitator = stage.facilitator();
  EXPECT_EQ(comings(), expected);
}

TEST(LiveService, ShowsFacilitatorsHowFarAwayPeopleAre) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  auto facilitator = stage.facilitator();
  stage.service().measured(people[1]->connection(), std::chrono::microseconds{12'500});
  people[0]->disconnect(stage.service());  // something new, so that the view is sent
  group.pass(12);
  stage.show(*facilitator);
  const auto& seats = facilitator->view().at("rooms")[0]["seats"];
  EXPECT_FALSE(seats[0].contains("latency_ms"));
  EXPECT_EQ(seats[1]["latency_ms"], 12.5);
  EXPECT_FALSE(seats[2].contains("latency_ms")) << "not measured yet";
}

// The design has groups of three only.
TEST(LiveService, MakesRoomsOfOtherSizesThanTheDesigns) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  const auto made = facilitator->ask(stage.service(), "room-make", {{"seats", {"person", "P"}}, {"count", 1}});
  stage.show(*facilitator);
  EXPECT_THAT(facilitator->acks(), Contains(made)) << facilitator->last_nak();
  const auto& room = facilitator->view().at("rooms")[0];
  EXPECT_EQ(room["strategy"], "common");
  EXPECT_EQ(room["composition"], "NP");
  const auto unknown = facilitator->ask(stage.service(), "room-make", {{"strategy", "comon"}});
  stage.show(*facilitator);
  EXPECT_THAT(facilitator->naks(), Contains(unknown));
  EXPECT_EQ(facilitator->last_nak()["text"], "this study has no strategy 'comon'");
}

TEST(LiveService, ServesWorldsCodesAndTables) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  const auto key = world_key(*stage.study().study, MdpIndex{0});
  EXPECT_EQ(stage.get("/api/world/" + key).status, 401);
  const auto world = stage.get("/api/world/" + key, people[0]->token());
  EXPECT_EQ(world.status, 200);
  EXPECT_EQ(Json::parse(world.body)["key"], key);
  EXPECT_EQ(stage.get("/api/world/none", people[0]->token()).status, 404);
  const auto picture = stage.get("/api/qr?text=http%3A%2F%2Ftest%2Fj%23t%3Dabc", stage.facilitator_token());
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.body.rfind("<svg", 0), 0u);
  const auto tables = stage.get("/api/export?room=r1", stage.facilitator_token());
  EXPECT_EQ(tables.status, 200) << tables.body;
  EXPECT_EQ(tables.body.substr(257, 5), "ustar");
  EXPECT_EQ(stage.get("/api/export?room=r9", stage.facilitator_token()).status, 404);
  EXPECT_EQ(Json::parse(stage.get("/api/texts").body),
            (Json{{"lang", "en"}, {"dir", "ltr"}, {"strings", Json::object()}}));
  EXPECT_EQ(stage.get("/api/health").status, 200);
  EXPECT_EQ(stage.get("/api/nothing").status, 404);
}

}  // namespace
}  // namespace kith
