#include "kith/teaching/learner_bank.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "item_delivery.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {
namespace {

// How the answers fit each of the hypotheses.
std::vector<AnswerFit::Rating> ratings_of(const LearnerBank& bank, const AnswerFit& fit) {
  std::vector<AnswerFit::Rating> ratings;
  for (std::size_t h = 0; h < bank.hypotheses().size(); ++h) {
    PointCells cells;
    ratings.push_back(fit.of(bank.belief(h), cells));
  }
  return ratings;
}

using testing::item_delivery;

class LearnerBankTest : public ::testing::Test {
 protected:
  [[nodiscard]] LearnerBank bank(const std::vector<LearnerHypothesis>& hypotheses = grid_of_hypotheses()) {
    const FilterOptions filter{.particles = 300};
    return {cache_.cover(item_delivery().prior_cone(), filter.particles), filter, LikelihoodForm::kDiscontinuous,
            hypotheses, RandomStream{2}};
  }
  // A lesson of the first component about all of it, with a test of each of its facets.
  static std::vector<kith::Test> tests() {
    std::vector<kith::Test> tests;
    for (const auto facet : item_delivery().knowledge_components()[0].constraints.members()) {
      const auto starts = item_delivery().tests_for(facet);
      if (!starts.empty())
        tests.push_back({.start = starts.front(), .covered = {item_delivery().constraints()[facet]}});
    }
    return tests;
  }
  // After periods in which all answers were the robot's, or none.
  [[nodiscard]] LearnerBank after(int periods, bool right) {
    auto one = bank();
    const auto asked = tests();
    std::vector<Answer> answers;
    for (const auto& test : asked) answers.emplace_back(item_delivery().feature_counts(test.start));
    if (!right) answers = wrong(asked);
    const std::vector<Verdict> verdicts(asked.size());
    const auto shown = item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[0].constraints);
    one.begin_component();
    for (int period = 1; period <= periods; ++period) {
      one.watch(shown, static_cast<std::size_t>(period));
      one.see_answers(AnswerFit{item_delivery(), asked, answers, verdicts});
      one.hear_feedback(right, shown, static_cast<std::size_t>(period));
    }
    return one;
  }
  // What somebody answers who is wrong about some test.
  [[nodiscard]] std::vector<Answer> wrong(std::span<const kith::Test> asked) {
    const auto& cover = cache_.cover(item_delivery().prior_cone(), 300);
    for (std::size_t i = 0; i < cover.size(); ++i) {
      const auto cell = cache_.behaviours().locate(cover.point(i));
      std::vector<Answer> answers;
      for (const auto& test : asked) answers.push_back(item_delivery().tables().answer(test.start, cell));
      bool is_wrong = false, has_answers = true;
      for (std::size_t t = 0; t < asked.size(); ++t) {
        has_answers = has_answers && answers[t].has_value();
        is_wrong = is_wrong || (has_answers && *answers[t] != item_delivery().feature_counts(asked[t].start));
      }
      if (has_answers && is_wrong) return answers;
    }
    throw std::logic_error{"nobody answers a test wrong"};
  }

  TeachingCache cache_{item_delivery()};
};

TEST_F(LearnerBankTest, CopiesThatShareAreAsBanksForThemselves) {
  const auto shown = item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[0].constraints);
  const auto fresh = bank();
  std::vector<LearnerBank> shared(3, fresh), alone;
  for (int i = 0; i < 3; ++i) alone.push_back(bank());
  for (std::size_t period = 1; period <= 3; ++period) {
    LearnerBank::Changed watched, right, wrong;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_right = i < 2 || period == 1;
      shared[i].watch(shown, period, &watched);
      shared[i].hear_feedback(is_right, shown, period, is_right ? &right : &wrong);
      alone[i].watch(shown, period);
      alone[i].hear_feedback(is_right, shown, period);
    }
  }
  EXPECT_TRUE(shared == alone);
  EXPECT_EQ(&shared[0].belief(0), &shared[1].belief(0));
  EXPECT_NE(&shared[0].belief(0), &shared[2].belief(0));
  EXPECT_TRUE(fresh == bank());
}

