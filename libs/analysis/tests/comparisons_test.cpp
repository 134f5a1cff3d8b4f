// Comparisons of groups against R on the values of reference/make_reference_comparisons.R.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "common.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/distributions.hpp"
#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/tests.hpp"
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
  const auto expect_d = [](const json& d, double df, double unit) {
    expect_interval(standardized_interval(d.at(0).get<double>() / unit, df, unit, 0.95), d, 1e-7, "d");
  };
  for (const auto& entry : comparisons().at("two_groups")) {
    const std::vector<double> a = entry.at("a");
    const std::vector<double> b = entry.at("b");
    const auto n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
    expect_d(entry.at("d"), n_a + n_b - 2.0, std::sqrt(1.0 / n_a + 1.0 / n_b));
    if (entry.contains("paired_d")) expect_d(entry.at("paired_d"), n_a - 1.0, 1.0 / std::sqrt(n_a));
    expect_relative(*hedges_g(a, b), entry.at("g").at(0), 1e-9, "g");
  }
}

TEST(EffectSizes, IntervalsOfVarianceSharesEqual) {
  for (const auto& row : comparisons().at("shares")) {
    const auto share = partial_eta_squared_interval(row.at("f"), row.at("df1"), row.at("df2"), 0.95);
    expect_relative(share.estimate, row.at("eta"), 1e-12, "eta");
    EXPECT_NEAR(share.low, row.at("low"), 1e-7) << row;
    EXPECT_NEAR(share.high, row.at("high"), 1e-7) << row;
  }
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
