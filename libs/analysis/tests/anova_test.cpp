#include "kith/analysis/anova.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

using testing::kCrossed;
using Terms = std::vector<std::vector<std::size_t>>;

Factor factor_with(std::string name, std::size_t num_levels, std::vector<std::size_t> codes) {
  Factor factor{std::move(name), {}, std::move(codes)};
  for (std::size_t level = 0; level < num_levels; ++level) factor.levels.push_back("L" + std::to_string(level));
  return factor;
}

struct Design {
  std::vector<Factor> factors;
  std::vector<double> response;
};

// Two crossed factors with count(i, j) observations in cell (i, j), of normal noise with an effect of the first.
template <typename Count>
Design make_design(std::size_t rows, std::size_t columns, Count count, std::uint64_t seed) {
  RandomStream random{seed};
  std::vector<std::size_t> a;
  std::vector<std::size_t> b;
  Design design;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      for (std::size_t k = 0; k < count(i, j); ++k) {
        a.push_back(i);
        b.push_back(j);
        design.response.push_back(standard_normal(random) + 0.5 * static_cast<double>(i));
      }
    }
  }
  design.factors = {factor_with("a", rows, a), factor_with("b", columns, b)};
  return design;
}

Design balanced_design(std::uint64_t seed) {
  return make_design(
      3, 4, [](auto, auto) { return 5u; }, seed);
}
Design unbalanced_design(std::uint64_t seed) {
  return make_design(
      3, 4, [](auto i, auto j) { return 1 + (2 * i + 3 * j) % 5; }, seed);
}

void expect_relative(double actual, double expected, double tolerance = 1e-10) {
  EXPECT_NEAR(actual, expected, tolerance * std::abs(expected));
}

TEST(Anova, SumsOfSquaresAddUpWhenBalanced) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto design = balanced_design(seed);
    const auto table = anova(design.response, design.factors, kCrossed);
    double mean = 0.0;
    for (const double y : design.response) mean += y / static_cast<double>(design.response.size());
    double total = 0.0;
    for (const double y : design.response) total += (y - mean) * (y - mean);
    double sum = table.residual_sum_of_squares;
    for (const auto& term : table.terms) sum += term.sum_of_squares;
    expect_relative(sum, total);
  }
}

TEST(Anova, FIsTheSameForEveryAffineImageOfTheResponse) {
  const auto design = balanced_design(3);
  const auto table = anova(design.response, design.factors, kCrossed);
  for (const double scale : {-3.0, 1e-150, 1e150, 1e300, 1e-300}) {
    for (const double offset : {0.0, 2.0, -1e3}) {
      auto image = design.response;
      for (auto& y : image) y = scale * (y + offset);
      const auto other = anova(image, design.factors, kCrossed);
      for (std::size_t t = 0; t < 3; ++t) {
        expect_relative(other.terms[t].test->statistic, table.terms[t].test->statistic, 1e-9);
        expect_relative(*other.terms[t].partial_eta_squared, *table.terms[t].partial_eta_squared, 1e-9);
      }
    }
  }
}

TEST(Anova, OrderOfObservationsAndNamesOfLevelsDoNotMatter) {
  const auto design = balanced_design(4);
  const auto table = anova(design.response, design.factors, kCrossed);
  auto turned = design;
  std::reverse(turned.response.begin(), turned.response.end());
  for (auto& factor : turned.factors) {
    std::reverse(factor.codes.begin(), factor.codes.end());
    for (auto& code : factor.codes) code = factor.levels.size() - 1 - code;
  }
  const auto other = anova(turned.response, turned.factors, kCrossed);
  for (std::size_t t = 0; t < 3; ++t) expect_relative(other.terms[t].test->statistic, table.terms[t].test->statistic);
}

TEST(Anova, LevelsAndFactorsThatNobodyHasOrNamesChangeNothing) {
  const auto design = balanced_design(5);
  const auto table = anova(design.response, design.factors, kCrossed);
  auto more = design;
  more.factors[0].levels.insert(more.factors[0].levels.begin(), "nobody's");
  for (auto& code : more.factors[0].codes) ++code;
  more.factors.push_back(factor_with("unnamed", 2, std::vector<std::size_t>(design.response.size(), 1)));
  const auto other = anova(more.response, more.factors, kCrossed);
  EXPECT_EQ(other.residual_df, table.residual_df);
  for (std::size_t t = 0; t < 3; ++t) expect_relative(other.terms[t].test->statistic, table.terms[t].test->statistic);
}

TEST(Anova, OneFactorIsTheOneWayTest) {
  const auto design = unbalanced_design(6);
  const auto table = anova(design.response, std::vector{design.factors[0]}, Terms{{0}});
  const auto test = one_way_anova(design.response, design.factors[0]);
  expect_relative(table.terms[0].test->statistic, test->statistic);
  expect_relative(table.terms[0].test->p, test->p);
}