TEST_F(LearnerBankTest, BeginsWithThePriorOverHypotheses) {
  auto hypotheses = grid_of_hypotheses();
  hypotheses.front().probability = 12.0;
  const auto one = bank(hypotheses);
  EXPECT_NEAR(one.weights().front(), 12.0 / 23.0, 1e-12);
  EXPECT_NEAR(bank().expected_ability(), 0.77, 1e-12);
  EXPECT_NEAR(bank().ability_quantile(0.5), 0.77, 1e-9);
  EXPECT_NEAR(bank().probability_of_ability(0.77), 0.5, 1e-9);
}

TEST_F(LearnerBankTest, TakesPeopleWhoAnswerRightForAbleOnes) {
  const auto able = after(3, true);
  const auto unable = after(3, false);
  EXPECT_GT(able.expected_ability(), bank().expected_ability() + 0.01);
  EXPECT_LT(unable.expected_ability(), bank().expected_ability());
  EXPECT_LT(unable.expected_ability(), able.expected_ability() - 0.02);
  EXPECT_NEAR(std::accumulate(able.weights().begin(), able.weights().end(), 0.0), 1.0, 1e-12);
  EXPECT_LT(able.ability_quantile(0.1), able.ability_quantile(0.9));
}

TEST_F(LearnerBankTest, WeighsPathsThatAreBestForNobodyByTheirVerdicts) {
  auto one = bank();
  const auto asked = tests();
  const auto shown = item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[0].constraints);
  one.begin_component();
  one.watch(shown, 1);
  // A long detour, and what a wrong answer of somebody else shows.
  auto detour = item_delivery().feature_counts(asked.front().start);
  detour[2] += 40;
  const HalfSpace verdict{-asked.front().covered.front().normal()};
  const std::vector<kith::Test> test{asked.front()};
  const std::vector<Answer> answers{detour};
  const std::vector verdicts{Verdict{.half_spaces = {verdict}}};
  const auto by_verdict = ratings_of(one, AnswerFit{item_delivery(), test, answers, verdicts});
  const auto silent = ratings_of(one, AnswerFit{item_delivery(), test, answers, std::vector{Verdict{}}});
  const double slip =
      AnswerFit::slip() / (static_cast<double>(item_delivery().tables().coverage_set(test.front().start).size()) + 1.0);
  for (std::size_t h = 0; h < by_verdict.size(); ++h) {
    EXPECT_GT(by_verdict[h].likelihood, 0.1 * slip);
    EXPECT_LT(by_verdict[h].likelihood, slip);
    EXPECT_NEAR(silent[h].likelihood, slip, 1e-12) << "nobody takes it but by a slip";
  }
  EXPECT_GT(by_verdict.front().likelihood, by_verdict.back().likelihood) << "who learns less is more often wrong";
}

TEST_F(LearnerBankTest, BelievesThatAblePeopleLearnMore) {
  const auto one = after(2, true);
  const auto region = item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[0].constraints);
  EXPECT_LT(one.belief(0).mass_in(region), one.belief(11).mass_in(region));
  EXPECT_GT(one.mass_in(region), one.belief(0).mass_in(region));
}

TEST_F(LearnerBankTest, ForgetsGainsWhenAComponentBegins) {
  auto one = after(3, false);
  EXPECT_GT(one.as_members(false)[0].shown_ability, 0.7);
  EXPECT_DOUBLE_EQ(one.as_members(true)[0].shown_ability, 0.62);
}

