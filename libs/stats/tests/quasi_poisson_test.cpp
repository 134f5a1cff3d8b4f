#include "kith/stats/quasi_poisson.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using testing::relative_error;

constexpr double kQuasi = 1e-6;

TEST(QuasiPoisson, EqualsGlm) {
  const auto cases = testing::read_reference("responses.json").at("quasi_poisson");
  for (const auto& entry : cases) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const std::vector<double> counts = entry.at("counts");
    const std::vector<std::vector<std::size_t>> terms = entry.at("terms");
    const auto model = fit_quasi_poisson(counts, testing::read_factors(entry.at("factors")), terms);
    ASSERT_TRUE(model) << model.reason();
    EXPECT_LE(relative_error(model->dispersion, entry.at("dispersion")), kQuasi);
    EXPECT_EQ(model->residual_df, entry.at("residual_df").get<std::size_t>());
    const auto& kept = model->fixed.design.kept;
    const auto columns = model->fixed.design.columns.size();
    ASSERT_EQ(kept.size(), entry.at("coefficients").size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      EXPECT_NEAR(model->fixed.coefficients[kept[i]], entry.at("coefficients")[i].get<double>(), kQuasi);
      for (std::size_t j = 0; j < kept.size(); ++j) {
        EXPECT_NEAR(model->fixed.covariance[kept[i] * columns + kept[j]],
                    entry.at("covariance")[i * kept.size() + j].get<double>(), kQuasi * 1e-2);
      }
      std::vector<double> combination(columns, 0.0);
      combination[kept[i]] = 1.0;
      EXPECT_EQ(model->fixed.df(combination), entry.at("residual_df").get<double>());
      const auto inference = estimate_combination(model->fixed, "", combination).inference;
      if (!inference) continue;  // of a missing cell
      EXPECT_LE(relative_error(inference->p, entry.at("p")[i]), 1e-4);
    }
    ASSERT_EQ(model->term_tests.size(), entry.at("tests").size());
    for (std::size_t t = 0; t < model->term_tests.size(); ++t) {
      const auto& test = model->term_tests[t];
      const auto& expected = entry.at("tests")[t];
      EXPECT_EQ(test.name, expected.at("name"));
      EXPECT_EQ(test.df, expected.at("df").get<std::size_t>());
      ASSERT_TRUE(test.test) << test.test.reason();
      EXPECT_LE(relative_error(test.test->statistic, expected.at("f")), kQuasi);
      EXPECT_LE(relative_error(test.test->p, expected.at("p")), kQuasi);
    }
    EXPECT_EQ(model->fixed.link, Link::kLog);
  }
}

std::string quasi_reason(const std::vector<double>& counts, const std::vector<std::size_t>& codes) {
  const auto model = fit_quasi_poisson(counts, std::vector<Factor>{{"g", {"a", "b"}, codes}},
                                       std::vector<std::vector<std::size_t>>{{0}});
  EXPECT_FALSE(model);
  return model.reason();
}

TEST(QuasiPoisson, WhatCannotBeFittedHasAReason) {
  using ::testing::HasSubstr;
  EXPECT_THAT(quasi_reason({}, {}), HasSubstr("no observations"));
  EXPECT_THAT(quasi_reason({1, -1, 2}, {0, 1, 0}), HasSubstr("negative"));
  EXPECT_THAT(quasi_reason({0, 0, 0}, {0, 1, 0}), HasSubstr("all counts are zero"));
  EXPECT_THAT(quasi_reason({1, 2}, {0, 1}), HasSubstr("no more observations"));
  EXPECT_THAT(quasi_reason({1, 2, 0, 0}, {0, 0, 1, 1}), HasSubstr("only zeros"));
  EXPECT_THAT(quasi_reason({2, 2, 3, 3}, {0, 0, 1, 1}), HasSubstr("no spread"));
  EXPECT_THROW((void)fit_quasi_poisson(std::vector<double>{1.0, testing::kInfinity}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
