#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "kith/random/distributions.hpp"
#include "kith/stats/resampling.hpp"

namespace kith {
namespace {

using Terms = std::vector<std::vector<std::size_t>>;
const Terms kOneWay{{0}};
const Terms kTwoWay{{0}, {1}, {0, 1}};

RandomStream stream(std::uint64_t seed) { return RandomStream{seed}.split("permutation_anova_test"); }

// The share of permutations with F* >= F, without the one that is the data.
double share(double p, std::size_t permutations) {
  const auto n = static_cast<double>(permutations);
  return (p * (n + 1.0) - 1.0) / n;
}

// Four standard deviations of the share of `permutations` draws that happen with probability p; one draw if p is 0
// or 1.
double monte_carlo_bound(double p, std::size_t permutations) {
  return 4.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(permutations)) + 1e-12;
}

// p over all orders of the residuals of the model without the term, by the definition: add them to what that
// model fits, and analyse anew.
double exact_p(const std::vector<double>& response, const std::vector<Factor>& factors, const Terms& terms,
               const Terms& reduced, std::size_t term, SumsOfSquares type) {
  const auto residuals = anova(response, factors, reduced, type).residuals;
  const double f = anova(response, factors, terms, type).terms[term].test->statistic;
  std::vector<std::size_t> order(response.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double at_least = 0.0;
  double all = 0.0;
  do {
    auto permuted = response;
    for (std::size_t i = 0; i < order.size(); ++i) permuted[i] += residuals[order[i]] - residuals[i];
    const auto table = anova(permuted, factors, terms, type);
    if (!table.terms[term].test || table.terms[term].test->statistic >= f * (1.0 - 1e-9)) at_least += 1.0;
    all += 1.0;
  } while (std::ranges::next_permutation(order).found);
  return at_least / all;
}

TEST(PermutationAnova, OfOneFactorConvergesToTheExactP) {
  constexpr std::size_t kPermutations = 5000;
  const Factor balanced{"f", {"a", "b", "c"}, {0, 0, 1, 1, 2, 2}};
  const Factor unbalanced{"f", {"a", "b"}, {0, 0, 1, 1, 1, 1}};
  const std::vector<std::vector<double>> responses{{1, 2, 4, 3, 9, 7}, {5, 1, 1, 2, 5, 2}, {-3, 0.5, 8, 9, 7, 30}};
  for (const auto& factor : {balanced, unbalanced}) {
    for (const auto& response : responses) {
      const auto table =
          permutation_anova(response, std::vector{factor}, kOneWay, SumsOfSquares::kTypeII, kPermutations, stream(1));
      const double expected = exact_p(response, {factor}, kOneWay, {}, 0, SumsOfSquares::kTypeII);
      EXPECT_NEAR(share(table.terms[0].test->p, kPermutations), expected, monte_carlo_bound(expected, kPermutations));
    }
  }
}

TEST(PermutationAnova, ShufflesTheResidualsOfTheModelWithoutTheTerm) {
  constexpr std::size_t kPermutations = 5000;
  const std::vector<Factor> factors{{"a", {"1", "2"}, {0, 0, 0, 1, 1, 1}}, {"b", {"1", "2"}, {0, 0, 1, 0, 1, 1}}};
  const std::vector<double> response{1.3, 0.2, 4.1, 2.9, 3.3, 2.2};
  const auto expect_p = [&](SumsOfSquares type, std::size_t term, const Terms& reduced) {
    const auto table = permutation_anova(response, factors, kTwoWay, type, kPermutations, stream(2));
    const double expected = exact_p(response, factors, kTwoWay, reduced, term, type);
    EXPECT_NEAR(share(table.terms[term].test->p, kPermutations), expected, monte_carlo_bound(expected, kPermutations));
  };
  expect_p(SumsOfSquares::kTypeII, 0, {{1}});
  expect_p(SumsOfSquares::kTypeII, 1, {{0}});
  expect_p(SumsOfSquares::kTypeII, 2, {{0}, {1}});
  expect_p(SumsOfSquares::kTypeIII, 2, {{0}, {1}});
}

// A main effect without its interaction (type III), where sum-to-zero contrasts matter: the residuals are those of the
// regression on b and a:b with codes -1 and 1, here by hand for one observation per cell and one more.
TEST(PermutationAnova, KeepsTheInteractionUnderTypeIII) {
  constexpr std::size_t kPermutations = 5000;
  const std::vector<Factor> factors{{"a", {"1", "2"}, {0, 0, 1, 1, 0, 0, 1, 1}},
                                    {"b", {"1", "2"}, {0, 1, 0, 1, 0, 1, 0, 1}}};
  const std::vector<double> response{0.0, 9.0, 9.5, 1.0, 1.2, 10.3, 11.7, 3.1};
  // In a balanced design contrasts are orthogonal: taking out b and a:b leaves a and the residuals.
  const auto with_all = anova(response, factors, kTwoWay, SumsOfSquares::kTypeIII).residuals;
  double effect = 0.0;
  for (std::size_t i = 0; i < 8; ++i) effect += (factors[0].codes[i] == 0 ? 1.0 : -1.0) * response[i] / 8.0;
  auto residuals = with_all;
  for (std::size_t i = 0; i < 8; ++i) residuals[i] += factors[0].codes[i] == 0 ? effect : -effect;
  const auto table = permutation_anova(response, factors, kTwoWay, SumsOfSquares::kTypeIII, kPermutations, stream(3));
  // The same F on these residuals alone, with shuffles of their own: both shares vary.
  const auto alone = permutation_anova(residuals, factors, kTwoWay, SumsOfSquares::kTypeIII, kPermutations, stream(4));
  EXPECT_NEAR(alone.terms[0].test->statistic, table.terms[0].test->statistic, 1e-9);
  const double p = alone.terms[0].test->p;
  EXPECT_NEAR(table.terms[0].test->p, p, std::sqrt(2.0) * monte_carlo_bound(p, kPermutations));
}

std::vector<Factor> design(std::size_t observations) {
  std::vector<Factor> factors{{"a", {"1", "2"}, {}}, {"b", {"1", "2", "3"}, {}}};
  for (std::size_t i = 0; i < observations; ++i) {
    factors[0].codes.push_back(i % 2);
    factors[1].codes.push_back(i / 2 % 7 % 3);  // the first level three times in seven
  }
  return factors;
}

// Of 300 data sets without effects, with skewed noise, the shares of p <= 0.05, 0.1, ..., 0.95 differ from these levels
// by at most four standard deviations, 4 sqrt(level (1 - level) / 300).
TEST(PermutationAnova, HasUniformPUnderTheNull) {
  constexpr std::size_t kRounds = 300;
  const auto factors = design(28);
  for (const auto type : {SumsOfSquares::kTypeII, SumsOfSquares::kTypeIII}) {
    std::vector<std::vector<double>> p_of(3);
    for (std::size_t round = 0; round < kRounds; ++round) {
      auto random = stream(5).split(round);
      std::vector<double> response;
      for (std::size_t i = 0; i < 28; ++i) response.push_back(-std::log1p(-uniform01(random)));
      const auto table = permutation_anova(response, factors, kTwoWay, type, 99, random.split("permutations"));
      for (std::size_t t = 0; t < 3; ++t) p_of[t].push_back(table.terms[t].test->p);
    }
    for (const auto& ps : p_of) {
      for (int percent = 5; percent < 100; percent += 5) {
        const double level = percent / 100.0;
        const auto below = std::ranges::count_if(ps, [&](double p) { return p <= level + 1e-9; });
        EXPECT_NEAR(static_cast<double>(below) / kRounds, level, monte_carlo_bound(level, kRounds)) << percent;
      }
    }
  }
}

// For normal data both p-values estimate the same chance; the permutation distribution of 150 residuals differs from F
// by less than 0.01, and 1999 permutations by their Monte Carlo bound.
TEST(PermutationAnova, AgreesWithFForNormalData) {
  constexpr std::size_t kPermutations = 1999;
  const auto factors = design(150);
  for (std::uint64_t round = 0; round < 6; ++round) {
    auto random = stream(6).split(round);
    std::vector<double> response;
    for (std::size_t i = 0; i < 150; ++i)
      response.push_back(standard_normal(random) + 0.15 * static_cast<double>(factors[1].codes[i]));
    const auto type = round % 2 == 0 ? SumsOfSquares::kTypeII : SumsOfSquares::kTypeIII;
    const auto by_f = anova(response, factors, kTwoWay, type);
    const auto table = permutation_anova(response, factors, kTwoWay, type, kPermutations, random.split("shuffles"));
    for (std::size_t t = 0; t < 3; ++t) {
      const double p = by_f.terms[t].test->p;
      EXPECT_NEAR(table.terms[t].test->p, p, monte_carlo_bound(p, kPermutations) + 0.01);
    }
  }
}

TEST(PermutationAnova, ChangesNothingOfTheTableButP) {
  const auto factors = design(30);
  std::vector<double> response(30);
  auto random = stream(7);
  for (auto& value : response) value = uniform01(random);
  const auto by_f = anova(response, factors, kTwoWay, SumsOfSquares::kTypeII);
  const auto table = permutation_anova(response, factors, kTwoWay, SumsOfSquares::kTypeII, 19, stream(8));
  EXPECT_EQ(table.residuals, by_f.residuals);
  EXPECT_EQ(table.residual_df, by_f.residual_df);
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_EQ(table.terms[t].name, by_f.terms[t].name);
    EXPECT_EQ(table.terms[t].sum_of_squares, by_f.terms[t].sum_of_squares);
    EXPECT_EQ(table.terms[t].test->statistic, by_f.terms[t].test->statistic);
    EXPECT_EQ(table.terms[t].test->df, by_f.terms[t].test->df);
    const double twentieths = table.terms[t].test->p * 20.0;
    EXPECT_NEAR(twentieths, std::round(twentieths), 1e-9);
    EXPECT_GE(twentieths, 1.0 - 1e-9);
  }
}

TEST(PermutationAnova, DependsOnNothingButTheStreamAndTheShapeOfTheData) {
  const auto factors = design(30);
  auto random = stream(9);
  std::vector<double> response(30);
  for (auto& value : response) value = standard_normal(random);
  auto scaled = response;
  for (auto& value : scaled) value = std::ldexp(value, 400);
  const auto ps = [&](const std::vector<double>& values, std::uint64_t seed) {
    std::vector<double> result;
    for (const auto& term :
         permutation_anova(values, factors, kTwoWay, SumsOfSquares::kTypeIII, 199, stream(seed)).terms)
      result.push_back(term.test->p);
    return result;
  };
  EXPECT_EQ(ps(response, 10), ps(response, 10));
  EXPECT_EQ(ps(response, 10), ps(scaled, 10));
  EXPECT_NE(ps(response, 10), ps(response, 11));
}

TEST(PermutationAnova, SaysWhyATermCannotBeTested) {
  auto factors = design(30);
  std::ranges::fill(factors[0].codes, 1);
  std::vector<double> response(30);
  std::iota(response.begin(), response.end(), 0.0);
  const auto by_f = anova(response, factors, kTwoWay, SumsOfSquares::kTypeII);
  const auto table = permutation_anova(response, factors, kTwoWay, SumsOfSquares::kTypeII, 19, stream(12));
  EXPECT_FALSE(table.terms[0].test);
  EXPECT_EQ(table.terms[0].test.reason(), by_f.terms[0].test.reason());
  EXPECT_TRUE(table.terms[1].test);
  const auto empty = permutation_anova({}, {}, {}, SumsOfSquares::kTypeII, 1, stream(13));
  EXPECT_TRUE(empty.terms.empty());
}

TEST(PermutationAnova, NamesWhatItCannotTake) {
  const auto factors = design(4);
  EXPECT_THROW(
      (void)permutation_anova(std::vector<double>{1, 2, 3, 4}, factors, kTwoWay, SumsOfSquares::kTypeII, 0, stream(14)),
      std::invalid_argument);
  EXPECT_THROW(
      (void)permutation_anova(std::vector<double>{1, 2, 3}, factors, kTwoWay, SumsOfSquares::kTypeII, 9, stream(14)),
      std::invalid_argument);
}

}  // namespace
}  // namespace kith
