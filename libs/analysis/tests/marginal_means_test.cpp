// Marginal means and contrasts against emmeans on the data sets of reference/make_reference_means.R.
#include "kith/analysis/marginal_means.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common.hpp"
#include "kith/analysis/anova.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;

constexpr double kConfidence = 0.9;

const json& means_reference() {
  static const json read = testing::read_reference("means.json");
  return read;
}

Factor lettered_factor(const std::string& name, const std::vector<std::size_t>& codes) {
  Factor factor{name, {}, codes};
  for (std::size_t level = 0; level <= *std::max_element(codes.begin(), codes.end()); ++level)
    factor.levels.emplace_back(1, static_cast<char>('a' + static_cast<int>(level)));
  return factor;
}

std::vector<Factor> factors_of(const json& entry) {
  std::vector<Factor> factors;
  for (const auto& codes : entry.at("factors"))
    factors.push_back(
        lettered_factor(std::string(1, static_cast<char>('a' + static_cast<int>(factors.size()))), codes));
  return factors;
}

std::vector<MarginalGroup> means_of(const FixedEffects& model, const json& request) {
  const auto& by = request.at("by");
  return marginal_means(model, request.at("over").at(0),
                        by.empty() ? std::nullopt : std::optional<std::size_t>{by.at(0)}, kConfidence);
}

void expect_p(double actual, double expected, double relative, const std::string& what) {
  EXPECT_NEAR(actual, expected, relative * expected + 1e-14) << what;
}

// Within 1e-8 of the standard error.
void expect_estimate(const LinearEstimate& actual, const json& row, double interval_tolerance,
                     const std::string& what) {
  ASSERT_TRUE(actual.inference) << what << ": " << actual.inference.reason();
  const double se = row.at("se");
  EXPECT_NEAR(actual.estimate, row.at("estimate"), 1e-8 * se) << what;
  EXPECT_NEAR(actual.inference->standard_error, se, 1e-9 * se) << what;
  EXPECT_EQ(actual.inference->df, row.at("df").get<double>()) << what;
  EXPECT_NEAR(actual.inference->low, row.at("low"), interval_tolerance * se) << what;
  EXPECT_NEAR(actual.inference->high, row.at("high"), interval_tolerance * se) << what;
}

template <typename Check>
void for_every_group(Check check) {
  for (const auto& entry : means_reference().at("data_sets")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto table = anova(entry.at("y").get<std::vector<double>>(), factors_of(entry),
                             entry.at("terms").get<std::vector<std::vector<std::size_t>>>());
    const double sigma = entry.at("sigma");
    EXPECT_NEAR(*table.effects->residual_sd, sigma, 1e-9 * sigma);
    for (const auto& request : entry.at("requests")) {
      SCOPED_TRACE("over " + request.at("over").dump() + " by " + request.at("by").dump());
      const auto groups = means_of(*table.effects, request);
      std::size_t first = 0;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        check(*table.effects, groups[g], request.at("means"), first, request.at("groups").at(g));
        first += groups[g].means.size();
      }
      EXPECT_EQ(first, request.at("means").size());
    }
  }
}

TEST(AgainstEmmeans, MarginalMeansEqual) {
  for_every_group([](const auto&, const MarginalGroup& group, const json& rows, std::size_t first, const json&) {
    for (const auto& mean : group.means) {
      const auto& row = rows.at(first++);
      expect_estimate(mean, row, 1e-7, group.name + " " + mean.name);
      expect_p(mean.inference->p, row.at("p"), 1e-8, mean.name);
    }
  });
}

// All pairs as contrasts, so that every correction can be compared.
std::vector<MeanContrast> pairs_of(const MarginalGroup& group) {
  std::vector<MeanContrast> pairs;
  for (std::size_t first = 0; first < group.means.size(); ++first) {
    for (auto second = first + 1; second < group.means.size(); ++second) {
      pairs.push_back({"pair", std::vector<double>(group.means.size(), 0.0)});
      pairs.back().weights[first] = -1.0;
      pairs.back().weights[second] = 1.0;
    }
  }
  return pairs;
}

TEST(AgainstEmmeans, PairsWithEveryCorrectionEqual) {
  for_every_group([](const FixedEffects& model, const MarginalGroup& group, const json&, std::size_t, const json& of) {
    for (const auto& [name, correction] :
         {std::pair{"none", Correction::kNone}, std::pair{"bonferroni", Correction::kBonferroni},
          std::pair{"holm", Correction::kHolm}, std::pair{"fdr", Correction::kFdr}}) {
      const auto pairs = estimate_contrasts(model, group, pairs_of(group), correction, kConfidence);
      const auto& expected = of.at(name);
      ASSERT_EQ(pairs.size(), expected.size());
      const double interval = correction == Correction::kFdr ? testing::kInfinity : 1e-7;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        expect_estimate(pairs[i], expected[i], interval, name);
        expect_p(pairs[i].inference->p, expected[i].at("p"), 1e-8, name);
      }
    }
  });
}

TEST(AgainstEmmeans, TukeyKramerPairsEqualTheirIntegralAndEmmeans) {
  std::size_t compared = 0;
  for_every_group([&](const FixedEffects& model, const MarginalGroup& group, const json&, std::size_t, const json& of) {
    const auto pairs = estimate_pairs(model, group, kConfidence);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& integral = of.at("tukey_integral").at(i);
      const auto& row = of.at("tukey").at(i);
      if (integral.is_null()) continue;
      expect_p(pairs[i].inference->p, integral, integral.get<double>() > 1e-6 ? 1e-7 : 1.0, pairs[i].name);
      if (std::abs(row.at("p").get<double>() - integral.get<double>()) > 1e-6) continue;
      expect_estimate(pairs[i], row, 5e-3, pairs[i].name);
      ++compared;
    }
  });
  EXPECT_GE(compared, 40u);
}

