#include "kith/stats/mixed_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "common.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::relative_error;

constexpr double kEstimates = 1e-6;      // relative
constexpr double kSatterthwaite = 1e-4;  // lmerTest differentiates numerically
constexpr double kContrasts = 1e-5;      // lmerTest rounds contrasts of type III to seven digits

const json& mixed_reference() {
  static const json read = testing::read_reference("mixed.json");
  return read;
}

struct MixedData {
  std::vector<double> response;
  std::vector<Factor> factors;
  std::vector<std::vector<std::size_t>> terms;
  std::vector<Factor> groups;
  MixedModelOptions options;
};

MixedData read_mixed(const json& entry) {
  MixedData data{entry.at("y"),
                 testing::read_factors(entry.at("factors")),
                 entry.at("terms"),
                 testing::read_factors(entry.at("groups")),
                 {}};
  data.options.reml = entry.at("reml");
  data.options.confidence = mixed_reference().at("confidence");
  return data;
}

Estimable<MixedModel> fit(const MixedData& data) {
  return fit_mixed_model(data.response, data.factors, data.terms, data.groups, data.options);
}

// The combination of all columns that has these weights of the kept ones.
std::vector<double> whole_combination(const FactorDesign& design, const std::vector<double>& kept) {
  std::vector<double> combination(design.columns.size(), 0.0);
  for (std::size_t k = 0; k < kept.size(); ++k) combination[design.kept[k]] = kept[k];
  return combination;
}

void expect_terms(const std::vector<TermTest>& actual, const json& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t t = 0; t < actual.size(); ++t) {
    const auto& row = expected[t];
    SCOPED_TRACE(actual[t].name);
    EXPECT_EQ(actual[t].name, row.at("name"));
    EXPECT_EQ(actual[t].df, row.at("df").get<std::size_t>());
    ASSERT_TRUE(actual[t].test) << actual[t].test.reason();
    EXPECT_LE(relative_error(actual[t].test->statistic, row.at("f")), kContrasts);
    EXPECT_LE(relative_error(actual[t].test->df[1], row.at("denominator")), kSatterthwaite);
    EXPECT_LE(relative_error(actual[t].test->p, row.at("p")), kSatterthwaite);
  }
}

TEST(MixedModel, EqualsLmer) {
  EXPECT_GE(mixed_reference().at("mixed").size(), 10u);
  for (const auto& entry : mixed_reference().at("mixed")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(read_mixed(entry));
    ASSERT_TRUE(model) << model.reason();
    EXPECT_LE(relative_error(std::sqrt(model->residual_variance), entry.at("sigma")), kEstimates);
    EXPECT_NEAR(model->log_likelihood, entry.at("log_likelihood"), 1e-6);
    ASSERT_EQ(model->components.size(), entry.at("variances").size());
    double total = model->residual_variance;
    for (std::size_t k = 0; k < model->components.size(); ++k) {
      const auto& component = model->components[k];
      const double variance = entry.at("variances")[k];
      EXPECT_LE(relative_error(component.variance, variance), kEstimates) << component.name;
      EXPECT_EQ(component.variance == 0.0, variance == 0.0);
      ASSERT_TRUE(component.test) << component.test.reason();
      EXPECT_NEAR(component.test->statistic, entry.at("likelihood_ratios")[k].get<double>(), 1e-6);
      total += variance;
    }
    EXPECT_EQ(model->singular, entry.at("variances").at(0) == 0.0);
    EXPECT_NEAR(*model->fixed.residual_sd, std::sqrt(total), kEstimates * std::sqrt(total));
  }
}

TEST(MixedModel, CombinationsHaveSatterthwaitesDegreesOfFreedom) {
  for (const auto& entry : mixed_reference().at("mixed")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(read_mixed(entry));
    ASSERT_TRUE(model) << model.reason();
    for (const auto& row : entry.at("combinations")) {
      const auto combination = whole_combination(model->fixed.design, row.at("weights"));
      const double size = std::abs(row.at("se").get<double>());
      const double estimate =
          std::inner_product(combination.begin(), combination.end(), model->fixed.coefficients.begin(), 0.0);
      EXPECT_NEAR(estimate, row.at("estimate").get<double>(), kEstimates * size);
      EXPECT_LE(relative_error(model->fixed.df(combination), row.at("df")), kSatterthwaite);
      // One row of a design with missing cells is a coefficient that depends on the coding: not estimable as such.
      const auto inference = estimate_combination(model->fixed, "", combination).inference;
      if (!inference) continue;
      EXPECT_LE(relative_error(inference->standard_error, size), kEstimates);
      if (std::abs(estimate) > 1e6 * size) {
        EXPECT_LT(inference->p, 1e-100);  // R's p is that of the centred response
      } else {
        EXPECT_LE(relative_error(inference->p, row.at("p")), kSatterthwaite);
      }
    }
  }
}

