#include "kith/teaching/placement.hpp"

#include <gtest/gtest.h>

#include <set>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/teaching/session.hpp"

namespace kith {
namespace {

using testing::item_delivery;

std::vector<kith::Test> placement(const std::vector<LearnerHypothesis>& hypotheses, std::size_t n) {
  const PriorCover cover{item_delivery().prior_cone(), 500};
  return placement_tests(item_delivery(), cover, LikelihoodForm::kDiscontinuous, hypotheses, n);
}

TEST(Placement, AsksDifferentStartsThatTellWhatPeopleKnow) {
  const auto tests = placement(grid_of_known_components(3), 4);
  ASSERT_EQ(tests.size(), 4u);
  std::set<std::size_t> hulls;
  for (const auto& test : tests) {
    hulls.insert(item_delivery().hull(test.demo).value());
    EXPECT_FALSE(test.covered.empty());
  }
  EXPECT_EQ(hulls.size(), 4u);
  // The choice is greedy: fewer tests are the first of more.
  const auto fewer = placement(grid_of_known_components(3), 2);
  ASSERT_EQ(fewer.size(), 2u);
  EXPECT_EQ(fewer, std::vector(tests.begin(), tests.begin() + 2));
}

TEST(Placement, IsEmptyWhereHypothesesDifferInLearningOnly) { EXPECT_TRUE(placement(grid_of_hypotheses(), 4).empty()); }

TEST(KnownComponents, AreAllCombinationsOfAFew) {
  EXPECT_EQ(grid_of_known_components(1).size(), 2u);
  EXPECT_EQ(grid_of_known_components(3).size(), 4u);
  EXPECT_EQ(grid_of_known_components(6).size(), 1u + 5u + 4u);
}

class PlacementSession : public ::testing::Test {
 protected:
  [[nodiscard]] Session session(std::string_view strategy) {
    TeachingOptions options;
    options.hypotheses_about = HypothesesAbout::kKnownComponents;
    options.placement_tests = 3;
    options.keep_bank = true;
    options.filter.particles = 300;
    return {cache_,
            options,
            strategy_named(strategy),
            {RandomStream{7}.split("a"), RandomStream{7}.split("b")},
            RandomStream{7}.split("teacher")};
  }
  // The first member answers as the robot does, the second does not answer.
  [[nodiscard]] static std::vector<std::vector<Answer>> answers(const Session& session) {
    std::vector<std::vector<Answer>> result(2);
    for (const auto& test : session.placement()) {
      result[0].emplace_back(item_delivery().feature_counts(test.demo));
      result[1].emplace_back();
    }
    return result;
  }

  TeachingCache cache_{item_delivery()};
};

TEST_F(PlacementSession, ComesBeforeTheFirstLesson) {
  auto one = session("adaptive");
  ASSERT_TRUE(one.awaits_placement());
  EXPECT_THROW((void)one.propose(cache_), Error);
  EXPECT_THROW(one.take_placement({}), Error);
  one.take_placement(answers(one));
  EXPECT_FALSE(one.awaits_placement());
  EXPECT_EQ(one.placement_verdicts()[0].size(), one.placement().size());
  EXPECT_TRUE(one.placement_verdicts()[0].front().correct);
  EXPECT_FALSE(one.placement_verdicts()[1].front().correct);
  EXPECT_THROW(one.take_placement(answers(one)), Error);
  EXPECT_TRUE(one.propose(cache_));
  // Repeated from its events.
  auto again = session("adaptive");
  for (const auto& event : one.events()) again.apply(event, cache_);
  EXPECT_EQ(again, one);
}

TEST_F(PlacementSession, TellsWhoKnowsMore) {
  auto one = session("joint");
  const auto knows = [&](std::size_t member) { return one.bank()->member(member).probability_of_knowing(0); };
  EXPECT_NEAR(knows(0), 0.5, 1e-9);
  one.take_placement(answers(one));
  EXPECT_GT(knows(0), 0.7);
  EXPECT_LT(knows(1), knows(0));
}

}  // namespace
}  // namespace kith
