#include "kith/teaching/random_test.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "item_delivery.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/session.hpp"

namespace kith {
namespace {

using People = std::vector<std::vector<double>>;
using testing::item_delivery;

class RandomTestTest : public ::testing::Test {
 protected:
  [[nodiscard]] ParticleBelief prior() {
    const FilterOptions filter{.particles = 300};
    return {cache_.cover(item_delivery().prior_cone(), filter.particles), filter};
  }
  TeachingCache cache_{item_delivery()};
};

TEST_F(RandomTestTest, OfOnePersonIsTheShareOfTestsAnsweredCorrectly) {
  const auto belief = prior();
  const auto& table = *cache_.exam().table();
  for (std::size_t k = 0; k < table.num_components(); ++k) {
    double expected = 0.0;
    for (std::size_t i = 0; i < belief.size(); ++i) {
      const auto cell = item_delivery().tables().cells().locate(belief.point(i));
      for (const auto& one : table.tests(k)) {
        if (table.is_right(cell, one.hull)) expected += belief.weights()[i] * one.weight;
      }
    }
    const RandomTest test{item_delivery(), cache_.exam(), k};
    EXPECT_NEAR(test.all_right(People{test.right(belief)}), expected, 1e-12);
  }
}

TEST_F(RandomTestTest, IsHarderForSeveralPeopleInWhateverOrder) {
  const RandomTest test{item_delivery(), cache_.exam(), 2};
  auto taught = prior();
  taught.observe(item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[2].constraints),
                 HalfSpaceLikelihood{0.9, LikelihoodForm::kDiscontinuous, 3}, RandomStream{1});
  const auto novice = test.right(prior()), expert = test.right(taught);
  EXPECT_LT(test.all_right(People{novice, expert}), test.all_right(People{novice}));
  EXPECT_EQ(test.all_right(People{novice, expert}), test.all_right(People{expert, novice}));
}

// What the members' answers say counts for the belief that strategies plan with, and not for those of the hypotheses.
TEST_F(RandomTestTest, TeamBanksLearnFromAnswers) {
  std::vector<double> informed, hypothetical;
  for (const bool right : {true, false}) {
    Session session{cache_,
                    {.keep_bank = true},
                    strategy_named("joint"),
                    {RandomStream{7}.split("anna"), RandomStream{7}.split("ben")},
                    RandomStream{7}.split("teacher")};
    ASSERT_TRUE(session.propose(cache_));
    const auto taught = session.lesson().taught;
    session.show();
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<Answer> answers;
      for (const auto& test : session.lesson().tests) {
        answers.push_back(right ? Answer{item_delivery().feature_counts(test.start)} : Answer{});
      }
      session.answer(i, answers);
    }
    hypothetical.push_back(session.bank()->member(0).belief(0).mass_in(taught));
    session.close_tests();
    informed.push_back(session.bank()->informed(0).mass_in(taught));
  }
  EXPECT_EQ(hypothetical[0], hypothetical[1]);
  EXPECT_GT(informed[0], informed[1]);
}

}  // namespace
}  // namespace kith