TEST(MixedModel, TermsAreTestedAsByLmerTest) {
  for (const auto& entry : mixed_reference().at("mixed")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(read_mixed(entry));
    ASSERT_TRUE(model) << model.reason();
    expect_terms(term_tests(model->fixed, SumsOfSquares::kTypeII), entry.at("type2"));
    expect_terms(term_tests(model->fixed, SumsOfSquares::kTypeIII), entry.at("type3"));
  }
}

TEST(MixedModel, IntraclassCorrelationsHaveIntervals) {
  for (const auto& entry : mixed_reference().at("mixed")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit(read_mixed(entry));
    ASSERT_TRUE(model) << model.reason();
    for (std::size_t k = 0; k < model->components.size(); ++k) {
      const auto& interval = model->components[k].intraclass_interval;
      const auto& expected = entry.at("intervals")[k];
      if (expected.empty()) {
        EXPECT_EQ(interval.reason(), "its variance is zero");
        continue;
      }
      ASSERT_TRUE(interval) << interval.reason();
      EXPECT_NEAR(interval->low, expected[0].get<double>(), 1e-6);
      EXPECT_NEAR(interval->high, expected[1].get<double>(), 1e-6);
      EXPECT_DOUBLE_EQ(interval->estimate, model->components[k].intraclass_correlation);
    }
  }
}

// Balanced one-way data: the estimates of the analysis of variance.
TEST(MixedModel, BalancedGroupsHaveTheMeanSquaresEstimates) {
  const std::vector<double> y{1, 3, 6, 8, 2, 4};
  const Factor group{"g", {"a", "b", "c"}, {0, 0, 1, 1, 2, 2}};
  const auto model = fit_mixed_model(y, {}, {}, std::vector{group});
  ASSERT_TRUE(model);
  // Means 2, 7, 3: mean squares 14 between and 2 within.
  EXPECT_NEAR(model->residual_variance, 2.0, 1e-9);
  EXPECT_NEAR(model->components[0].variance, 6.0, 1e-8);
  EXPECT_NEAR(model->components[0].intraclass_correlation, 0.75, 1e-9);
  EXPECT_NEAR(model->fixed.coefficients[0], 4.0, 1e-12);
  EXPECT_NEAR(model->fixed.df(std::vector{1.0}), 2.0, 1e-6);  // groups - 1
  EXPECT_EQ(model->components[0].groups, 3u);
  EXPECT_FALSE(model->singular);
}

TEST(MixedModel, ScaleAndCentreOfTheResponseDoNotMatter) {
  auto data = read_mixed(mixed_reference().at("mixed").at(2));
  const auto model = fit(data);
  for (auto& value : data.response) value = std::ldexp(value - 3.0, 300);
  const auto scaled = fit(data);
  ASSERT_TRUE(model && scaled);
  EXPECT_NEAR(scaled->components[0].intraclass_correlation, model->components[0].intraclass_correlation, 1e-9);
  EXPECT_NEAR(std::ldexp(scaled->fixed.coefficients[1], -300), model->fixed.coefficients[1], 1e-9);
  EXPECT_NEAR(scaled->fixed.df(whole_combination(scaled->fixed.design, {0.0, 1.0})),
              model->fixed.df(whole_combination(model->fixed.design, {0.0, 1.0})), 1e-6);
}

TEST(MixedModel, OrderOfGroupsAndUnusedLevelsDoNotMatter) {
  for (const auto& entry : mixed_reference().at("mixed")) {
    auto data = read_mixed(entry);
    if (data.groups.size() < 2) continue;
    SCOPED_TRACE(entry.at("name").get<std::string>());
    data.options.test_variances = false;
    const auto model = fit(data);
    std::reverse(data.groups.begin(), data.groups.end());
    data.groups[0].levels.push_back("nobody");
    const auto reversed = fit(data);
    ASSERT_TRUE(model && reversed);
    EXPECT_NEAR(reversed->log_likelihood, model->log_likelihood, 1e-8);
    EXPECT_LE(relative_error(reversed->components.back().variance, model->components.front().variance), 1e-7);
    EXPECT_EQ(reversed->components.front().groups, model->components.back().groups);
    EXPECT_FALSE(reversed->components.front().test);
  }
}

std::string reason_of(const std::vector<double>& y, const std::vector<Factor>& factors,
                      const std::vector<Factor>& groups) {
  std::vector<std::vector<std::size_t>> terms;
  for (std::size_t f = 0; f < factors.size(); ++f) terms.push_back({f});
  const auto model = fit_mixed_model(y, factors, terms, groups);
  EXPECT_FALSE(model);
  return model.reason();
}

