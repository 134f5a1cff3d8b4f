// Comparisons of groups against R on the values of reference/make_reference_comparisons.R.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "common.hpp"
#include "kith/stats/anova.hpp"
#include "kith/stats/distributions.hpp"
#include "kith/stats/effect_size.hpp"
#include "kith/stats/equivalence.hpp"
#include "kith/stats/linear_model.hpp"
#include "kith/stats/marginal_means.hpp"
#include "kith/stats/multiple.hpp"
#include "kith/stats/multivariate_t.hpp"
#include "kith/stats/tests.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::numbered_factor;

const json& comparisons() {
  static const json read = testing::read_reference("comparisons.json");
  return read;
}

void expect_relative(double actual, const json& expected, double tolerance, const std::string& what) {
  EXPECT_LE(testing::relative_error(actual, expected.get<double>()), tolerance)
      << what << ": " << actual << " where R has " << expected;
}

void expect_interval(const Interval& actual, const json& expected, double tolerance, const std::string& what) {
  expect_relative(actual.estimate, expected.at(0), 1e-9, what);
  EXPECT_NEAR(actual.low, expected.at(1).get<double>(), tolerance) << what;
  EXPECT_NEAR(actual.high, expected.at(2).get<double>(), tolerance) << what;
}

TEST(SimpleEffects, EqualJointTestsOfEmmeans) {
  for (const auto& entry : comparisons().at("simple_effects")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const std::vector<Factor> factors{numbered_factor("a", entry.at("a")), numbered_factor("b", entry.at("b"))};
    const std::vector<std::vector<std::size_t>> terms = entry.at("terms");
    const auto model = fit_linear_model(entry.at("y").get<std::vector<double>>(), factors, terms).value();
    const std::vector<std::size_t> over{entry.at("over")};
    const std::vector<std::size_t> by{1 - over[0]};
    const auto means = marginal_means(model.effects, over, by);
    for (std::size_t g = 0; g < entry.at("f").size(); ++g) {
      const auto test = test_equal_means(model.effects, means.groups.at(g));
      ASSERT_TRUE(test) << test.reason();
      EXPECT_NEAR(test->statistic, entry.at("f")[g].get<double>(), 6e-4);  // joint_tests rounds F
      EXPECT_EQ(test->df, (std::vector<double>{entry.at("df1")[g], entry.at("df2")[g]}));
      EXPECT_NEAR(test->p, entry.at("p")[g].get<double>(), 1e-8);
    }
  }
}

TEST(SimpleEffects, OfTheOnlyFactorAreTheAnalysisOfVariance) {
  const Factor group{"group", {"a", "b", "c"}, {0, 0, 1, 1, 1, 2, 2}};
  const std::vector<double> response{1.0, 3.0, 2.0, 5.0, 4.0, 7.0, 6.5};
  const auto model = fit_linear_model(response, std::vector{group}, std::vector<std::vector<std::size_t>>{{0}}).value();
  const auto means = marginal_means(model.effects, std::vector<std::size_t>{0}).groups.at(0);
  const auto test = test_equal_means(model.effects, means);
  const auto expected = one_way_anova(response, group);
  ASSERT_TRUE(test) << test.reason();
  EXPECT_NEAR(test->statistic, expected->statistic, 1e-12);
  EXPECT_NEAR(test->p, expected->p, 1e-12);
  auto wide = model.effects;
  wide.df = [](auto) { return testing::kInfinity; };
  EXPECT_EQ(test_equal_means(wide, means)->statistic_name, "chi-squared");
  EXPECT_NEAR(test_equal_means(wide, means)->statistic, 2.0 * expected->statistic, 1e-12);
  auto single = means;
  single.means.resize(1);
  EXPECT_EQ(test_equal_means(model.effects, single).reason(), "fewer than two means");
}

TEST(LargestT, EqualsItsIntegralAndMvtnorm) {
  std::size_t products = 0;
  std::size_t others = 0;
  for (const auto& row : comparisons().at("largest_t")) {
    const std::vector<double> correlations = row.at("correlations");
    const double df = row.at("df") == 0 ? testing::kInfinity : row.at("df").get<double>();
    const bool is_product = row.at("kind") == "product";
    expect_relative(LargestT{correlations}.upper(row.at("t"), df), row.at("p"), is_product ? 1e-7 : 1e-4, row.dump());
    ++(is_product ? products : others);
  }
  EXPECT_GE(products, 40u);
  EXPECT_GE(others, 10u);
}

