#include "kith/stats/count_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kith/random/distributions.hpp"
#include "kith/stats/quasi_poisson.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::read_factors;
using testing::relative_error;

constexpr double kSearchError = 1e-6;  // of two searches for a maximum

const json& count_cases() {
  static const json reference = testing::read_reference("models.json").at("counts");
  return reference;
}

// All of the counts are observed, and the terms are the factors.
Estimable<CountModel> fit_main_effects(const std::vector<double>& counts, const std::vector<Factor>& factors) {
  std::vector<std::vector<std::size_t>> terms;
  for (std::size_t f = 0; f < factors.size(); ++f) terms.push_back({f});
  return fit_count_model(counts, {}, factors, terms);
}

TEST(CountModel, AgreesWithRsGlmNbAndGlm) {
  for (const auto& reference : count_cases()) {
    SCOPED_TRACE(reference.at("name").get<std::string>());
    const std::vector<double> counts = reference.at("counts");
    const auto factors = read_factors(reference.at("factors"));
    const auto model = fit_main_effects(counts, factors);
    ASSERT_TRUE(model) << model.reason();
    ASSERT_EQ(model->theta.has_value(), !reference.at("theta").is_null());
    if (model->theta) {
      EXPECT_LE(relative_error(*model->theta, reference.at("theta")), kSearchError);
    }
    EXPECT_LE(relative_error(model->log_likelihood, reference.at("log_likelihood")), kSearchError);
    const auto& coefficients = model->fixed.coefficients;
    ASSERT_EQ(coefficients.size(), reference.at("coefficients").size());
    for (std::size_t c = 0; c < coefficients.size(); ++c) {
      EXPECT_LE(relative_error(coefficients[c], reference.at("coefficients")[c]), kSearchError);
      const double standard_error = std::sqrt(model->fixed.covariance[c * coefficients.size() + c]);
      EXPECT_LE(relative_error(standard_error, reference.at("standard_errors")[c]), kSearchError);
    }
    ASSERT_EQ(model->term_tests.size(), reference.at("tests").size());
    std::vector<std::vector<std::size_t>> terms;
    for (std::size_t f = 0; f < model->term_tests.size(); ++f) {
      terms.push_back({f});
      const auto& expected = reference.at("tests")[f];
      const auto& test = model->term_tests[f].test;
      ASSERT_TRUE(test);
      EXPECT_EQ(test->df, std::vector<double>{expected.at("df").get<double>()});
      EXPECT_LE(relative_error(test->statistic, expected.at("statistic")), kSearchError);
      EXPECT_LE(relative_error(test->p, expected.at("p")), kSearchError);
    }
    const auto poisson = fit_quasi_poisson(counts, factors, terms);
    ASSERT_TRUE(poisson) << poisson.reason();
    EXPECT_LE(relative_error(poisson->dispersion, reference.at("dispersion")), kSearchError);
  }
}

const Factor kTwoStrategies{"strategy", {"low", "joint"}, {0, 0, 0, 0, 1, 1, 1, 1}};

TEST(CountModel, OfOneFactorHasTheRatiosOfTheMeans) {
  const auto model = fit_main_effects({1, 9, 2, 8, 20, 4, 1, 35}, {kTwoStrategies});
  ASSERT_TRUE(model) << model.reason();
  EXPECT_EQ(model->fixed.design.columns.at(1), "strategy[joint]");
  EXPECT_NEAR(model->fixed.coefficients.at(1), std::log(15.0 / 5.0), 1e-9);
  EXPECT_NEAR(model->fixed.coefficients.front(), std::log(5.0), 1e-9);
}

TEST(CountModel, IsPoissonsWhereCountsVaryLess) {
  const auto model = fit_main_effects({7, 8, 8, 7, 9, 8, 8, 9}, {kTwoStrategies});
  ASSERT_TRUE(model) << model.reason();
  EXPECT_FALSE(model->theta.has_value());
}

// The profile likelihood of theta, with constants left out, by brute force over a grid: one factor, so that
// the expected counts are the means whatever theta is.
double profile_likelihood(const std::vector<double>& counts, double theta) {
  double sum = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double mu = i < 4 ? (counts[0] + counts[1] + counts[2] + counts[3]) / 4
                            : (counts[4] + counts[5] + counts[6] + counts[7]) / 4;
    sum += std::lgamma(counts[i] + theta) - std::lgamma(theta) - std::lgamma(counts[i] + 1.0) +
           theta * std::log(theta / (theta + mu)) + counts[i] * std::log(mu / (theta + mu));
  }
  return sum;
}

