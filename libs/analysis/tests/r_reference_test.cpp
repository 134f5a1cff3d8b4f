// Every closed-form statistic against R on the data sets of reference/make_reference.R.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/marginal_means.hpp"
#include "kith/analysis/multiple.hpp"
#include "kith/analysis/power.hpp"
#include "kith/analysis/tests.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;

constexpr double kClosedForm = 1e-10;  // relative
constexpr double kTukey = 1e-6;

const json& reference() {
  static const json read = testing::read_reference("anova.json");
  return read;
}

struct DataSet {
  std::string name;
  std::vector<double> response;
  std::vector<Factor> factors;
  std::vector<std::vector<std::size_t>> terms;
  int exponent = 0;
};

Factor factor_of(const std::string& name, const std::vector<std::size_t>& codes) {
  std::size_t num_levels = 0;
  for (const auto code : codes) num_levels = std::max(num_levels, code + 1);
  Factor factor{name, {}, codes};
  for (std::size_t level = 0; level < num_levels; ++level) factor.levels.push_back(std::to_string(level));
  return factor;
}

DataSet data_set_of(const json& entry) {
  DataSet set{entry.at("name"), entry.at("y"), {}, entry.at("terms"), entry.at("exponent").get<int>()};
  for (const auto& codes : entry.at("factors")) {
    const auto letter = static_cast<char>('a' + static_cast<int>(set.factors.size()));
    set.factors.push_back(factor_of(std::string{letter}, codes));
  }
  return set;
}

void expect_close(double actual, const json& expected, double tolerance, const std::string& what) {
  EXPECT_LE(testing::relative_error(actual, expected.get<double>()), tolerance)
      << what << ": " << actual << " where R has " << expected;
}

// Of a statistic that is 0, such as F of equal means, R has a rounding error.
void expect_statistic(double actual, const json& expected, const std::string& what) {
  constexpr double kZero = 1e-25;
  if (std::abs(expected.get<double>()) < kZero) {
    EXPECT_LT(std::abs(actual), kZero) << what;
  } else {
    expect_close(actual, expected, kClosedForm, what);
  }
}

void expect_test(const Estimable<TestResult>& actual, const json& expected, const std::string& what) {
  ASSERT_TRUE(actual) << what << ": " << actual.reason();
  expect_statistic(actual->statistic, expected.at("statistic"), what);
  expect_close(actual->p, expected.at("p"), kClosedForm, what + ", p");
  ASSERT_EQ(actual->df.size(), expected.at("df").size()) << what;
  for (std::size_t i = 0; i < actual->df.size(); ++i)
    expect_close(actual->df[i], expected.at("df")[i], kClosedForm, what + ", df");
}

void expect_table(const AnovaTable& actual, const json& expected, int exponent) {
  EXPECT_EQ(actual.residual_df, expected.at("residual_df").get<std::size_t>());
  expect_close(actual.residual_sum_of_squares, std::ldexp(expected.at("residual_ss").get<double>(), 2 * exponent),
               kClosedForm, "residual");
  ASSERT_EQ(actual.terms.size(), expected.at("terms").size());
  for (std::size_t t = 0; t < actual.terms.size(); ++t) {
    const auto& term = actual.terms[t];
    const auto& row = expected.at("terms")[t];
    EXPECT_EQ(term.name, row.value("name", term.name));
    EXPECT_EQ(term.df, row.at("df").get<std::size_t>()) << term.name;
    if (row.at("df") == 0) {
      EXPECT_FALSE(term.test) << term.name;
      EXPECT_FALSE(term.partial_eta_squared) << term.name;
      continue;
    }
    ASSERT_TRUE(term.test) << term.name << ": " << term.test.reason();
    expect_statistic(std::ldexp(term.sum_of_squares, -2 * exponent), row.at("ss"), term.name + ", sum of squares");
    expect_statistic(term.test->statistic, row.at("f"), term.name + ", F");
    expect_close(term.test->p, row.at("p"), kClosedForm, term.name + ", p");
    if (row.contains("eta")) expect_statistic(*term.partial_eta_squared, row.at("eta"), term.name + ", eta");
  }
}

