#include "kith/explain/curriculum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "atlases.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

using testing::atlas_of;

bool contains(const std::vector<HalfSpace>& all, const HalfSpace& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

// Everything that a curriculum claims.
void expect_claims_hold(const Atlas& atlas, const Curriculum& curriculum) {
  const auto& domain = atlas.domain();
  EXPECT_EQ(curriculum.components.size() + curriculum.skipped.size(), atlas.knowledge_components().size());
  for (const auto& component : curriculum.components) {
    SCOPED_TRACE(component.name);
    EXPECT_FALSE(component.demonstrations.empty());
    for (const auto& shown : component.demonstrations) {
      SCOPED_TRACE(shown.reason);
      EXPECT_TRUE(contains(shown.conveys, shown.main));
      EXPECT_EQ(constraint_of(shown.contrast.robot_counts, shown.contrast.alternative_counts), shown.main);
      EXPECT_NE(shown.reason.find(told(domain, shown.main)), std::string::npos);
      EXPECT_EQ(shown.contrast.robot, atlas.trajectory(shown.start));
      EXPECT_GE(sign_of_dot(shown.main.normal(), domain.weights().integer), 0);
      // Really conveyed: somebody would expect another path from some state of the robot's, and lose by exactly this.
      bool conveyed = false;
      for (const auto s : shown.contrast.robot.states) {
        if (domain.mdp(atlas.id(shown.start).mdp).is_terminal(s)) continue;
        const auto here = atlas.index({atlas.id(shown.start).mdp, s});
        for (const auto& vertex : atlas.tables().coverage_set(here)) {
          if (vertex == atlas.feature_counts(here)) continue;
          conveyed = conveyed || constraint_of(atlas.feature_counts(here), vertex) == shown.main;
        }
      }
      EXPECT_TRUE(conveyed);
      EXPECT_EQ(shown.reason.find("1 step"), std::string::npos);
      EXPECT_EQ(shown.reason.find("paths"), std::string::npos);
      EXPECT_EQ(shown.reason.find('{'), std::string::npos);
      EXPECT_EQ(shown.reason.find("  "), std::string::npos);
    }
    for (std::size_t i = 0; i < component.tests.size(); ++i) {
      const auto& test = component.tests[i];
      EXPECT_GE(test.share_right, 0.0);
      EXPECT_LE(test.share_right, 1.0);
      if (i > 0) {
        EXPECT_GE(component.tests[i - 1].share_right, test.share_right);
        EXPECT_LE(component.tests[i - 1].difficulty, test.difficulty);
      }
      const auto grade = test.share_right >= 2.0 / 3.0  ? Difficulty::kEasy
                         : test.share_right < 1.0 / 3.0 ? Difficulty::kHard
                                                        : Difficulty::kMedium;
      EXPECT_EQ(test.difficulty, grade);
      EXPECT_FALSE(test.covers.empty());
    }
  }
}

TEST(Curriculum, ClaimsNothingThatDoesNotHold) {
  for (const auto& name : testing::kSmallDomains) {
    SCOPED_TRACE(name);
    expect_claims_hold(atlas_of(name), make_curriculum(atlas_of(name)));
  }
}

// Each start once, and tests that tell something.
TEST(Curriculum, BeginsWithAFewBoards) {
  for (const auto* name : {"item-delivery", "navigation"}) {
    const auto& atlas = atlas_of(name);
    std::set<StartIndex> starts;
    for (const auto& component : make_curriculum(atlas).components) {
      for (const auto& test : component.tests) {
        EXPECT_TRUE(!test.is_first || (test.is_shortest_wrong && starts.insert(test.start).second));
      }
      for (const auto& shown : component.demonstrations) {
        EXPECT_TRUE(!shown.is_first || starts.insert(shown.start).second);
      }
    }
    EXPECT_GE(starts.size(), 8u);
    EXPECT_LE(starts.size(), Curriculum::kMostFirst);
  }
}

TEST(CurriculumSlow, HoldsForColoredTiles) {
  expect_claims_hold(atlas_of("colored-tiles"), make_curriculum(atlas_of("colored-tiles")));
}

TEST(Curriculum, IsTheSameAgainAndAnotherWithAnotherSeed) {
  const auto& atlas = atlas_of("item-delivery");
  const auto shown = [&](std::uint64_t seed) {
    CurriculumOptions options;
    options.seed = seed;
    std::vector<std::string> all;
    for (const auto& component : make_curriculum(atlas, options).components) {
      for (const auto& demonstration : component.demonstrations) {
        all.push_back(std::to_string(demonstration.start.value()) + demonstration.reason);
      }
      for (const auto& test : component.tests) {
        all.push_back(std::to_string(test.start.value()) + std::to_string(test.share_right));
      }
    }
    return all;
  };
  EXPECT_EQ(shown(7), shown(7));
  EXPECT_NE(shown(7), shown(8));
}

TEST(Curriculum, NamesComponentsInWords) {
  const auto& atlas = atlas_of("item-delivery");
  EXPECT_EQ(component_in_words(atlas, 0), "crossing rubble versus steps");
  EXPECT_EQ(component_in_words(atlas, 2), "crossing rubble and stopping at the charger versus steps");
  EXPECT_EQ(component_in_words(atlas_of("cookie-crumb"), atlas_of("cookie-crumb").knowledge_components().size() - 1),
            "reaching the jar and eating crumbs versus steps");
}

TEST(Curriculum, SharesAgreeWithAnIndependentCount) {
  const auto& atlas = atlas_of("item-delivery");
  const auto first = make_curriculum(atlas).components.front();
  RandomStream random{99};
  constexpr int kDraws = 4000;
  for (const auto& test : first.tests) {
    int right = 0;
    for (int i = 0; i < kDraws; ++i) {
      const auto answer =
          atlas.tables().answer(test.start, atlas.tables().cells().locate(atlas.prior_cone().sample(random)));
      right += answer == atlas.feature_counts(test.start) ? 1 : 0;
    }
    // Four standard errors of a share.
    EXPECT_NEAR(test.share_right, static_cast<double>(right) / kDraws, 4.0 * 0.5 / std::sqrt(kDraws));
  }
}

// Why nothing about a domain can be taught.
std::string why_nothing(const std::string& text, const DomainFiles& files = {}) {
  auto reading = parse_domain(text, "test.toml", {}, files);
  if (!reading.domain) return "the domain is not sound";
  const Atlas atlas{*std::move(reading.domain)};
  try {
    static_cast<void>(make_curriculum(atlas));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    EXPECT_EQ(error.diagnostics().at(0).id, "E1101");
    return error.diagnostics().at(0).message;
  }
  return "something can be taught";
}

TEST(Curriculum, SaysWhenAndWhyNothingCanBeTaught) {
  EXPECT_EQ(why_nothing(testing::kOneRoad),
            "nothing about 'one-road' can be taught: in every world, everybody who expects the robot to finish "
            "predicts the same path");
  auto without_rubble = testing::kOneRoad;
  without_rubble.replace(without_rubble.find("S.r.G"), 5, "S...G");
  EXPECT_EQ(why_nothing(without_rubble),
            "nothing about 'one-road' can be taught: anybody who knows beforehand that a step costs something "
            "predicts everything that the robot does");
}

TEST(Curriculum, SaysThatNothingCanBeTaughtOfARobotWithoutAnyChoice) {
  const DomainFiles files{.known = {{"states.csv", "state,terminal\nbank,false\nshore,true\n"},
                                    {"transitions.csv",
                                     "state,action,next,probability,slip,step\n"
                                     "bank,go,shore,0.5,0,1\nbank,go,bank,0.5,1,1\n"}}};
  EXPECT_EQ(why_nothing(testing::kSlippery, files),
            "nothing about 'slippery' can be taught: the robot does the same with any reward");
}

TEST(Curriculum, RefusesToMeasureWithoutBeliefs) {
  CurriculumOptions options;
  options.beliefs = 0;
  EXPECT_THROW(static_cast<void>(make_curriculum(atlas_of("item-delivery"), options)), std::invalid_argument);
}

TEST(Curriculum, CallsDifficultiesByName) {
  EXPECT_STREQ(name_of(Difficulty::kEasy), "easy");
  EXPECT_STREQ(name_of(Difficulty::kMedium), "medium");
  EXPECT_STREQ(name_of(Difficulty::kHard), "hard");
}

}  // namespace
}  // namespace kith