TEST(CountModel, HasTheThetaOfTheLargestLikelihood) {
  auto random = RandomStream{1}.split("theta");
  int overdispersed = 0;
  for (int round = 0; round < 50; ++round) {
    std::vector<double> counts;
    // Small counts, and such beyond the terms that are summed one by one.
    const double scale = round % 2 == 0 ? 10.0 : 3000.0;
    for (int i = 0; i < 8; ++i) counts.push_back(std::floor(-scale * std::log1p(-uniform01(random))));
    const auto model = fit_main_effects(counts, {kTwoStrategies});
    if (!model || !model->theta) continue;
    ++overdispersed;
    const double best = profile_likelihood(counts, *model->theta);
    EXPECT_NEAR(model->log_likelihood, best, 1e-9 * std::abs(best));
    for (double factor = 0.1; factor < 10.0; factor *= 1.05)
      EXPECT_LE(profile_likelihood(counts, *model->theta * factor), best + 1e-9 * std::abs(best));
  }
  EXPECT_GT(overdispersed, 40);
}

TEST(CountModel, DoesNotDependOnTheOrderOfObservations) {
  for (const auto& reference : count_cases()) {
    auto counts = reference.at("counts").get<std::vector<double>>();
    auto factors = read_factors(reference.at("factors"));
    const auto model = fit_main_effects(counts, factors);
    std::ranges::reverse(counts);
    for (auto& factor : factors) std::ranges::reverse(factor.codes);
    const auto reversed = fit_main_effects(counts, factors);
    ASSERT_TRUE(model && reversed);
    // The largest data set's terms are of size 1e7 and cancel to 1e3.
    EXPECT_LE(relative_error(reversed->log_likelihood, model->log_likelihood), 1e-11);
    EXPECT_LE(relative_error(reversed->theta.value_or(0.0), model->theta.value_or(0.0)), 1e-8);
  }
}

TEST(CountModel, LeavesOutLevelsThatNoObservationHas) {
  const std::vector<double> counts{1, 9, 2, 8, 20, 4, 1, 35};
  const Factor with_unused{"strategy", {"none", "low", "other", "joint"}, {1, 1, 1, 1, 3, 3, 3, 3}};
  const auto model = fit_main_effects(counts, {with_unused});
  ASSERT_TRUE(model);
  EXPECT_EQ(model->fixed.design.columns, (std::vector<std::string>{"(Intercept)", "strategy[joint]"}));
}

TEST(CountModel, FitsCountsOfAnySize) {
  const auto model = fit_main_effects({1e9, 3e9, 2e9, 1e9, 5e9, 1e10, 2e9, 7e9}, {kTwoStrategies});
  ASSERT_TRUE(model) << model.reason();
  EXPECT_NEAR(std::exp(model->fixed.coefficients.at(1)), 24.0 / 7.0, 1e-6);
  ASSERT_TRUE(model->theta.has_value());
  EXPECT_GT(*model->theta, 1.0);  // the moments say 1.9
  EXPECT_LT(*model->theta, 4.0);
}

// A hundred times Poisson's variance, though theta is 10^7.
TEST(CountModel, SeesOverdispersionOfHugeCounts) {
  std::vector<double> counts;
  for (const double deviation : {-1.3, -0.9, 1.1, 1.1, -1.2, 1.0, 0.8, -0.6})
    counts.push_back(1e9 + std::round(deviation * 10.0 * std::sqrt(1e9)));
  const auto model = fit_main_effects(counts, {kTwoStrategies});
  ASSERT_TRUE(model && model->theta) << model.reason();
  EXPECT_NEAR(std::log10(*model->theta), 7.0, 0.3);
}

std::string reason_of(const std::vector<double>& counts, const std::vector<Factor>& factors) {
  const auto model = fit_main_effects(counts, factors);
  EXPECT_EQ(model.has_value(), model.reason().empty());
  return model.reason();
}

TEST(CountModel, SaysWhyThereIsNone) {
  EXPECT_EQ(reason_of({}, {}), "no observations");
  EXPECT_EQ(reason_of({1, 2, 3, 4, 5, 6, 7, 8.5}, {kTwoStrategies}),
            "counts must be whole numbers that are not negative");
  EXPECT_EQ(reason_of({1, 2, 3, 4, 5, 6, 7, -1}, {kTwoStrategies}),
            "counts must be whole numbers that are not negative");
  EXPECT_EQ(reason_of({1, 2, 3, 4, 5, 6, 7, std::nan("")}, {kTwoStrategies}),
            "counts must be whole numbers that are not negative");
  EXPECT_EQ(reason_of(std::vector<double>(8, 0.0), {kTwoStrategies}), "all counts are zero");
  EXPECT_EQ(reason_of({1, 2}, {Factor{"f", {"a", "b"}, {0, 1}}}), "there are no more observations than coefficients");
}

TEST(CountModel, SaysWhichTermsCannotBeTested) {
  const std::vector<double> counts{1, 2, 3, 4, 5, 6, 7, 9};
  const auto one_level = fit_main_effects(counts, {Factor{"f", {"a", "b"}, std::vector<std::size_t>(8, 1)}});
  ASSERT_TRUE(one_level) << one_level.reason();
  EXPECT_FALSE(one_level->term_tests.at(0).test);
  const auto twice = fit_main_effects(counts, {kTwoStrategies, kTwoStrategies});
  ASSERT_TRUE(twice) << twice.reason();
  for (const auto& term : twice->term_tests)
    EXPECT_EQ(term.test.reason(), "its levels cannot be told apart from those of other terms");
}

