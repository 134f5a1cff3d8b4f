#include "kith/stats/count_model.hpp"

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

constexpr double kCensored = 1e-6;

const json& censored_cases() {
  static const json read = testing::read_reference("responses.json").at("censored");
  return read;
}

TEST(CensoredCounts, EqualTheMaximumOfTheLikelihoodInR) {
  for (const auto& entry : censored_cases()) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const std::vector<double> counts = entry.at("counts");
    const std::vector<bool> observed = entry.at("observed");
    const std::vector<std::vector<std::size_t>> terms = entry.at("terms");
    const auto model = fit_count_model(counts, observed, testing::read_factors(entry.at("factors")), terms);
    ASSERT_TRUE(model) << model.reason();
    EXPECT_NEAR(model->log_likelihood, entry.at("log_likelihood").get<double>(), 1e-8);
    ASSERT_TRUE(model->theta);
    EXPECT_LE(relative_error(*model->theta, entry.at("theta")), 1e-5);  // R differentiates numerically
    const auto& kept = model->fixed.design.kept;
    const auto columns = model->fixed.design.columns.size();
    ASSERT_EQ(kept.size(), entry.at("coefficients").size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      EXPECT_NEAR(model->fixed.coefficients[kept[i]], entry.at("coefficients")[i].get<double>(), kCensored);
      if (model->censored == 0) continue;  // the information is the expected one, as in count_model_test
      for (std::size_t j = 0; j < kept.size(); ++j) {
        EXPECT_NEAR(model->fixed.covariance[kept[i] * columns + kept[j]],
                    entry.at("covariance")[i * kept.size() + j].get<double>(), kCensored);
      }
    }
    ASSERT_EQ(model->term_tests.size(), entry.at("tests").size());
    for (std::size_t t = 0; t < model->term_tests.size(); ++t) {
      const auto& test = model->term_tests[t];
      const auto& expected = entry.at("tests")[t];
      EXPECT_EQ(test.name, expected.at("name"));
      ASSERT_TRUE(test.test) << test.test.reason();
      EXPECT_NEAR(test.test->statistic, expected.at("statistic").get<double>(), 1e-7);
      EXPECT_LE(relative_error(test.test->p, expected.at("p")), kCensored);
    }
  }
}

TEST(CensoredCounts, AreNegativeBinomialWhereNoneIsCensored) {
  const auto& entry = censored_cases().at(2);
  const std::vector<double> counts = entry.at("counts");
  const auto factors = testing::read_factors(entry.at("factors"));
  const std::vector<std::vector<std::size_t>> terms{{0}, {1}};
  const auto model = fit_count_model(counts, std::vector<bool>(counts.size(), true), factors, terms);
  const auto uncensored = fit_count_model(counts, {}, factors, terms);
  ASSERT_TRUE(model && uncensored);
  EXPECT_EQ(model->censored, 0u);
  EXPECT_EQ(model->theta, uncensored->theta);
  EXPECT_EQ(model->fixed.covariance, uncensored->fixed.covariance);
}

TEST(CensoredCounts, ThatVaryLittleArePoisson) {
  const std::vector<double> counts{7, 8, 8, 9, 10, 8, 7, 9};
  const std::vector<bool> observed{true, true, true, true, false, true, true, true};
  const auto model = fit_count_model(counts, observed, {}, {});
  ASSERT_TRUE(model) << model.reason();
  EXPECT_FALSE(model->theta);
  EXPECT_EQ(model->censored, 1u);
  // Score of Poisson's mean: sum of the others / mu - 7 + P(Y = 10) / P(Y > 10) = 0.
  const double mu = std::exp(model->fixed.coefficients.at(0));
  double below = 0.0;
  double probability = std::exp(-mu);
  for (int y = 0; y <= 10; ++y) {
    below += probability;
    probability *= mu / (y + 1);
  }
  const double at_ten = probability * 11.0 / mu;
  EXPECT_NEAR(56.0 / mu - 7.0 + at_ten / (1.0 - below), 0.0, 1e-7);
}

std::string censored_reason(const std::vector<double>& counts, const std::vector<bool>& observed,
                            const std::vector<std::size_t>& codes) {
  const auto model = fit_count_model(counts, observed, std::vector<Factor>{{"g", {"a", "b"}, codes}},
                                     std::vector<std::vector<std::size_t>>{{0}});
  EXPECT_FALSE(model);
  return model.reason();
}

TEST(CensoredCounts, WhatCannotBeFittedHasAReason) {
  using ::testing::HasSubstr;
  EXPECT_THAT(censored_reason({}, {}, {}), HasSubstr("no observations"));
  EXPECT_THAT(censored_reason({1.5, 2, 3}, {true, true, true}, {0, 1, 0}), HasSubstr("whole numbers"));
  EXPECT_THAT(censored_reason({1, 2, 3}, {false, false, false}, {0, 1, 0}), HasSubstr("all counts are censored"));
  EXPECT_THAT(censored_reason({0, 0, 0}, {true, true, true}, {0, 1, 0}), HasSubstr("all counts are zero"));
  EXPECT_THAT(censored_reason({1, 2}, {true, true}, {0, 1}), HasSubstr("no more observations"));
  EXPECT_THAT(censored_reason({3, 4, 9, 9}, {true, true, false, false}, {0, 0, 1, 1}),
              HasSubstr("only censored counts leave some ratios without a bound"));
  EXPECT_THROW((void)fit_count_model(std::vector<double>{1.0}, {true, true}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
