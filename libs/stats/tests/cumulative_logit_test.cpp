#include "kith/stats/cumulative_logit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::relative_error;

constexpr double kOrdinal = 1e-6;

const json& ordinal_cases() {
  static const json read = testing::read_reference("responses.json").at("ordinal");
  return read;
}

Estimable<CumulativeLogit> fit(const json& entry) {
  const std::vector<std::vector<std::size_t>> terms = entry.at("terms");
  return fit_cumulative_logit(testing::read_factor(entry.at("response")), testing::read_factors(entry.at("factors")),
                              terms);
}

TEST(CumulativeLogit, EqualsClm) {
  for (const auto& entry : ordinal_cases()) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(entry);
    ASSERT_TRUE(model) << model.reason();
    EXPECT_NEAR(model->log_likelihood, entry.at("log_likelihood").get<double>(), 1e-8);
    ASSERT_EQ(model->thresholds.size(), entry.at("thresholds").size());
    for (std::size_t j = 0; j < model->thresholds.size(); ++j) {
      EXPECT_NEAR(model->thresholds[j].estimate, entry.at("thresholds")[j].get<double>(), kOrdinal);
      EXPECT_LE(relative_error(model->thresholds[j].standard_error, entry.at("threshold_errors")[j]), kOrdinal);
    }
    const auto& kept = model->fixed.design.kept;
    const auto columns = model->fixed.design.columns.size();
    ASSERT_EQ(kept.size(), entry.at("coefficients").size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      EXPECT_NEAR(model->fixed.coefficients[kept[i]], entry.at("coefficients")[i].get<double>(), kOrdinal);
      for (std::size_t j = 0; j < kept.size(); ++j) {
        const double expected = entry.at("covariance")[i * kept.size() + j];
        EXPECT_NEAR(model->fixed.covariance[kept[i] * columns + kept[j]], expected, kOrdinal * (1.0 + expected));
      }
    }
    EXPECT_EQ(model->fixed.link, Link::kLogit);
  }
}

TEST(CumulativeLogit, TermsAreTestedByLikelihoodRatios) {
  for (const auto& entry : ordinal_cases()) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(entry);
    ASSERT_TRUE(model) << model.reason();
    ASSERT_EQ(model->term_tests.size(), entry.at("tests").size());
    for (std::size_t t = 0; t < model->term_tests.size(); ++t) {
      const auto& test = model->term_tests[t];
      const auto& expected = entry.at("tests")[t];
      EXPECT_EQ(test.name, expected.at("name"));
      EXPECT_EQ(test.df, expected.at("df").get<std::size_t>());
      ASSERT_TRUE(test.test) << test.test.reason();
      EXPECT_NEAR(test.test->statistic, expected.at("statistic").get<double>(), 1e-7);
      EXPECT_LE(relative_error(test.test->p, expected.at("p")), kOrdinal);
    }
  }
}

TEST(CumulativeLogit, ProportionalOddsAreTestedAsByBrant) {
  for (const auto& entry : ordinal_cases()) {
    if (!entry.contains("brant")) continue;
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(entry);
    ASSERT_TRUE(model) << model.reason();
    const auto& expected = entry.at("brant");
    if (expected.contains("separated")) {
      EXPECT_FALSE(model->proportional_odds);
      continue;
    }
    ASSERT_TRUE(model->proportional_odds) << model->proportional_odds.reason();
    EXPECT_LE(relative_error(model->proportional_odds->statistic, expected.at("statistic")), kOrdinal);
    EXPECT_EQ(model->proportional_odds->df.at(0), expected.at("df").get<double>());
    EXPECT_LE(relative_error(model->proportional_odds->p, expected.at("p")), kOrdinal);
  }
}

// A two by two table: the odds ratio is that of its counts, with Woolf's standard error.
TEST(CumulativeLogit, TwoLevelsAreLogisticRegression) {
  const Factor group{"g", {"a", "b"}, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1}};
  const Factor response{"y", {"no", "yes"}, {0, 0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 1}};
  const auto model = fit_cumulative_logit(response, std::vector{group}, std::vector<std::vector<std::size_t>>{{0}});
  ASSERT_TRUE(model) << model.reason();
  ASSERT_EQ(model->odds_ratios.size(), 1u);
  EXPECT_EQ(model->odds_ratios[0].name, "g[b]");
  EXPECT_NEAR(model->odds_ratios[0].ratio.estimate, (5.0 / 2.0) / (2.0 / 4.0), 1e-9);
  const double woolf = std::sqrt(1.0 / 4 + 1.0 / 2 + 1.0 / 2 + 1.0 / 5);
  EXPECT_NEAR(model->odds_ratios[0].test.statistic, std::log(5.0) / woolf, 1e-9);
  EXPECT_NEAR(model->odds_ratios[0].ratio.high, 5.0 * std::exp(1.959963984540054 * woolf), 1e-6);
  EXPECT_EQ(model->thresholds[0].name, "no|yes");
  EXPECT_EQ(model->proportional_odds.reason(), "the response has two levels");
}

std::string reason_of(const std::vector<std::size_t>& response, const std::vector<std::size_t>& group) {
  const auto model =
      fit_cumulative_logit({"y", {"1", "2", "3"}, response}, std::vector<Factor>{{"g", {"a", "b"}, group}},
                           std::vector<std::vector<std::size_t>>{{0}});
  EXPECT_FALSE(model);
  return model.reason();
}

TEST(CumulativeLogit, WhatCannotBeFittedHasAReason) {
  using ::testing::HasSubstr;
  EXPECT_THAT(reason_of({}, {}), HasSubstr("no observations"));
  EXPECT_THAT(reason_of({1, 1, 1, 1}, {0, 1, 0, 1}), HasSubstr("all responses are 2"));
  EXPECT_THAT(reason_of({0, 1, 2}, {0, 1, 0}), HasSubstr("no more observations than parameters"));
  EXPECT_THAT(reason_of({0, 0, 1, 1, 2, 2, 2}, {0, 0, 0, 0, 1, 1, 1}), HasSubstr("has no bound"));
}

TEST(CumulativeLogit, CallersMistakesThrow) {
  const Factor response{"y", {"1", "2"}, {0, 1, 0}};
  const Factor shorter{"g", {"a", "b"}, {0, 1}};
  const std::vector<std::vector<std::size_t>> terms{{0}};
  EXPECT_THROW((void)fit_cumulative_logit(response, std::vector{shorter}, terms), std::invalid_argument);
  EXPECT_THROW((void)fit_cumulative_logit(response, {}, {}, 0.0), std::invalid_argument);
  EXPECT_THROW((void)fit_cumulative_logit({"y", {"1"}, {0, 1}}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