TEST(AgainstEmmeans, PlannedContrastsEqual) {
  std::size_t compared = 0;
  for_every_group([&](const FixedEffects& model, const MarginalGroup& group, const json&, std::size_t, const json& of) {
    for (const auto& row : of.at("custom")) {
      const std::vector<MeanContrast> contrast{{"planned", row.at("weights")}};
      const auto estimate = estimate_contrasts(model, group, contrast, Correction::kNone).at(0);
      expect_estimate(estimate, row, 1e-7, row.at("weights").dump());
      expect_p(estimate.inference->p, row.at("p"), 1e-8, "p");
      ++compared;
    }
  });
  EXPECT_GE(compared, 11u);
}

const Factor kGroup{"group", {"a", "b"}, {0, 0, 1, 1}};

TEST(MarginalMeans, HaveNoStandardErrorsWithoutSpread) {
  const auto table = anova(std::vector{0.1, 0.1, 0.7, 0.7}, std::vector{kGroup}, testing::kAlone);
  EXPECT_EQ(table.effects->no_standard_errors, "no spread within the cells");
  const auto mean = marginal_means(*table.effects, 0).at(0).means.at(1);
  EXPECT_NEAR(mean.estimate, 0.7, 1e-15);
  EXPECT_FALSE(mean.inference);
}

TEST(MarginalMeans, OfOneObservationPerGroupSayWhyThereAreNoStandardErrors) {
  const Factor group{"group", {"a", "b"}, {0, 1}};
  const auto model = *anova(std::vector{1.0, 3.0}, std::vector{group}, testing::kAlone).effects;
  const auto pair = estimate_pairs(model, marginal_means(model, 0).at(0)).at(0);
  EXPECT_EQ(pair.name, "b - a");
  EXPECT_NEAR(pair.estimate, 2.0, 1e-15);
  EXPECT_EQ(pair.inference.reason(), "no residual degrees of freedom: as many parameters as observations");
}

TEST(MarginalMeans, OfHugeAndTinyValuesStayFinite) {
  for (const int exponent : {-500, 0, 500}) {
    std::vector<double> response{1.0, 2.0, 4.0, 7.0};
    for (auto& value : response) value = std::ldexp(value, exponent);
    const auto model = *anova(response, std::vector{kGroup}, testing::kAlone).effects;
    const auto pair = estimate_pairs(model, marginal_means(model, 0).at(0)).at(0);
    EXPECT_NEAR(std::ldexp(pair.estimate, -exponent), 4.0, 1e-14) << exponent;
    EXPECT_NEAR(pair.inference->statistic, 4.0 / std::sqrt(2.5), 1e-14) << exponent;
  }
  EXPECT_FALSE(anova(std::vector{1e300, 2e300, 4e300, 7e300}, std::vector{kGroup}, testing::kAlone).effects);
}

// Far from 0, differences keep all digits of the values.
TEST(MarginalMeans, DifferencesDoNotDependOnWhereTheValuesLie) {
  const auto model =
      *anova(std::vector{1e9 + 1.0, 1e9 + 2.0, 1e9 + 4.0, 1e9 + 7.0}, std::vector{kGroup}, testing::kAlone).effects;
  EXPECT_NEAR(estimate_pairs(model, marginal_means(model, 0).at(0)).at(0).estimate, 4.0, 1e-12);
}

TEST(MarginalMeans, RejectFactorsThatAreNone) {
  const auto model = *anova(std::vector{1.0, 2.0, 4.0, 7.0}, std::vector{kGroup}, testing::kAlone).effects;
  EXPECT_THROW((void)marginal_means(model, 1), std::invalid_argument);
  EXPECT_THROW((void)marginal_means(model, 0, 0), std::invalid_argument);
  EXPECT_THROW((void)estimate_combination(model, "short", {1.0}), std::invalid_argument);
}

TEST(Contrasts, MustHaveWeightsThatSumToZero) {
  EXPECT_EQ(contrast_error(std::vector{1.0, -0.5, -0.5}, 3), "");
  EXPECT_EQ(contrast_error(std::vector{1.0, -0.3333333, -0.3333333, -0.3333333}, 4), "");
  EXPECT_EQ(contrast_error(std::vector{1.0, -0.5}, 3), "it has 2 weights for 3 means");
  EXPECT_EQ(contrast_error(std::vector{0.0, 0.0}, 2), "all its weights are zero");
  EXPECT_NE(contrast_error(std::vector{1.0, -0.5}, 2), "");
  EXPECT_NE(contrast_error(std::vector{1.0, testing::kInfinity}, 2), "");
  const auto model = *anova(std::vector{1.0, 2.0, 4.0, 7.0}, std::vector{kGroup}, testing::kAlone).effects;
  const auto means = marginal_means(model, 0).at(0);
  EXPECT_THROW((void)estimate_contrasts(model, means, std::vector<MeanContrast>{{"x", {1.0, 1.0}}}, Correction::kNone),
               std::invalid_argument);
}

}  // namespace
}  // namespace kith
