#include "kith/analysis/tests.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace kith {
namespace {

const Factor kThree{"g", {"x", "y", "z"}, {0, 0, 1, 1, 2, 2}};

TEST(MidRanks, TiesGetTheirMeanRank) {
  EXPECT_THAT(mid_ranks(std::vector<double>{3, 1, 3, 2, 3}), ::testing::ElementsAre(4, 1, 4, 2, 4));
  EXPECT_TRUE(mid_ranks({}).empty());
}

// Group means 1, 2, 6 with squares of 2 each: between 2 (4 + 1 + 9) = 28, F = (28 / 2) / (6 / 3).
TEST(OneWay, AHandComputedF) {
  const auto test = one_way_anova(std::vector<double>{0, 2, 1, 3, 5, 7}, kThree);
  ASSERT_TRUE(test);
  EXPECT_NEAR(test->statistic, 7.0, 1e-13);
  EXPECT_THAT(test->df, ::testing::ElementsAre(2, 3));
}

TEST(OneWay, SaysWhyNothingCanBeTested) {
  EXPECT_EQ(one_way_anova(std::vector<double>{1, 1, 2, 2, 3, 3}, kThree).reason(), "no spread within the groups");
  EXPECT_EQ(one_way_anova(std::vector<double>{1, 2}, Factor{"g", {"x", "y"}, {0, 1}}).reason(),
            "no residual degrees of freedom: one observation per group");
  EXPECT_EQ(one_way_anova(std::vector<double>{1, 2}, Factor{"g", {"x", "y"}, {0, 0}}).reason(),
            "fewer than two groups have observations");
  EXPECT_EQ(one_way_anova({}, Factor{"g", {}, {}}).reason(), "fewer than two groups have observations");
}

TEST(OneWay, OfTwoGroupsIsTheSquareOfStudentsT) {
  const std::vector<double> a{1, 4, 2, 8};
  const std::vector<double> b{3, 9, 7, 7};
  std::vector<double> both = a;
  both.insert(both.end(), b.begin(), b.end());
  const auto f = one_way_anova(both, Factor{"g", {"a", "b"}, {0, 0, 0, 0, 1, 1, 1, 1}});
  // With equal sizes Welch's t is Student's.
  EXPECT_NEAR(f->statistic, std::pow(welch_t_test(a, b)->test.statistic, 2.0), 1e-12);
}

TEST(Welch, SaysWhichGroupHasNoSpread) {
  EXPECT_EQ(welch_anova(std::vector<double>{1, 2, 2, 2, 3, 4}, kThree).reason(), "no spread within group 'y'");
  EXPECT_EQ(welch_anova(std::vector<double>{1, 2, 3}, Factor{"g", {"x", "y"}, {0, 0, 1}}).reason(),
            "group 'y' has one observation only");
}

TEST(Welch, OfTwoGroupsIsTheSquareOfWelchsT) {
  const std::vector<double> a{1, 4, 2, 8, 3};
  const std::vector<double> b{3, 29, 7};
  std::vector<double> both = a;
  both.insert(both.end(), b.begin(), b.end());
  const auto f = welch_anova(both, Factor{"g", {"a", "b"}, {0, 0, 0, 0, 0, 1, 1, 1}});
  const auto t = welch_t_test(a, b);
  EXPECT_NEAR(f->statistic, std::pow(t->test.statistic, 2.0), 1e-12);
  EXPECT_NEAR(f->df.at(1), t->test.df.at(0), 1e-10);
  EXPECT_NEAR(f->p, t->test.p, 1e-12);
}

// Ranks 1, 2 | 3, 4 | 5, 6: H = 12 / 42 * (9 + 49 + 121) / 2 - 21 = 32 / 7.
TEST(KruskalWallis, AHandComputedH) {
  const auto test = kruskal_wallis(std::vector<double>{1, 2, 30, 40, 500, 600}, kThree);
  EXPECT_NEAR(test->statistic, 32.0 / 7.0, 1e-13);
  EXPECT_NEAR(test->p, std::exp(-16.0 / 7.0), 1e-13);
}

TEST(KruskalWallis, DependsOnRanksOnly) {
  const auto test = kruskal_wallis(std::vector<double>{1, 7, 3, 4, 4, 6}, kThree);
  const auto other = kruskal_wallis(std::vector<double>{-1e300, 1e300, 0, 1e-300, 1e-300, 1}, kThree);
  EXPECT_EQ(test->statistic, other->statistic);
  EXPECT_EQ(kruskal_wallis(std::vector<double>(6, 2.5), kThree).reason(), "all values are equal");
}

TEST(BrownForsythe, SaysWhyNothingCanBeTested) {
  EXPECT_EQ(brown_forsythe(std::vector<double>{1, 3, 2, 6, 3, 9}, kThree).reason(),
            "within each group all values are equally far from the median");
  EXPECT_EQ(brown_forsythe(std::vector<double>{1, 1, 2, 2, 3, 3}, kThree).reason(), "no spread within the groups");
}

TEST(BrownForsythe, SeesUnequalSpread) {
  const Factor two{"g", {"x", "y"}, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}};
  const std::vector<double> values{1, 2, 3, 4, 5, 6, 10, 20, 30, 40, 50, 60};
  EXPECT_LT(brown_forsythe(values, two)->p, 0.01);
}

