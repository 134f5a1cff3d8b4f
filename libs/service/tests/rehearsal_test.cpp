#include "kith/service/rehearsal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "bot_mind.hpp"
#include "fake_lesson.hpp"
#include "kith/core/error.hpp"
#include "kith/service/server.hpp"
#include "latencies.hpp"

namespace kith::testing {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAreArray;

ServerOptions for_many() { return {.limits = {.unauthenticated_per_address = 10'000}}; }

std::optional<AnswerPath> path_in(const std::string& world, int start) {
  return world == "w" && start == 0 ? std::optional{AnswerPath{{0, 1, 0, 0}, false}} : std::nullopt;
}

RehearsalOptions quick(const Server& server) {
  return {.port = server.port(),
          .facilitator = "facilitator",
          .groups = 4,
          .answer_every = milliseconds{40},
          .right_path = path_in};
}

TEST(Rehearsal, TeachesEverybodyToTheEnd) {
  FakeLesson lesson{3};
  Server server{for_many(), lesson};
  const auto result = rehearse(quick(server));
  EXPECT_EQ(result.groups, 4U);
  EXPECT_EQ(result.people, 12U);
  EXPECT_THAT(result.stages, ElementsAre(Pair("debrief", 12)));
  EXPECT_EQ(result.num_finished(), 12U);
  EXPECT_THAT(result.answers, SizeIs(36));
  EXPECT_EQ(result.messages, 12U * (2 + 3 * 3 + 1));
  EXPECT_EQ(result.acknowledgement.count, result.messages);
  EXPECT_EQ(result.next_lesson.count, 24U);
  EXPECT_EQ(result.refused, 0U);
  EXPECT_EQ(result.connections_lost, 0U);
  EXPECT_THAT(lesson.answers, UnorderedElementsAreArray(result.answers));
}

TEST(Rehearsal, HasAFacilitatorAndAnObserverWhoLookAtEveryGroup) {
  FakeLesson lesson{3};
  Server server{for_many(), lesson};
  auto options = quick(server);
  options.observer = "observer";
  options.answer_every = milliseconds{400};
  const auto result = rehearse(options);
  EXPECT_EQ(result.num_finished(), 12U);
  for (const auto* who : {"facilitator", "observer"}) EXPECT_THAT(lesson.looked_at[who], SizeIs(4)) << who;
  EXPECT_THAT(result.problems, ElementsAre("a page"));
}

TEST(Rehearsal, LosesAndRepeatsNothingWhenConnectionsBreak) {
  FakeLesson lesson{3, true};
  Server server{for_many(), lesson};
  auto options = quick(server);
  options.answer_every = milliseconds{300};
  options.reconnects = 0.3;
  const auto result = rehearse(options);
  EXPECT_THAT(result.stages, ElementsAre(Pair("debrief", 12)));
  EXPECT_GE(result.connections_lost + result.reconnects, 1U);
  EXPECT_EQ(lesson.early_frames, 0);
  EXPECT_THAT(lesson.answers, SizeIs(36));
  const std::set<std::string> stored{lesson.answers.begin(), lesson.answers.end()};
  for (const auto& id : result.answers) EXPECT_EQ(stored.count(id), 1U) << id;
}

TEST(Rehearsal, EndsGroupsWhenTimeIsUp) {
  FakeLesson lesson{1'000'000};
  Server server{for_many(), lesson};
  auto options = quick(server);
  options.duration = milliseconds{1500};
  const auto result = rehearse(options);
  EXPECT_THAT(result.stages, ElementsAre(Pair("ended", 12)));
}

// So that the load stays the same, however soon groups finish.
TEST(Rehearsal, FollowsGroupsThatFinishByNewOnesUntilTimeIsUp) {
  FakeLesson lesson{1};
  Server server{for_many(), lesson};
  auto options = quick(server);
  options.groups = 2;
  options.duration = milliseconds{4000};
  const auto result = rehearse(options);
  EXPECT_GE(result.seconds, 4.0);
  EXPECT_GT(result.groups, 2U);
  EXPECT_EQ(result.groups, lesson.num_rooms());
  EXPECT_EQ(result.people, 3 * result.groups);
  EXPECT_EQ(result.num_finished(), result.people) << ::testing::PrintToString(result.stages);
}

// Each group that has finished is followed by one other.
TEST(Rehearsal, TeachesAsManyGroupsAtOnceAsItIsAskedFor) {
  FakeLesson lesson{1};
  Server server{for_many(), lesson};
  auto options = quick(server);
  options.groups = 3;
  options.duration = std::chrono::minutes{5};
  std::size_t most = 0;
  options.on_tick = [&](milliseconds) {
    most = std::max(most, lesson.num_unfinished_rooms());
    return lesson.num_rooms() < 10;
  };
  const auto result = rehearse(options);
  EXPECT_GE(result.groups, 10U);
  EXPECT_EQ(most, 3U);
}

TEST(Rehearsal, AnswersAsRightlyAsItIsAskedTo) {
  for (const double right : {0.0, 1.0}) {
    FakeLesson lesson{1};
    Server server{for_many(), lesson};
    auto options = quick(server);
    options.right = right;
    (void)rehearse(options);
    EXPECT_THAT(lesson.paths, ElementsAre(right > 0.0 ? "[0,1,0,0]" : "[0,1,0]"));
  }
}

TEST(Rehearsal, SaysThatThereIsNoServer) {
  std::uint16_t port = 0;
  {
    FakeLesson lesson{1};
    port = Server{{}, lesson}.port();
  }
  EXPECT_THROW((void)rehearse({.port = port, .facilitator = "facilitator"}), Error);
}

TEST(BotMind, DoesNothingForViewsThatItDoesNotUnderstand) {
  for (const char* view : {"{}", "[]", "null", R"({"stage":"wait"})", R"({"stage":"watch"})", R"({"stage":7})",
                           R"({"stage":"predict","predict":[]})", R"({"stage":"questions","questions":{"items":3}})"}) {
    EXPECT_FALSE(act_for(nlohmann::json::parse(view)).has_value()) << view;
  }
  EXPECT_FALSE(act_for({{"stage", "check"}, {"pause", {{"why", "someone-away"}}}}).has_value());
  EXPECT_EQ(act_for({{"stage", "check"}})->type, "checked");
  const auto screened =
      act_for({{"stage", "screening"}, {"predict", {{"index", 1}, {"world", "abc-0"}, {"start", 7}}}});
  ASSERT_TRUE(screened);
  EXPECT_EQ(screened->type, "screen");
  EXPECT_EQ(screened->body["test"], 1);
  EXPECT_EQ(screened->world, "abc-0");
  EXPECT_EQ(screened->start, 7);
  const auto odd = act_for({{"stage", "screening"}, {"predict", {{"index", 1e17}, {"world", "w"}, {"start", 1.5}}}});
  ASSERT_TRUE(odd);
  EXPECT_EQ(odd->body["test"], 0);
  EXPECT_EQ(odd->start, -1);
}

TEST(Latencies, AreObservedValues) {
  std::vector<double> times;
  for (int i = 100; i > 0; --i) times.push_back(i);
  const auto summary = summarised(times);
  EXPECT_EQ(summary.count, 100U);
  EXPECT_EQ(summary.p50, 50.0);
  EXPECT_EQ(summary.p95, 95.0);
  EXPECT_EQ(summary.p99, 99.0);
  EXPECT_EQ(summary.max, 100.0);
  EXPECT_EQ(summarised({}).count, 0U);
  EXPECT_EQ(summarised({7.0}).p99, 7.0);
}

}  // namespace
}  // namespace kith::testing