TEST(MixedModel, WhatCannotBeFittedHasAReason) {
  const std::vector<double> y{1, 3, 6, 8, 2, 4};
  const Factor group{"team", {"a", "b", "c"}, {0, 0, 1, 1, 2, 2}};
  const Factor renamed{"crew", {"x", "y", "z"}, {2, 2, 0, 0, 1, 1}};
  const Factor single{"row", {"1", "2", "3", "4", "5", "6"}, {0, 1, 2, 3, 4, 5}};
  const Factor all{"study", {"a"}, {0, 0, 0, 0, 0, 0}};
  using ::testing::HasSubstr;
  EXPECT_THAT(reason_of({}, {}, {Factor{"team", {}, {}}}), HasSubstr("no observations"));
  EXPECT_THAT(reason_of(y, {}, {single}), HasSubstr("every row has a row of its own"));
  EXPECT_THAT(reason_of(y, {}, {all}), HasSubstr("all rows have the same study"));
  EXPECT_THAT(reason_of(y, {}, {group, renamed}), HasSubstr("team and crew divide the rows"));
  EXPECT_THAT(reason_of(y, {single}, {group}), HasSubstr("no more observations than coefficients"));
  EXPECT_THAT(reason_of({5, 5, 5, 5, 5, 5}, {}, {group}), HasSubstr("no spread around"));
  EXPECT_THAT(reason_of({1, 1, 2, 2, 4, 4}, {}, {group}), HasSubstr("no spread of rows within"));
  EXPECT_THAT(reason_of(y, {renamed}, {group}), HasSubstr("the factors of the model already tell every team apart"));
}

TEST(MixedModel, TooManyCrossedGroupsHaveAReason) {
  constexpr std::size_t kLevels = 6'000;
  Factor person{"person", std::vector<std::string>(kLevels, "p"), {}};
  Factor item{"item", std::vector<std::string>(kLevels, "i"), {}};
  std::vector<double> y;
  for (std::size_t i = 0; i < 10 * kLevels; ++i) {
    person.codes.push_back(i % kLevels);
    auto scattered = (i + 1) * 0x9E3779B97F4A7C15u;
    scattered = (scattered ^ (scattered >> 30)) * 0xBF58476D1CE4E5B9u;
    item.codes.push_back((scattered ^ (scattered >> 27)) % kLevels);
    y.push_back(static_cast<double>(i % 7));
  }
  const auto model = fit_mixed_model(y, {}, {}, std::vector{person, item});
  ASSERT_FALSE(model);
  EXPECT_EQ(model.reason(), "too many groups are crossed with one another");
}

TEST(MixedModel, CallersMistakesThrow) {
  const std::vector<double> y{1, 3, 6, 8};
  const Factor group{"g", {"a", "b"}, {0, 0, 1, 1}};
  const Factor shorter{"g", {"a", "b"}, {0, 1}};
  EXPECT_THROW((void)fit_mixed_model(y, {}, {}, {}), std::invalid_argument);
  EXPECT_THROW((void)fit_mixed_model(y, {}, {}, std::vector{shorter}), std::invalid_argument);
  EXPECT_THROW((void)fit_mixed_model(y, std::vector{shorter}, {}, std::vector{group}), std::invalid_argument);
  EXPECT_THROW((void)fit_mixed_model(y, {}, {}, std::vector{group}, {.confidence = 1.0}), std::invalid_argument);
  const std::vector<double> infinite{1, 3, 6, testing::kInfinity};
  EXPECT_THROW((void)fit_mixed_model(infinite, {}, {}, std::vector{group}), std::invalid_argument);
  EXPECT_THROW((void)group_factor({}), std::invalid_argument);
  EXPECT_THROW((void)group_factor(std::vector{group, shorter}), std::invalid_argument);
}

TEST(MixedModel, GroupsOfSeveralColumnsAreTheirCombinations) {
  const Factor team{"team", {"x", "y", "z"}, {2, 0, 0, 2, 2}};
  const Factor member{"member", {"1", "2"}, {1, 0, 1, 1, 0}};
  const auto groups = group_factor(std::vector{team, member});
  EXPECT_EQ(groups.name, "team:member");
  EXPECT_THAT(groups.levels, ::testing::ElementsAre("z:2", "x:1", "x:2", "z:1"));
  EXPECT_THAT(groups.codes, ::testing::ElementsAre(0, 1, 2, 0, 3));
}

TEST(MixedModel, ATermThatAddsNothingHasAReason) {
  const std::vector<double> y{1, 3, 6, 8, 2, 5, 4, 4.5};
  const Factor group{"g", {"a", "b"}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const Factor factor{"f", {"a", "b"}, {0, 1, 0, 1, 0, 1, 0, 1}};
  const Factor same{"s", {"a", "b"}, {0, 1, 0, 1, 0, 1, 0, 1}};
  const auto model = fit_mixed_model(y, std::vector{factor, same}, std::vector<std::vector<std::size_t>>{{0}, {1}},
                                     std::vector{group});
  ASSERT_TRUE(model) << model.reason();
  const auto tests = term_tests(model->fixed, SumsOfSquares::kTypeIII);
  ASSERT_EQ(tests.size(), 2u);
  EXPECT_FALSE(tests[1].test);
  EXPECT_EQ(tests[1].df, 0u);
}

}  // namespace
}  // namespace kith