void expect_difference(const Estimable<MeanDifference>& actual, const json& expected, int exponent,
                       const std::string& what) {
  ASSERT_TRUE(actual) << what << ": " << actual.reason();
  const auto scaled = [&](const char* field) { return std::ldexp(expected.at(field).get<double>(), exponent); };
  expect_close(actual->difference, scaled("diff"), kClosedForm, what + ", difference");
  expect_close(actual->standard_error, scaled("se"), kClosedForm, what + ", standard error");
  expect_close(actual->low, scaled("low"), kClosedForm, what + ", low");
  expect_close(actual->high, scaled("high"), kClosedForm, what + ", high");
  expect_close(actual->test.statistic, expected.at("t"), kClosedForm, what + ", t");
  expect_close(actual->test.df.at(0), expected.at("df"), kClosedForm, what + ", df");
  expect_close(actual->test.p, expected.at("p"), kClosedForm, what + ", p");
}

TEST(AgainstR, SumsOfSquaresEqualComparisonsOfModels) {
  EXPECT_GE(reference().at("data_sets").size(), 18u);
  for (const auto& entry : reference().at("data_sets")) {
    const auto set = data_set_of(entry);
    SCOPED_TRACE(set.name);
    expect_table(anova(set.response, set.factors, set.terms), entry.at("squares"), set.exponent);
  }
}

// There R has NaN, Inf or rounding errors: `r_says`.
TEST(AgainstR, WhatRCannotEstimateHasAReason) {
  for (const auto& entry : reference().at("degenerate")) {
    const auto set = data_set_of(entry);
    for (const auto& term : anova(set.response, set.factors, set.terms).terms) {
      EXPECT_FALSE(term.test) << set.name << ", " << term.name;
      EXPECT_FALSE(term.test.reason().empty());
      EXPECT_FALSE(term.partial_eta_squared);
    }
  }
}

TEST(AgainstR, TestsOfOneFactorEqual) {
  for (const auto& entry : reference().at("data_sets")) {
    const auto set = data_set_of(entry);
    SCOPED_TRACE(set.name);
    const auto& tests = entry.at("tests");
    const auto& group = set.factors.at(0);
    expect_test(one_way_anova(set.response, group), tests.at("one_way"), "one-way");
    expect_test(kruskal_wallis(set.response, group), tests.at("kruskal"), "Kruskal-Wallis");
    if (tests.contains("welch")) expect_test(welch_anova(set.response, group), tests.at("welch"), "Welch");
    if (tests.contains("brown_forsythe"))
      expect_test(brown_forsythe(set.response, group), tests.at("brown_forsythe"), "Brown-Forsythe");
  }
}

TEST(AgainstR, TestsOfTwoSamplesEqual) {
  for (const auto& entry : reference().at("data_sets")) {
    const auto& tests = entry.at("tests");
    if (!tests.contains("welch_t")) continue;
    const auto set = data_set_of(entry);
    SCOPED_TRACE(set.name);
    const auto groups = split_by(set.response, set.factors.at(0));
    expect_difference(welch_t_test(groups[0], groups[1], 0.9), tests.at("welch_t"), set.exponent, "Welch's t");
    expect_close(*hedges_g(groups[0], groups[1]), tests.at("hedges_g"), kClosedForm, "Hedges' g");
    if (!tests.contains("paired_t")) continue;
    const auto pairs = std::min(groups[0].size(), groups[1].size());
    const auto paired = paired_t_test(std::span{groups[0]}.first(pairs), std::span{groups[1]}.first(pairs));
    expect_difference(paired, tests.at("paired_t"), set.exponent, "paired t");
  }
}