const std::string kSeparated = "combinations of levels with only zeros leave some ratios without a bound";

TEST(CountModel, SaysSoIfZerosOfSomeCombinationsSeparateTheCounts) {
  EXPECT_EQ(reason_of({1, 2, 3, 4, 0, 0, 0, 0}, {kTwoStrategies}), kSeparated);
  // Only the cells of a1 compare b2 with b1, and there b2 has none but zeros.
  const Factor a{"a", {"1", "2"}, {0, 0, 0, 0, 1, 1}};
  const Factor b{"b", {"1", "2"}, {0, 0, 1, 1, 1, 1}};
  EXPECT_EQ(reason_of({3, 2, 0, 0, 4, 1}, {a, b}), kSeparated);
  EXPECT_EQ(reason_of({3, 2, 0, 1, 4, 1}, {a, b}), "");
}

TEST(CountModel, FindsAFiniteMaximumBesideCellsOfZeros) {
  // Zeros off the diagonal pull in opposite directions: the effects stay finite.
  const Factor a{"a", {"1", "2"}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const Factor b{"b", {"1", "2"}, {0, 0, 1, 1, 0, 0, 1, 1}};
  EXPECT_EQ(reason_of({3, 2, 0, 0, 0, 0, 2, 3}, {a, b}), "");
}

TEST(CountModel, SaysSoIfSeveralDirectionsAreSeparated) {
  // Three levels of b whose effects are known from cells of zeros only.
  const Factor a{"a", {"1", "2", "3"}, {0, 0, 0, 0, 0, 0, 1, 1, 2, 2}};
  const Factor b{"b", {"1", "2", "3"}, {0, 0, 1, 1, 2, 2, 1, 1, 2, 2}};
  EXPECT_EQ(reason_of({3, 2, 0, 0, 0, 0, 4, 1, 2, 2}, {a, b}), kSeparated);
}

TEST(CountModel, SaysSoIfSeparationIsOneOfManyDirections) {
  const Factor a{"a", {"1", "2", "3", "4"}, {0, 1, 1, 0, 2, 1, 3, 3, 0, 2}};
  const Factor b{"b", {"1", "2", "3"}, {1, 1, 1, 0, 2, 2, 1, 1, 1, 1}};
  const Factor c{"c", {"1", "2"}, {1, 1, 0, 1, 1, 0, 1, 0, 1, 1}};
  EXPECT_EQ(reason_of({0, 1, 0, 7, 1, 0, 0, 4, 0, 0}, {a, b, c}), kSeparated);
}

TEST(CountModel, FitsWhereOnlyZerosTellTwoFactorsApart) {
  // Newton's steps end in rounding here that is large against a fixed step, as the likelihood is almost flat.
  const Factor a{"a", {"1", "2"}, {0, 1, 0, 0, 0, 1, 1}};
  const Factor b{"b", {"1", "2"}, {1, 1, 0, 1, 1, 1, 0}};
  const Factor c{"c", {"1", "2"}, {0, 0, 0, 0, 1, 1, 1}};
  const auto model = fit_main_effects({48391, 0, 6068, 0, 0, 13715, 2930}, {a, b, c});
  ASSERT_TRUE(model) << model.reason();
  EXPECT_NEAR(model->fixed.coefficients[1], model->fixed.coefficients[3], 1e-6);  // a and c enter alike
}

TEST(CountModel, NamesWhatItCannotTake) {
  const std::vector<double> counts{1, 2, 3};
  EXPECT_THROW((void)fit_main_effects(counts, {kTwoStrategies}), std::invalid_argument);
  EXPECT_THROW((void)fit_main_effects(counts, {Factor{"f", {"a"}, {0, 0, 1}}}), std::invalid_argument);
}

// Under the null the likelihood-ratio test's p-values are uniform, here to what 400 data sets tell: four standard
// deviations of a share of p below 0.1, 4 sqrt(0.1 0.9 / 400) = 0.06. The counts are geometric (theta = 1).
TEST(CountModel, RejectsATrueHypothesisAsOftenAsItSays) {
  auto random = RandomStream{2}.split("null");
  const std::size_t observations = 200;
  Factor groups{"group", {"a", "b", "c"}, {}};
  for (std::size_t i = 0; i < observations; ++i) groups.codes.push_back(i % 3);
  int rejected = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<double> counts;
    for (std::size_t i = 0; i < observations; ++i)
      counts.push_back(std::floor(std::log1p(-uniform01(random)) / std::log(0.8)));
    const auto model = fit_main_effects(counts, {groups});
    ASSERT_TRUE(model);
    if (model->term_tests.front().test->p < 0.1) ++rejected;
  }
  EXPECT_NEAR(rejected / 400.0, 0.1, 0.06);
}

}  // namespace
}  // namespace kith
