// How people come in, and what is kept of those who do not.
#include "kith/service/live_service.hpp"

#include <gtest/gtest.h>

#include "kith/store/session_review.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using testing::Group;
using testing::is_stored;
using testing::kQuestions;
using testing::open_page_of;
using testing::play;
using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;
using testing::stored;
using testing::three_people;

TEST(LiveService, LetsNobodyNewInWhenTheDiskIsAlmostFull) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  const auto code = stage.join_code();
  stage.free_bytes = 150'000'000;
  stage.pass_ms(1100);
  for (auto& person : people) person->beat(stage.service());
  const auto warned = Json::parse(stage.get("/api/integrity", stage.facilitator_token()).body);
  EXPECT_EQ(warned["problems"].size(), 1u);
  EXPECT_NE(stage.join(code), "") << "a warning only";
  stage.free_bytes = 40'000'000;
  stage.pass_ms(1100);
  EXPECT_EQ(stage.post("/api/join", {{"code", code}}).status, 503);
  ASSERT_TRUE(play(stage, people, solver)) << "answers are always taken";
}

TEST(LiveService, GivesAPageToWhoFindsNoSeat) {
  const ScratchFolder scratch;
  auto study = small_study();
  Stage stage{scratch / "live", study};
  stage.change_options = [](LiveServiceOptions& options) { options.max_rooms = 1; };
  stage.restart();
  const auto people = three_people(stage);
  const auto reply = stage.post("/api/join", {{"code", stage.join_code()}});
  EXPECT_EQ(reply.status, 200);
  const auto body = Json::parse(reply.body);
  EXPECT_EQ(body["full"]["stage"], "full");
  EXPECT_EQ(stage.post("/api/join", {{"code", "NOSUCH"}}).status, 404);
}

TEST(LiveService, KeepsOfWhoFindsNoSeatOnlyWhatTheStudyCollects) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  stage.change_options = [](LiveServiceOptions& options) { options.max_rooms = 1; };
  stage.restart();
  const auto people = three_people(stage);
  const Json query{{"PROLIFIC_PID", "pid-late"}, {"email", "late@example.org"}};
  const auto reply = stage.post("/api/join", {{"code", stage.join_code()}, {"query", query}});
  ASSERT_TRUE(Json::parse(reply.body).contains("full")) << reply.body;
  stage.stop();
  EXPECT_TRUE(is_stored(stage, "pid-late"));
  EXPECT_FALSE(is_stored(stage, "late@example.org"));
  EXPECT_GT(redact(stage.folder(), std::nullopt, stage.clock().now_us()), 0u);
  EXPECT_FALSE(is_stored(stage, "pid-late"));
}

TEST(LiveService, KeepsNothingAboutWhoDeclines) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  people[0]->ask(stage.service(), "consent", {{"accept", false}, {"version", "1"}});
  people[1]->ask(stage.service(), "consent",
                 {{"accept", true}, {"version", "1"}, {"query", {{"PROLIFIC_PID", "forged"}}}});
  group.settle();
  EXPECT_EQ(people[0]->stage(), "declined");
  EXPECT_EQ(people[1]->stage(), "check");
  stage.stop();
  EXPECT_FALSE(is_stored(stage, "pid-a"));
  EXPECT_TRUE(is_stored(stage, "pid-b"));
  EXPECT_FALSE(is_stored(stage, "pid-c")) << "has not consented yet";
  EXPECT_FALSE(is_stored(stage, "forged"));
}

// A person whose link has a damaged parameter takes part without it.
TEST(LiveService, DropsQueryParametersThatAreNoShortTexts) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  const auto code = stage.join_code();
  for (const Json& query :
       {Json{{"PROLIFIC_PID", "a\x01"}}, Json{{"PROLIFIC_PID", std::string(201, 'x')}}, Json{{"PROLIFIC_PID", 7}}}) {
    EXPECT_NE(stage.join(code, query), "") << query;
  }
  auto file = stored(stage);
  EXPECT_EQ(file.rooms().size(), 1u);
}

std::size_t num_people(Stage& stage) {
  auto file = stored(stage);
  std::size_t people = 0;
  for (const auto& room : list_rooms(file)) people += room.joined;
  return people;
}