// R's intervals come from qtukey, which iterates to 1e-4 only.
TEST(AgainstR, TukeyEquals) {
  std::size_t compared_with_ptukey = 0;
  for (const auto& entry : reference().at("data_sets")) {
    const auto& tests = entry.at("tests");
    if (!tests.contains("tukey")) continue;
    const auto set = data_set_of(entry);
    SCOPED_TRACE(set.name);
    const auto model = *anova(set.response, std::span{set.factors}.first(1), testing::kAlone).effects;
    const auto pairs = estimate_pairs(model, marginal_means(model, 0).front());
    const auto in_units_of_r = [&](double x) { return std::ldexp(x, -set.exponent); };
    ASSERT_EQ(pairs.size(), tests.at("tukey").size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& inference = pairs[i].inference.value();
      const auto& row = tests.at("tukey")[i];
      const double difference = in_units_of_r(pairs[i].estimate);
      EXPECT_NEAR(difference, row.at("diff").get<double>(), 1e-10 * (1.0 + std::abs(difference)));
      const double half_width = in_units_of_r(inference.high - inference.low) / 2.0;
      EXPECT_NEAR(in_units_of_r(inference.low), row.at("low").get<double>(), 2e-3 * half_width);
      EXPECT_NEAR(in_units_of_r(inference.high), row.at("high").get<double>(), 2e-3 * half_width);
      const double integral = row.at("p_integral");
      if (integral <= 1e-6) continue;
      expect_close(inference.p, row.at("p_integral"), 1e-9, "p");
      if (testing::relative_error(row.at("p"), integral) > kTukey / 2.0) continue;
      expect_close(inference.p, row.at("p"), kTukey, "p of ptukey");
      ++compared_with_ptukey;
    }
  }
  EXPECT_GE(compared_with_ptukey, 50u);
}

TEST(AgainstR, TailsOfTheStudentizedRangeEqualTheirIntegralAndMostlyPtukey) {
  std::size_t agree = 0;
  for (const auto& row : reference().at("studentized_range")) {
    const double upper = studentized_range_upper(row.at("q"), row.at("groups"), row.at("df"));
    const auto what = row.dump();
    expect_close(upper, row.at("p"), 1e-9, what);
    if (testing::relative_error(row.at("ptukey"), row.at("p")) > kTukey / 2.0) continue;  // ptukey itself is off
    expect_close(upper, row.at("ptukey"), kTukey, what);
    ++agree;
  }
  EXPECT_GE(agree, 150u);
}

TEST(AgainstR, BlockedAnalysisEqualsAovWithErrorStrata) {
  for (const auto& entry : reference().at("blocks")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const std::vector<double> response = entry.at("y");
    const auto table = blocked_anova(response, factor_of("within", entry.at("within")),
                                     factor_of("between", entry.at("between")), factor_of("block", entry.at("block")));
    ASSERT_TRUE(table) << table.reason();
    auto compared = *table;
    EXPECT_EQ(compared.terms.at(0).name, "within");
    EXPECT_EQ(compared.terms.at(1).name, "within:between");
    if (entry.at("terms").size() == 1) {
      EXPECT_FALSE(compared.terms.at(1).test);
      compared.terms.pop_back();
    }
    expect_table(compared, entry, 0);
  }
}

TEST(AgainstR, AdjustedPValuesEqual) {
  for (const auto& entry : reference().at("adjusted")) {
    const std::vector<double> p = entry.at("p");
    const auto expect_equal = [&](Correction correction, const json& expected) {
      const auto adjusted = adjust(p, correction);
      ASSERT_EQ(adjusted.size(), expected.size());
      for (std::size_t i = 0; i < p.size(); ++i) expect_close(adjusted[i], expected[i], 1e-14, entry.dump());
    };
    expect_equal(Correction::kBonferroni, entry.at("bonferroni"));
    expect_equal(Correction::kHolm, entry.at("holm"));
  }
}

// R's non-central F ends its series at 1e-9.
TEST(AgainstR, PowerEquals) {
  for (const auto& row : reference().at("power")) {
    const std::size_t groups = row.at("groups");
    const double power = f_test_power(row.at("eta"), groups - 1, groups, row.at("observations"), 0.05);
    expect_close(power, row.at("power"), 1e-7, row.dump());
  }
}

}  // namespace
}  // namespace kith
