// What participants are told where something is left to chance.
#include <gtest/gtest.h>

#include <string>

#include "domain_texts.hpp"
#include "kith/domains/domain_file.hpp"
#include "live_play.hpp"
#include "room_view.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::page;
using testing::Play;

TEST(Chance, ShowsRunsOfTheRobotWhereItHasAPart) {
  Play play{live_study({}, "domains/gallery/frozen_lake.toml")};
  play.start(3);
  std::size_t with_chance = 0;
  for (std::size_t shown = 0; play.room().stage_of(1) == "watch" && shown < 9; ++shown) {
    const auto watch = page(play, 1)["watch"];
    const auto world = watch["board"]["world"].get<std::size_t>();
    ASSERT_EQ(watch.contains("runs"), !play.study().atlas->domain().mdp(MdpIndex{world}).is_deterministic());
    ASSERT_EQ(play.seat(1, "watched", {{"demo", watch["index"]}}), "");
    if (!watch.contains("runs")) continue;
    ++with_chance;
    EXPECT_NE(watch["runs"]["text"].get<std::string>().find("10 runs"), std::string::npos);
    ASSERT_EQ(watch["runs"]["runs"].size(), 5u);
    for (const auto& run : watch["runs"]["runs"]) {
      EXPECT_EQ(run["frames"][0]["robot"], watch["board"]["start"]["robot"]);
      EXPECT_TRUE(run["ended"].is_boolean());
    }
    if (watch["index"] != 0) continue;
    EXPECT_EQ(page(play, 2)["watch"]["runs"], watch["runs"]) << "the same for everybody";
  }
  EXPECT_GT(with_chance, 0u);
}

// Pages draw what can follow from both moves at the fork; what the robot's spares is told with the answer only.
TEST(Chance, IsToldInFeedbackWithWhatTheRobotsMoveSpares) {
  Play play{live_study({}, "domains/gallery/frozen_lake.toml")};
  play.start(3);
  std::size_t told = 0, spared = 0;
  for (int i = 0; i < 400 && play.room().stage() == RoomStage::kRunning; ++i) {
    play.act(1 + static_cast<std::size_t>(i % 3), i % 2 == 0);
    const auto view = page(play, 1);
    if (view["stage"] != "feedback") continue;
    for (const auto& test : view["feedback"]["tests"]) {
      if (!test.contains("chance")) continue;
      EXPECT_FALSE(test["right"].get<bool>());
      const auto world = test["board"]["world"].get<std::size_t>();
      EXPECT_EQ(test["chance"]["world"], world_key(play.study(), MdpIndex{world}));
      EXPECT_TRUE(world_json(play.study(), MdpIndex{world}).contains("outcomes"));
      ++told;
      spared += test["chance"]["spared"].size();
    }
  }
  EXPECT_GT(told, 0u);
  EXPECT_GT(spared, 0u);
}

// The same way in two worlds; in the second the robot may slip back.
constexpr const char* kStates = "state,start,terminal\nbank,true,false\nshore,false,true\n";
constexpr const char* kTransitions = R"(mdp,state,action,next,probability,slip,step
firm,bank,go,shore,1,0,1
icy,bank,go,shore,0.75,0,1
icy,bank,go,bank,0.25,1,1
)";

TEST(Chance, IsNotSpokenOfInFeedbackAboutAWorldWithoutAny) {
  const auto reading =
      parse_domain(testing::kSlippery, "domain.toml", {},
                   {.folder = {}, .known = {{"states.csv", kStates}, {"transitions.csv", kTransitions}}});
  ASSERT_TRUE(reading.domain) << to_text(reading.diagnostics.front());
  const auto& domain = *reading.domain;
  const auto step = domain.count_scale();
  const IntegerVector robot{0, step}, own{0, 3 * step};
  const auto certain = cost_in_words(domain, MdpIndex{0}, robot, own);
  EXPECT_NE(certain.find("2 more"), std::string::npos) << certain;
  EXPECT_EQ(certain.find("tries"), std::string::npos) << certain;
  const auto by_chance = cost_in_words(domain, MdpIndex{1}, robot, own);
  EXPECT_NE(by_chance.find("In 10 tries"), std::string::npos) << by_chance;
}

}  // namespace
}  // namespace kith
