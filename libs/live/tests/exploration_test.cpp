// People change the world and see where the robot goes then.
#include <gtest/gtest.h>

#include "kith/core/distributions.hpp"
#include "kith/geometry/half_space.hpp"
#include "live_play.hpp"

namespace kith::testing {
namespace {

std::shared_ptr<const LiveStudy> study_to_explore(const std::string& domain = "item-delivery") {
  const auto text = kLiveStudy + "[group.screens]\nbrackets = true\nexplore = true\n";
  auto with_domain = text;
  with_domain.replace(with_domain.find("item-delivery"), 13, domain);
  auto reading = parse_study(with_domain, "live.toml", {.overrides = {}, .folder = KITH_SOURCE_DIR});
  return make_live_study(*reading.study, atlas_of(domain), {}, reading.domain_text);
}

Json page(const Play& play) { return play.room().view({Viewer::Role::kParticipant, 1}, play.now()); }

// Until the first feedback.
Play at_feedback(std::shared_ptr<const LiveStudy> study) {
  Play play{std::move(study), "N"};
  play.start(1);
  while (page(play)["stage"] != "feedback") play.act(1);
  return play;
}

std::vector<std::string> actions_of(const Json& shown) {
  std::vector<std::string> actions;
  for (const auto& frame : shown["path"]["frames"]) {
    if (frame["action"].is_string()) actions.push_back(frame["action"]);
  }
  return actions;
}

double width(const Json& bracket) {
  const auto end = [&](const char* key, double none) {
    return bracket[key].is_null() ? none : bracket[key][0].get<double>() / bracket[key][1].get<double>();
  };
  return end("high", 1e6) - end("low", -1e6);
}

// Crossing rubble costs the robot 3 steps: it goes round one tile as long as that takes two more, and through it from
// four on.
TEST(Exploration, TheRobotTakesTheDetourUntilItIsTooLong) {
  auto play = at_feedback(study_to_explore());
  const auto ask = [&](const Json& map) {
    const Json start{{"robot", {4, 3}},
                     {"items", {{{"name", "parcel"}, {"cell", {4, 3}}, {"carried", false}}}},
                     {"stations", Json::array()}};
    EXPECT_EQ(play.seat(1, "explore", {{"map", map}, {"start", start}}), "");
    return actions_of(page(play)["explore"]["last"]);
  };
  const std::size_t handling = 2;                                 // picks it up and drops it
  EXPECT_EQ(ask({"#...", "#...", "G.rS"}).size(), handling + 5);  // round the rubble: two more steps
  EXPECT_EQ(ask({"#...", "#.#.", "G.rS"}).size(), handling + 3);  // that would be four
}

TEST(Exploration, WhatIsShownHoldsForTheRobotAndOnlyNarrowsTheBrackets) {
  auto play = at_feedback(study_to_explore());
  auto random = RandomStream{43}.split("maps");
  std::map<std::size_t, double> widths;
  std::size_t possible = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    Json map{"#...", "#...", "G..S"};
    for (auto& row : map) {
      auto text = row.get<std::string>();
      for (auto& symbol : text) {
        const auto draw = uniform_index(5, random);
        if (symbol == '.' && draw < 3) symbol = "r#B"[draw];
      }
      row = text;
    }
    Json stations = Json::array();
    for (std::size_t y = 0; y < 3; ++y) {
      for (std::size_t x = 0; x < 4; ++x) {
        if (map[y].get_ref<const std::string&>()[x] == 'B') stations.push_back({x + 1, y + 1});
      }
    }
    const Json start{{"robot", {4, 3}},
                     {"items", {{{"name", "parcel"}, {"cell", {4, 3}}, {"carried", false}}}},
                     {"stations", stations}};
    ASSERT_EQ(play.seat(1, "explore", {{"map", map}, {"start", start}}), "");
    const auto explore = page(play)["explore"];
    possible += explore["last"].contains("path") ? 1u : 0u;
    for (const auto& bracket : explore["brackets"]) {
      const auto feature = bracket["feature"].get<std::size_t>();
      const auto truth = play.study().atlas->domain().weights().raw[feature];  // the reference, a step, costs 1
      const auto at = [&](const char* key) { return bracket[key][0].get<double>() / bracket[key][1].get<double>(); };
      EXPECT_TRUE(bracket["low"].is_null() || at("low") <= truth);
      EXPECT_TRUE(bracket["high"].is_null() || at("high") >= truth);
      EXPECT_TRUE(!widths.contains(feature) || width(bracket) <= widths[feature]);
      widths[feature] = width(bracket);
    }
  }
  EXPECT_GT(possible, 5u);
  EXPECT_EQ(widths.size(), 2u);
  const auto again = replay(play.study_of_room(), play.room().setup(), play.events(), play.cache());
  EXPECT_EQ(again.digest(), play.room().digest());
  EXPECT_EQ(again.view({Viewer::Role::kParticipant, 1}, play.now()), page(play));
}

TEST(Exploration, IsOnlyPossibleWhereTheStudySaysSoAndInItsTime) {
  auto play = at_feedback(live_study());
  const Json body{{"world", 0}, {"start", page(play)["feedback"]["tests"][0]["board"]["start"]}};
  EXPECT_EQ(play.seat(1, "explore", body), "not-now");
  EXPECT_FALSE(page(play).contains("explore"));
  Play early{study_to_explore(), "N"};
  early.start(1);
  EXPECT_EQ(early.seat(1, "explore", body), "too-late");
}

TEST(Exploration, TakesWhatAnybodySends) {
  auto play = at_feedback(study_to_explore());
  const auto start = page(play)["explore"]["first"]["board"]["start"];
  for (const Json& body : {Json{{"start", 3}, {"world", 0}}, Json{{"start", start}, {"world", 64}},
                           Json{{"start", start}, {"map", {"", ""}}},
                           Json{{"start", start}, {"map", {"....", "....", "..."}}}, Json{{"start", start}}}) {
    EXPECT_EQ(play.seat(1, "explore", body), "bad-body") << body;
  }
  for (const Json& body :
       {Json{{"start", {{"robot", {1, 1}}}}, {"world", 0}}, Json{{"start", {{"robot", {99, -1}}}}, {"world", 0}},
        Json{{"start", start}, {"map", {"\"\"\"\"", "....", "...."}}},
        Json{{"start", start}, {"map", {"####", "####", "####"}}}}) {
    EXPECT_EQ(play.seat(1, "explore", body), "") << body;
    EXPECT_EQ(page(play)["explore"]["last"], (Json{{"impossible", true}})) << body;
  }
}

// Where the map cannot be changed the robot can still be put elsewhere.
TEST(Exploration, TheRobotCanBePutElsewhereInAnExplicitModel) {
  auto play = at_feedback(study_to_explore("domains/gallery/frozen_lake.toml"));
  auto explore = page(play)["explore"];
  EXPECT_TRUE(explore["put"].empty());
  auto start = explore["first"]["board"]["start"];
  start["robot"] = {2, 1};
  ASSERT_EQ(play.seat(1, "explore", {{"world", 0}, {"start", start}}), "");
  EXPECT_EQ(page(play)["explore"]["last"]["path"]["frames"][0]["robot"], start["robot"]);
}

}  // namespace
}  // namespace kith::testing