// Recruitment platforms let people follow the link again; a second seat would be a ghost for whom others wait.
TEST(LiveService, LeadsWhoFollowsTheLinkAgainBackToTheirSeat) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  const auto code = stage.join_code();
  const Json query{{"PROLIFIC_PID", "pid-a"}};
  const auto first = stage.join(code, query);
  const auto person = open_page_of(stage, first);
  const auto second = stage.join(code, query);
  EXPECT_NE(second, first);
  const auto again = open_page_of(stage, second);
  again->ask(stage.service(), "consent", {{"accept", true}, {"version", "1"}});
  stage.service().settle();
  again->read();
  EXPECT_EQ(again->stage(), "check");
  EXPECT_NE(stage.join(code, {{"PROLIFIC_PID", "pid-b"}}), "");

  // Also where the server was stopped meanwhile.
  stage.restart();
  const auto returned = open_page_of(stage, stage.join(code, query));
  EXPECT_EQ(returned->stage(), "check");
  stage.stop();
  EXPECT_EQ(num_people(stage), 2u);
}

// What the link said is not stored before the consent, so the page says it once more.
TEST(LiveService, KnowsWhoConsentsAfterARestart) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  const Json query{{"PROLIFIC_PID", "pid-a"}, {"other", "x-other"}};
  group.restart();
  people[0]->ask(stage.service(), "consent", {{"accept", true}, {"version", "1"}, {"query", query}});
  group.settle();
  EXPECT_EQ(people[0]->stage(), "check");
  const auto returned = open_page_of(stage, stage.join(stage.join_code(), query));
  EXPECT_EQ(returned->stage(), "check") << "the same seat";
  stage.stop();
  EXPECT_TRUE(is_stored(stage, "pid-a"));
  EXPECT_FALSE(is_stored(stage, "x-other"));
}

TEST(LiveService, GivesWhoDeclinedAndComesAgainANewSeat) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  const auto code = stage.join_code();
  const Json query{{"PROLIFIC_PID", "pid-a"}};
  const auto person = open_page_of(stage, stage.join(code, query));
  person->ask(stage.service(), "consent", {{"accept", false}, {"version", "1"}});
  stage.service().settle();
  const auto again = open_page_of(stage, stage.join(code, query));
  EXPECT_EQ(again->stage(), "consent");
}

TEST(LiveService, AsksWhoSeemsToHaveJoinedBefore) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  const auto join = [&](const Json& more) {
    Json body{{"code", stage.join_code()}};
    body.update(more);
    return Json::parse(stage.post("/api/join", body).body);
  };
  EXPECT_TRUE(join({{"has_joined", false}}).contains("token"));
  EXPECT_EQ(join({{"has_joined", true}}), Json({{"ask", true}}));
  EXPECT_TRUE(join({{"has_joined", true}, {"query", {{"PROLIFIC_PID", "pid-a"}}}}).contains("token"));
}

TEST(LiveService, LimitsHowManyJoinFromOneAddress) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  stage.change_options = [](LiveServiceOptions& options) { options.joins_per_minute = 2; };
  stage.restart();
  const auto code = stage.join_code();
  EXPECT_NE(stage.join(code), "");
  EXPECT_NE(stage.join(code), "");
  EXPECT_EQ(stage.post("/api/join", {{"code", code}}).status, 429);
  stage.pass_ms(61'000);
  EXPECT_EQ(stage.post("/api/join", {{"code", code}}).status, 200);
}

// Codes of rooms are short; the study's is not, so whoever guesses keeps nobody of the same address from joining.
TEST(LiveService, LimitsHowManyCodesAreTriedFromOneAddress) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  stage.change_options = [](LiveServiceOptions& options) { options.wrong_codes_per_minute = 10; };
  stage.restart();
  const auto code = stage.join_code();
  const auto page = stage.facilitator();
  page->ask(stage.service(), "room-make", {{"reason", "a group of friends"}});
  stage.show(*page);
  const auto room = page->view()["rooms"].back()["code"].get<std::string>();
  const auto status_of = [&](const std::string& tried) { return stage.post("/api/join", {{"code", tried}}).status; };
  for (int i = 0; i < 10; ++i) EXPECT_EQ(status_of("WRONG" + std::to_string(i)), 404);
  EXPECT_EQ(status_of("WRONG"), 429);
  EXPECT_EQ(status_of(room), 429);
  EXPECT_EQ(status_of(code), 200);
  stage.pass_ms(61'000);
  EXPECT_EQ(status_of(room), 200);
}

}  // namespace
}  // namespace kith