TEST(LargestT, OfAllPairsOfEqualGroupsIsTheStudentizedRange) {
  const std::vector<double> pairs_of_three{1, 0.5, -0.5, 0.5, 1, 0.5, -0.5, 0.5, 1};
  const LargestT largest{pairs_of_three};
  for (const double t : {0.5, 2.0, 5.0}) {
    const double range = studentized_range_upper(std::sqrt(2.0) * t, 3, 12.0);
    EXPECT_NEAR(largest.upper(t, 12.0), range, 1e-4 * range);
  }
}

TEST(LargestT, OfOneStatisticIsStudents) {
  EXPECT_EQ(LargestT{std::vector{1.0}}.upper(2.0, 7.0), student_t_two_sided(2.0, 7.0));
  const std::vector<double> twice{1.0, 1.0, 1.0, 1.0};
  EXPECT_NEAR(LargestT{twice}.upper(2.0, 7.0), student_t_two_sided(2.0, 7.0), 1e-12);
}

TEST(LargestT, QuantilesInvertTails) {
  // Dunnett's table for 3 treatments and 15 degrees of freedom, two-sided 5 %, has 2.61.
  const LargestT dunnett{std::vector{1.0, 0.5, 0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 1.0}};
  const double t = dunnett.quantile(0.05, 15.0);
  EXPECT_NEAR(t, 2.61, 0.005);
  EXPECT_NEAR(dunnett.upper(t, 15.0), 0.05, 1e-12);
}