TEST(Anova, ResidualsAreOrthogonalToTheModelAndHaveItsSumOfSquares) {
  const auto design = balanced_design(7);
  const auto table = anova(design.response, design.factors, Terms{{0}, {1}});
  double squares = 0.0;
  std::vector<double> sums(3, 0.0);
  for (std::size_t i = 0; i < table.residuals.size(); ++i) {
    squares += table.residuals[i] * table.residuals[i];
    sums[design.factors[0].codes[i]] += table.residuals[i];
  }
  expect_relative(squares, table.residual_sum_of_squares);
  for (const double sum : sums) EXPECT_NEAR(sum, 0.0, 1e-12);
}

TEST(Anova, RefusesUnbalancedCellsOfSeveralFactors) {
  const auto design = unbalanced_design(8);
  const auto table = anova(design.response, design.factors, Terms{{0}, {1}});
  EXPECT_THAT(table.terms[1].test.reason(), ::testing::HasSubstr("the design is unbalanced"));
  EXPECT_EQ(table.effects.reason(), table.terms[1].test.reason());
  EXPECT_EQ(table.terms[1].name, "b");
}

// The same from formulas for a 2 x 2 table, by hand: cell means 1, 3, 2, 8; spread 1 around each.
TEST(Anova, AHandComputedTable) {
  const std::vector<double> response{0, 2, 2, 4, 1, 3, 7, 9};
  const std::vector<Factor> factors{factor_with("a", 2, {0, 0, 0, 0, 1, 1, 1, 1}),
                                    factor_with("b", 2, {0, 0, 1, 1, 0, 0, 1, 1})};
  const auto table = anova(response, factors, kCrossed);
  EXPECT_DOUBLE_EQ(table.terms[0].sum_of_squares, 18.0);
  EXPECT_DOUBLE_EQ(table.terms[1].sum_of_squares, 32.0);
  EXPECT_DOUBLE_EQ(table.terms[2].sum_of_squares, 8.0);
  EXPECT_DOUBLE_EQ(table.residual_sum_of_squares, 8.0);
  EXPECT_EQ(table.residual_df, 4u);
  EXPECT_DOUBLE_EQ(table.terms[0].test->statistic, 9.0);
  EXPECT_DOUBLE_EQ(*table.terms[2].partial_eta_squared, 0.5);
  EXPECT_EQ(table.terms[2].name, "a:b");
}

std::string reason_of_first(const Design& design, const Terms& terms = kCrossed) {
  const auto table = anova(design.response, design.factors, terms);
  EXPECT_EQ(table.terms[0].test.reason(), table.terms[0].partial_eta_squared.reason());
  return table.terms[0].test.reason();
}

TEST(Anova, SaysWhyNothingCanBeEstimated) {
  auto design = balanced_design(9);
  for (std::size_t i = 0; i < design.response.size(); ++i)
    design.response[i] = 0.1 * static_cast<double>(design.factors[0].codes[i]);
  EXPECT_EQ(reason_of_first(design), "no spread within the cells");
  EXPECT_EQ(reason_of_first(design, {{0}, {1}}), "no spread around the model's values");
  design.response.assign(design.response.size(), 0.1);
  EXPECT_EQ(reason_of_first(design), "no spread within the cells");

  const auto single = make_design(
      3, 4, [](auto, auto) { return 1u; }, 10);
  EXPECT_THAT(reason_of_first(single), ::testing::HasSubstr("no residual degrees of freedom"));
  EXPECT_EQ(reason_of_first(single, {{0}, {1}}), "");

  const auto one_level = make_design(
      1, 4, [](auto, auto) { return 3u; }, 11);
  EXPECT_EQ(reason_of_first(one_level), "only one level of 'a' has observations");

  const auto nested = make_design(
      2, 2, [](auto i, auto j) { return i == j ? 3u : 0u; }, 12);
  EXPECT_THAT(reason_of_first(nested), ::testing::HasSubstr("combinations of levels have no observations"));

  EXPECT_EQ(reason_of_first({{factor_with("a", 2, {})}, {}}, {{0}}), "no observations");
}

// Means of 0.1 and 0.3, computed in different ways, are equal but for the last bit.
TEST(Anova, TakesRoundingErrorsForNoSpread) {
  const Design design{{factor_with("a", 2, {0, 0, 0, 1, 1, 1})}, {0.1 + 0.2, 0.3, 0.3, 0.7 + 0.1, 0.8, 1.0 - 0.2}};
  EXPECT_EQ(reason_of_first(design, {{0}}), "no spread within the cells");
  Design far = design;
  for (std::size_t i = 0; i < far.response.size(); ++i) far.response[i] += 1e8 + 1e-8 * static_cast<double>(i % 2);
  EXPECT_EQ(reason_of_first(far, {{0}}), "no spread within the cells");
}