// Such answers are slips under every hypothesis about people who learn. Once they told nothing, so that lessons alone
// counted.
TEST_F(LearnerBankTest, TakesPathsThatAreBestForNobodyForGuesses) {
  auto one = bank();
  const auto asked = tests();
  std::vector<Answer> detours;
  for (const auto& test : asked) {
    auto detour = item_delivery().feature_counts(test.start);
    detour[2] += 40;
    detours.emplace_back(detour);
  }
  const std::vector<Verdict> verdicts(asked.size());
  const auto shown = item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[0].constraints);
  one.begin_component();
  double before = one.mass_in(shown);
  for (std::size_t period = 1; period <= 3; ++period) {
    one.watch(shown, period);
    one.see_answers(AnswerFit{item_delivery(), asked, detours, verdicts});
    one.hear_feedback(false, shown, period);
  }
  EXPECT_LT(one.probability_of_learning(), 0.01);
  EXPECT_LT(one.odds_of_learning(), 1.0);
  EXPECT_LT(one.mass_in(shown), before);
}

TEST_F(LearnerBankTest, SeesThatLessonsReachPeopleWhoAnswerRight) {
  EXPECT_NEAR(bank().probability_of_learning(), 0.9, 1e-12);
  EXPECT_NEAR(bank().odds_of_learning(), 1.0, 1e-12);
  EXPECT_GT(after(3, true).odds_of_learning(), 5.0);
  EXPECT_GT(after(3, true).probability_of_learning(), bank().probability_of_learning());
  EXPECT_LT(after(3, false).probability_of_learning(), after(3, true).probability_of_learning());
}

// Answers weigh nothing if there is one hypothesis: a teacher who learns nothing about anybody.
TEST_F(LearnerBankTest, TakesEverybodyForALearnerIfThereIsOneHypothesis) {
  const auto one = bank(one_hypothesis());
  EXPECT_EQ(one.probability_of_learning(), 1.0);
  EXPECT_TRUE(std::isinf(one.odds_of_learning()));
}

// The laws of probability: likelihoods of all possible sets of answers sum to 1, and so does each distribution of the
// number of right answers, which agrees with the answers it counts.
TEST_F(LearnerBankTest, ExpectsAnswersWithProbabilitiesThatSumToOne) {
  auto one = after(1, true);
  const auto all = tests();
  const std::vector<kith::Test> asked(all.begin(), all.begin() + std::min<std::ptrdiff_t>(2, std::ssize(all)));
  std::vector<std::vector<Answer>> sets{{}};
  for (const auto& test : asked) {
    std::vector<std::vector<Answer>> longer;
    auto paths = item_delivery().tables().coverage_set(test.start);
    auto detour = item_delivery().feature_counts(test.start);
    detour[2] += 40;
    paths.push_back(detour);
    for (const auto& set : sets) {
      for (const auto& path : paths) {
        longer.push_back(set);
        longer.back().emplace_back(path);
      }
    }
    sets = std::move(longer);
  }
  double sensible = 0.0, any = 0.0;
  std::vector<double> sums(one.hypotheses().size(), 0.0);
  for (const auto& set : sets) {
    std::vector<Verdict> verdicts;
    for (std::size_t t = 0; t < set.size(); ++t) {
      verdicts.push_back({.correct = *set[t] == item_delivery().feature_counts(asked[t].start), .half_spaces = {}});
    }
    const AnswerFit fit{item_delivery(), asked, set, verdicts};
    sensible += fit.of(AnswerFit::Guess::kSensible).likelihood;
    any += fit.of(AnswerFit::Guess::kAny).likelihood;
    const auto ratings = ratings_of(one, fit);
    for (std::size_t h = 0; h < ratings.size(); ++h) {
      sums[h] += ratings[h].likelihood;
      ASSERT_EQ(ratings[h].right.size(), asked.size() + 1);
      EXPECT_NEAR(std::accumulate(ratings[h].right.begin(), ratings[h].right.end(), 0.0), 1.0, 1e-9);
    }
  }
  EXPECT_NEAR(sensible, 1.0, 1e-9);
  EXPECT_NEAR(any, 1.0, 1e-9);
  for (const double sum : sums) EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST_F(LearnerBankTest, RefusesImpossibleHypotheses) {
  EXPECT_THROW(bank({}), std::invalid_argument);
  EXPECT_THROW(bank({{.ability = 0.4}}), std::invalid_argument);
  EXPECT_THROW(bank({{.probability = 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