TEST(LargestT, RejectsWhatIsNoCorrelationMatrix) {
  EXPECT_THROW(LargestT(std::vector{1.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(LargestT(std::vector{1.0, 0.5, 0.4, 1.0}), std::invalid_argument);
  EXPECT_THROW(LargestT(std::vector{2.0}), std::invalid_argument);
  EXPECT_THROW(LargestT(std::vector{1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)LargestT(std::vector{1.0}).upper(-1.0, 3.0), std::invalid_argument);
}

TEST(NonCentrality, OfTIsTheOneOfItsTail) {
  for (const double t : {-3.0, 0.0, 0.4, 2.5, 40.0, 900.0}) {
    for (const double df : {1.0, 2.5, 30.0, 1e5, testing::kInfinity}) {
      for (const double p : {0.025, 0.5, 0.995}) {
        const double limit = non_centrality_of_t(t, df, p);
        EXPECT_NEAR(non_central_t_lower(t, df, limit), p, 1e-7) << t << ' ' << df << ' ' << p;
      }
    }
  }
  EXPECT_THROW((void)non_centrality_of_t(1.0, 0.0, 0.5), std::invalid_argument);
  EXPECT_THROW((void)non_centrality_of_t(1.0, 3.0, 1.0), std::invalid_argument);
}

TEST(NonCentrality, OfTFarAwayIsThatOfTheScaleAlone) {
  EXPECT_NEAR(non_central_t_lower(1e6, 10.0, 1e6), non_central_t_lower(9e3, 10.0, 9e3), 1e-3);
  EXPECT_NEAR(non_central_t_lower(-1e6, 10.0, -1e6), 1.0 - non_central_t_lower(1e6, 10.0, 1e6), 1e-12);
  EXPECT_EQ(non_central_t_lower(-1.0, 10.0, 1e6), 0.0);
}

TEST(NonCentrality, OfFIsZeroBelowChance) {
  EXPECT_EQ(non_centrality_of_f(0.5, 3.0, 20.0, 0.025), 0.0);
  const double limit = non_centrality_of_f(6.0, 3.0, 20.0, 0.025);
  EXPECT_NEAR(non_central_f_upper(6.0, 3.0, 20.0, limit), 0.025, 1e-10);
}

TEST(EffectSizes, IntervalsOfStandardizedDifferencesEqual) {
  for (const auto& entry : comparisons().at("two_groups")) {
    const std::vector<double> a = entry.at("a");
    const std::vector<double> b = entry.at("b");
    const auto effect = standardized_difference(a, b);
    ASSERT_TRUE(effect) << effect.reason();
    expect_interval(effect->d, entry.at("d"), 1e-7, "d");
    expect_interval(effect->g, entry.at("g"), 1e-7, "g");
    EXPECT_NEAR(effect->d.estimate, *cohens_d(a, b), 1e-12);
    EXPECT_NEAR(effect->g.estimate, *hedges_g(a, b), 1e-12);
    if (entry.contains("paired_d"))
      expect_interval(paired_standardized_difference(a, b)->d, entry.at("paired_d"), 1e-7, "paired d");
  }
}

TEST(EffectSizes, OfAContrastInAOneWayModelOfTwoGroupsIsCohensD) {
  const std::vector<double> a{1.0, 2.0, 4.0, 3.5};
  const std::vector<double> b{2.0, 5.0, 6.0};
  const std::vector<double> both{1.0, 2.0, 4.0, 3.5, 2.0, 5.0, 6.0};
  const Factor group{"group", {"b", "a"}, {1, 1, 1, 1, 0, 0, 0}};
  const auto model = fit_linear_model(both, std::vector{group}, std::vector<std::vector<std::size_t>>{{0}}).value();
  const auto means = marginal_means(model.effects, std::vector<std::size_t>{0}).groups.at(0);
  const auto contrast = estimate_contrasts(model.effects, means, pairwise_contrasts(means), Adjustment::kTukey).at(0);
  const auto effect = standardized_contrast(model.effects, contrast, 0.9);
  const auto expected = standardized_difference(a, b, 0.9);
  ASSERT_TRUE(effect) << effect.reason();
  EXPECT_NEAR(effect->d.estimate, expected->d.estimate, 1e-12);
  EXPECT_NEAR(effect->d.low, expected->d.low, 1e-9);
  EXPECT_NEAR(effect->g.high, expected->g.high, 1e-9);
  auto counts = model.effects;
  counts.link = Link::kLog;
  EXPECT_FALSE(standardized_contrast(counts, contrast));
}

TEST(EffectSizes, WithoutSpreadHaveReasons) {
  EXPECT_FALSE(standardized_difference(std::vector{1.0, 1.0}, std::vector{2.0, 2.0}));
  EXPECT_FALSE(standardized_difference(std::vector{1.0, 2.0}, std::vector{2.0}));
  EXPECT_FALSE(paired_standardized_difference(std::vector{1.0, 2.0}, std::vector{2.0, 4.0}));
}

TEST(EffectSizes, IntervalsOfVarianceSharesEqual) {
  for (const auto& row : comparisons().at("shares")) {
    AnovaTerm term;
    term.test = TestResult{"F", row.at("f"), {row.at("df1"), row.at("df2")}, 0.5};
    const auto share = variance_share(term, row.at("n"));
    ASSERT_TRUE(share);
    expect_relative(share->partial_eta_squared.estimate, row.at("eta"), 1e-12, "eta");
    EXPECT_NEAR(share->partial_eta_squared.low, row.at("low"), 1e-7) << row;
    EXPECT_NEAR(share->partial_eta_squared.high, row.at("high"), 1e-7) << row;
    EXPECT_NEAR(share->partial_omega_squared, row.at("omega"), 1e-12) << row;
  }
  EXPECT_FALSE(variance_share(AnovaTerm{}, 10));
  EXPECT_THROW((void)variance_share(AnovaTerm{}, 0), std::invalid_argument);
}

TEST(VarianceRatio, EqualsVarTest) {
  for (const auto& entry : comparisons().at("two_groups")) {
    const auto ratio =
        variance_ratio(entry.at("a").get<std::vector<double>>(), entry.at("b").get<std::vector<double>>(), 0.9);
    ASSERT_TRUE(ratio);
    const auto& expected = entry.at("variance_ratio");
    expect_relative(ratio->ratio.estimate, expected.at("ratio"), 1e-9, "ratio");
    expect_relative(ratio->ratio.low, expected.at("low"), 1e-9, "low");
    expect_relative(ratio->ratio.high, expected.at("high"), 1e-9, "high");
    EXPECT_NEAR(ratio->test.p, expected.at("p").get<double>(), 1e-9 * ratio->test.p + 1e-15);  // R takes 1 - p
  }
  EXPECT_FALSE(variance_ratio(std::vector{1.0, 1.0}, std::vector{1.0, 2.0}));
  EXPECT_FALSE(variance_ratio(std::vector{1.0}, std::vector{1.0, 2.0}));
}

TEST(VarianceRatio, BootstrapIntervalHoldsTheEstimateAndIsReproducible) {
  const auto& entry = comparisons().at("two_groups").at(5);
  const std::vector<double> a = entry.at("a");
  const std::vector<double> b = entry.at("b");
  const auto once = bootstrap_variance_ratio(a, b, {500, 0.95}, RandomStream{1});
  const auto again = bootstrap_variance_ratio(a, b, {500, 0.95}, RandomStream{1});
  ASSERT_TRUE(once) << once.reason();
  EXPECT_EQ(once->low, again->low);
  EXPECT_LT(once->low, once->estimate);
  EXPECT_GT(once->high, once->estimate);
  // About as wide as the interval of normal values, which counts nearly are.
  const auto normal = variance_ratio(a, b);
  EXPECT_NEAR(std::log(once->high / once->low), std::log(normal->ratio.high / normal->ratio.low), 0.4);
}

TEST(Equivalence, OfWelchAndPairedDifferencesEquals) {
  const auto expect_equal = [](const Equivalence& actual, const json& expected) {
    EXPECT_NEAR(actual.above_low.p, expected.at("p_low").get<double>(), 1e-10);
    EXPECT_NEAR(actual.below_high.p, expected.at("p_high").get<double>(), 1e-10);
    expect_relative(actual.narrow.low, expected.at("low"), 1e-8, "low");
    expect_relative(actual.narrow.high, expected.at("high"), 1e-8, "high");
    EXPECT_EQ(actual.p, std::max(actual.above_low.p, actual.below_high.p));
    const bool inside = actual.narrow.low > actual.bounds.low && actual.narrow.high < actual.bounds.high;
    EXPECT_EQ(inside, actual.p < 0.05);
  };
  for (const auto& entry : comparisons().at("two_groups")) {
    const std::vector<double> a = entry.at("a");
    const std::vector<double> b = entry.at("b");
    const EquivalenceBounds bounds{entry.at("bounds")[0], entry.at("bounds")[1]};
    const auto welch = test_equivalence(*welch_t_test(a, b), bounds);
    expect_equal(welch, entry.at("welch_tost"));
    EXPECT_NEAR(welch.p, entry.at("welch_tost").at("p_by_t_test").get<double>(), 1e-10);
    if (entry.contains("paired_tost"))
      expect_equal(test_equivalence(*paired_t_test(a, b), bounds), entry.at("paired_tost"));
  }
}

TEST(Equivalence, HasAllFourVerdicts) {
  const EquivalenceBounds bounds{-1.0, 1.0};
  const auto verdict = [&](double estimate, double standard_error) {
    return test_equivalence(estimate, standard_error, 30.0, bounds).verdict;
  };
  EXPECT_EQ(verdict(0.1, 0.1), EquivalenceVerdict::kEquivalent);
  EXPECT_EQ(verdict(0.5, 0.1), EquivalenceVerdict::kDifferentAndEquivalent);
  EXPECT_EQ(verdict(2.0, 0.4), EquivalenceVerdict::kDifferent);
  EXPECT_EQ(verdict(0.5, 0.6), EquivalenceVerdict::kUndecided);
  EXPECT_EQ(to_string(EquivalenceVerdict::kUndecided), "undecided");
}

TEST(Equivalence, OfAContrastIsThatOfItsEstimate) {
  const LinearEstimate contrast{"x", {}, 0.2, Inference{0.3, testing::kInfinity, 0.67, 0.9, 0.5, -1.0, 1.0}};
  const auto result = test_equivalence(contrast, {-1.0, 0.8});
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->below_high.p, normal_upper(2.0), 1e-15);
  // One of several contrasts, with an adjusted p: it must not be called different beside p = 0.09.
  const LinearEstimate adjusted{"x", {}, 2.0, Inference{0.9, testing::kInfinity, 2.2, 0.09, 0.03, -0.2, 4.2}};
  EXPECT_EQ(test_equivalence(adjusted, {-1.0, 1.0})->verdict, EquivalenceVerdict::kUndecided);
  EXPECT_FALSE(test_equivalence(LinearEstimate{}, {-1.0, 1.0}));
  EXPECT_THROW((void)test_equivalence(contrast, {1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)test_equivalence(contrast, {-1.0, 1.0}, 0.5), std::invalid_argument);
  EXPECT_THROW((void)test_equivalence(0.0, 0.0, 3.0, {-1.0, 1.0}), std::invalid_argument);
}

TEST(GamesHowell, PairsEqual) {
  for (const auto& entry : comparisons().at("games_howell")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto pairs = games_howell(entry.at("y").get<std::vector<double>>(), numbered_factor("g", entry.at("g")));
    ASSERT_TRUE(pairs) << pairs.reason();
    ASSERT_EQ(pairs->size(), entry.at("pairs").size());
    for (std::size_t i = 0; i < pairs->size(); ++i) {
      const auto& row = entry.at("pairs")[i];
      const auto& pair = (*pairs)[i];
      EXPECT_EQ(pair.first, row.at("first").get<std::size_t>());
      EXPECT_EQ(pair.second, row.at("second").get<std::size_t>());
      if (row.at("p").is_null()) {
        EXPECT_EQ(pair.difference.reason(), "fewer than two degrees of freedom");
        continue;
      }
      ASSERT_TRUE(pair.difference) << pair.difference.reason();
      expect_relative(pair.difference->difference, row.at("diff"), 1e-9, "difference");
      expect_relative(pair.difference->standard_error, row.at("se"), 1e-9, "standard error");
      expect_relative(pair.difference->test.df.at(0), row.at("df"), 1e-9, "df");
      expect_relative(pair.difference->test.p, row.at("p"), 1e-6, "p");
      expect_relative((pair.difference->high - pair.difference->low) / 2.0, row.at("reach"), 5e-3, "interval");
    }
  }
}

TEST(GamesHowell, SaysWhyAPairCannotBeCompared) {
  const Factor group{"g", {"a", "empty", "b", "c"}, {0, 0, 0, 2, 3, 3}};
  const auto pairs = games_howell(std::vector{1.0, 2.0, 4.0, 3.0, 1.0, 1.5}, group);
  ASSERT_TRUE(pairs);
  ASSERT_EQ(pairs->size(), 3u);
  EXPECT_EQ((*pairs)[0].difference.reason(), "fewer than two values in a group");
  EXPECT_EQ((*pairs)[1].second, 3u);
  EXPECT_TRUE((*pairs)[1].difference) << (*pairs)[1].difference.reason();
  EXPECT_FALSE(games_howell(std::vector{1.0}, Factor{"g", {"a"}, {0}}));
}

TEST(Sphericity, EqualsCar) {
  for (const auto& entry : comparisons().at("sphericity")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const std::vector<double> response = entry.at("y");
    const auto within = numbered_factor("within", entry.at("within"));
    const auto between = numbered_factor("between", entry.at("between"));
    const auto block = numbered_factor("block", entry.at("block"));
    const auto result = check_sphericity(response, within, between, block);
    ASSERT_TRUE(result) << result.reason();
    if (within.levels.size() == 2) {
      EXPECT_EQ(result->mauchly.reason(), "two levels are always spherical");
      EXPECT_EQ(result->greenhouse_geisser, 1.0);
      EXPECT_EQ(result->huynh_feldt, 1.0);
      continue;
    }
    expect_relative(result->mauchly_w, entry.at("w"), 1e-8, "W");
    ASSERT_TRUE(result->mauchly) << result->mauchly.reason();
    expect_relative(result->mauchly->p, entry.at("p_expansion"), 1e-7, "p");
    EXPECT_NEAR(result->mauchly->p, entry.at("p").get<double>(), 1e-4) << "as R has it";
    expect_relative(result->greenhouse_geisser, entry.at("gg"), 1e-9, "Greenhouse-Geisser");
    expect_relative(result->huynh_feldt, std::min(1.0, entry.at("hf").get<double>()), 1e-9, "Huynh-Feldt");
    const auto table = blocked_anova(response, within, between, block);
    ASSERT_TRUE(table);
    const auto& interaction = table->terms.at(1).test;
    if (entry.at("equal").get<bool>()) {  // car's type III differs where groups are of unequal size
      const auto& test = table->terms.at(0).test.value();
      expect_relative(test.statistic, entry.at("f"), 1e-9, "F");
      expect_relative(correct_for_sphericity(test, result->greenhouse_geisser).p, entry.at("p_gg"), 1e-7, "p");
      expect_relative(correct_for_sphericity(test, result->huynh_feldt).p, entry.at("p_hf"), 1e-7, "p");
    }
    if (interaction)
      expect_relative(correct_for_sphericity(*interaction, result->greenhouse_geisser).p, entry.at("interaction_p_gg"),
                      1e-7, "p of the interaction");
  }
}

TEST(Sphericity, OfTooFewBlocksHasEpsilonsButNoTest) {
  const Factor within{"within", {"a", "b", "c", "d"}, {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}};
  const Factor between{"all", {"all"}, std::vector<std::size_t>(12, 0)};
  const Factor block{"block", {"x", "y", "z"}, {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}};
  const auto result =
      check_sphericity(std::vector{1.0, 2.0, 4.0, 3.0, 2.0, 2.5, 5.0, 3.0, 1.0, 4.0, 3.0, 7.0}, within, between, block);
  ASSERT_TRUE(result) << result.reason();
  EXPECT_FALSE(result->mauchly);
  EXPECT_GE(result->greenhouse_geisser, 1.0 / 3.0);
  EXPECT_LT(result->greenhouse_geisser, 1.0);
  EXPECT_FALSE(check_sphericity(std::vector<double>(12, 1.0), within, between, block));
  EXPECT_THROW((void)correct_for_sphericity({"F", 2.0, {3.0, 6.0}, 0.2}, 0.0), std::invalid_argument);
  EXPECT_THROW((void)correct_for_sphericity({"t", 2.0, {6.0}, 0.2}, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace kith