TEST(Anova, RefusesBrokenPreconditions) {
  const auto design = balanced_design(13);
  auto response = design.response;
  EXPECT_THROW((void)anova(response, design.factors, Terms{{2}}), std::invalid_argument);
  EXPECT_THROW((void)anova(response, design.factors, Terms{{}}), std::invalid_argument);
  response.pop_back();
  EXPECT_THROW((void)anova(response, design.factors, kCrossed), std::invalid_argument);
  response.push_back(std::numeric_limits<double>::infinity());
  EXPECT_THROW((void)anova(response, design.factors, kCrossed), std::invalid_argument);
  EXPECT_THROW((void)anova(std::vector<double>{1, 2}, std::vector{factor_with("a", 2, {0, 2})}, Terms{{0}}),
               std::invalid_argument);
}

// Under the null hypothesis p is uniform: of 400 tests, 20 +- 4.4 are below 0.05.
TEST(Anova, RejectsATrueHypothesisAsOftenAsStated) {
  int rejected = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const auto design = balanced_design(1000 + seed);
    const auto table = anova(design.response, design.factors, kCrossed);
    rejected += table.terms[1].test->p < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(rejected, 20, 4 * 4.4);
}

// y: three blocks under two levels; differences 1, 2, 3, so t = 2 / (1 / sqrt(3)), F = t^2 = 12.
TEST(BlockedAnova, OfTwoLevelsIsThePairedTest) {
  const std::vector<double> response{10, 11, 20, 22, 5, 8};
  const auto within = factor_with("w", 2, {0, 1, 0, 1, 0, 1});
  const auto between = factor_with("g", 1, std::vector<std::size_t>(6, 0));
  const auto table = blocked_anova(response, within, between, factor_with("block", 3, {0, 0, 1, 1, 2, 2}));
  ASSERT_TRUE(table) << table.reason();
  EXPECT_NEAR(table->terms[0].test->statistic, 12.0, 1e-12);
  EXPECT_EQ(table->residual_df, 2u);
  EXPECT_EQ(table->terms[1].test.reason(), "only one level of 'g' has observations");
}

TEST(BlockedAnova, SaysWhatIsWrongWithTheBlocks) {
  const std::vector<double> response{1, 2, 3, 5};
  const auto one_group = factor_with("g", 1, {0, 0, 0, 0});
  const auto within = factor_with("w", 2, {0, 1, 0, 1});
  const auto reason = [&](const Factor& w, const Factor& g, const Factor& block) {
    return blocked_anova(response, w, g, block).reason();
  };
  EXPECT_EQ(reason(within, one_group, factor_with("b", 2, {0, 0, 0, 1})),
            "block 'L0' has level 'L0' of 'w' more than once");
  EXPECT_EQ(reason(within, one_group, factor_with("b", 3, {0, 0, 1, 2})), "block 'L1' lacks level 'L1' of 'w'");
  EXPECT_EQ(reason(within, factor_with("g", 2, {0, 1, 0, 0}), factor_with("b", 2, {0, 0, 1, 1})),
            "block 'L0' has more than one level of 'g'");
  EXPECT_EQ(reason(factor_with("w", 2, {1, 1, 1, 1}), one_group, factor_with("b", 4, {0, 1, 2, 3})),
            "only one level of 'w' has observations");
  const auto groups =
      blocked_anova(response, within, factor_with("g", 2, {0, 0, 1, 1}), factor_with("b", 2, {0, 0, 1, 1}));
  EXPECT_THAT(groups->terms[0].test.reason(), ::testing::HasSubstr("no residual degrees of freedom"));
}

TEST(Normality, HandComputedMoments) {
  // 0, 0, 0, 4: mean 1, m2 = 3, m3 = 6, m4 = 21.
  const auto check = check_normality(std::vector<double>{0, 0, 0, 4});
  ASSERT_TRUE(check);
  EXPECT_NEAR(check->skewness, 6.0 / std::pow(3.0, 1.5), 1e-12);
  EXPECT_NEAR(check->excess_kurtosis, 21.0 / 9.0 - 3.0, 1e-12);
  const double statistic = 4.0 / 6.0 * (4.0 / 3.0 + 1.0 / 9.0);
  EXPECT_NEAR(check->test.statistic, statistic, 1e-12);
  EXPECT_NEAR(check->test.p, std::exp(-statistic / 2.0), 1e-12);  // chi-squared of two degrees of freedom
}

TEST(Normality, IsSeenInNormalNumbersAndNotInExponentialOnes) {
  RandomStream random{5};
  std::vector<double> normal(500);
  std::vector<double> exponential(500);
  for (auto& value : normal) value = standard_normal(random);
  for (auto& value : exponential) value = -std::log(1.0 - uniform01(random));
  EXPECT_GT(check_normality(normal)->test.p, 0.01);
  EXPECT_LT(check_normality(exponential)->test.p, 1e-6);
  EXPECT_EQ(check_normality(std::vector<double>(9, 0.3)).reason(), "all residuals are equal");
  EXPECT_EQ(check_normality(std::vector<double>{1, 2}).reason(), "fewer than three residuals");
}

}  // namespace
}  // namespace kith