TEST(WelchT, IntervalHoldsZeroIffNotSignificant) {
  const std::vector<double> a{1, 2, 3, 4};
  for (double shift = 0.0; shift < 4.0; shift += 0.25) {
    std::vector<double> b{1.5, 2, 2.5, 5};
    for (auto& value : b) value += shift;
    const auto test = welch_t_test(a, b, 0.9);
    EXPECT_EQ(test->low <= 0.0 && test->high >= 0.0, test->test.p >= 0.1) << shift;
  }
}

TEST(WelchT, SaysWhyNothingCanBeTested) {
  const std::vector<double> constant{0.3, 0.1 + 0.2};
  EXPECT_EQ(welch_t_test(constant, constant).reason(), "no spread within the groups");
  EXPECT_EQ(welch_t_test(constant, std::vector<double>{1}).reason(), "fewer than two values in a group");
  EXPECT_TRUE(welch_t_test(constant, std::vector<double>{1, 2}));
}

TEST(PairedT, SaysWhyNothingCanBeTested) {
  const std::vector<double> a{0.1, 0.2, 0.7};
  std::vector<double> b = a;
  for (auto& value : b) value += 0.1;
  EXPECT_EQ(paired_t_test(a, b).reason(), "all differences are equal");
  EXPECT_EQ(paired_t_test(std::vector<double>{1}, std::vector<double>{2}).reason(), "fewer than two pairs");
  EXPECT_THROW((void)paired_t_test(a, std::vector<double>{1}), std::invalid_argument);
}

TEST(PairedT, EvenDifferencesBeyondTheRangeOfNumbersAreTested) {
  const std::vector<double> a{1.5e308, 1.2e308, 1.0e308};
  const std::vector<double> b{-1.5e308, -1.1e308, -0.2e308};
  const auto test = paired_t_test(a, b);
  ASSERT_TRUE(test);
  const auto small = paired_t_test(std::vector<double>{15, 12, 10}, std::vector<double>{-15, -11, -2});
  EXPECT_NEAR(test->test.p, small->test.p, 1e-12);
}

TEST(Tests, RefuseBrokenPreconditions) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> bad{1, 2, 3, 4, 5, nan};
  EXPECT_THROW((void)one_way_anova(bad, kThree), std::invalid_argument);
  EXPECT_THROW((void)welch_anova(bad, kThree), std::invalid_argument);
  EXPECT_THROW((void)kruskal_wallis(bad, kThree), std::invalid_argument);
  EXPECT_THROW((void)brown_forsythe(std::vector<double>{1}, kThree), std::invalid_argument);
  EXPECT_THROW((void)welch_t_test(bad, bad), std::invalid_argument);
  EXPECT_THROW((void)welch_t_test(std::vector<double>{1, 2}, std::vector<double>{1, 2}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
