// Marginal means and contrasts against emmeans on the data sets of reference/make_reference_means.R.
#include "kith/analysis/marginal_means.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common.hpp"
#include "kith/analysis/linear_model.hpp"
#include "kith/analysis/moments.hpp"
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

// Of other models than linear ones R's coefficients are taken: this is about what follows from them.
FixedEffects effects_of(const json& entry) {
  const std::vector<double> response = entry.at("y");
  const std::vector<std::vector<std::size_t>> terms = entry.at("terms");
  const auto factors = factors_of(entry);
  if (entry.at("family") == "normal") return fit_linear_model(response, factors, terms).value().effects;
  std::vector<double> coefficients;
  for (const auto& coefficient : entry.at("coefficients")) {
    if (!coefficient.is_null()) coefficients.push_back(coefficient);
  }
  const std::vector<double> covariance = entry.at("covariance");
  return make_fixed_effects(*make_factor_design(response.size(), factors, terms), coefficients, covariance,
                            [](auto) { return testing::kInfinity; });
}

MarginalMeans means_of(const FixedEffects& model, const json& request) {
  const std::vector<std::size_t> over = request.at("over");
  const std::vector<std::size_t> by = request.at("by");
  return marginal_means(model, over, by, kConfidence);
}

// Within 1e-8 of the standard error; p within 1e-8 of itself or 1e-14.
void expect_estimate(const LinearEstimate& actual, const json& row, double interval_tolerance,
                     const std::string& what) {
  ASSERT_EQ(static_cast<bool>(actual.estimate), !row.at("estimate").is_null()) << what << actual.estimate.reason();
  if (!actual.estimate) {
    EXPECT_FALSE(actual.estimate.reason().empty()) << what;
    EXPECT_EQ(actual.inference.reason(), actual.estimate.reason()) << what;
    return;
  }
  ASSERT_TRUE(actual.inference) << what << ": " << actual.inference.reason();
  const double se = row.at("se");
  EXPECT_NEAR(*actual.estimate, row.at("estimate"), 1e-8 * se) << what;
  EXPECT_NEAR(actual.inference->standard_error, se, 1e-9 * se) << what;
  EXPECT_EQ(actual.inference->df, row.at("df").is_null() ? testing::kInfinity : row.at("df").get<double>()) << what;
  if (row.at("low").is_null()) return;
  EXPECT_NEAR(actual.inference->low, row.at("low"), interval_tolerance * se) << what;
  EXPECT_NEAR(actual.inference->high, row.at("high"), interval_tolerance * se) << what;
}

void expect_p(double actual, double expected, double relative, const std::string& what) {
  EXPECT_NEAR(actual, expected, relative * expected + 1e-14) << what;
}

template <typename Check>
void for_every_request(Check check) {
  for (const auto& entry : means_reference().at("data_sets")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = effects_of(entry);
    for (const auto& request : entry.at("requests")) {
      SCOPED_TRACE("over " + request.at("over").dump() + " by " + request.at("by").dump());
      check(model, means_of(model, request), request);
    }
  }
}

TEST(AgainstEmmeans, ThereAreAtLeastTwentyDataSets) { EXPECT_GE(means_reference().at("data_sets").size(), 20u); }

TEST(AgainstEmmeans, CoefficientsAndCovariancesOfLinearModelsEqual) {
  for (const auto& entry : means_reference().at("data_sets")) {
    if (entry.at("family") != "normal") continue;
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const auto model = fit_linear_model(entry.at("y").get<std::vector<double>>(), factors_of(entry),
                                        entry.at("terms").get<std::vector<std::vector<std::size_t>>>())
                           .value();
    const double sigma = entry.at("sigma");
    EXPECT_EQ(static_cast<double>(model.residual_df), entry.at("df").get<double>());
    EXPECT_NEAR(*model.effects.residual_sd, sigma, 1e-9 * sigma);
    const auto& design = model.effects.design;
    ASSERT_EQ(design.columns.size(), entry.at("coefficients").size());
    for (std::size_t j = 0; j < design.columns.size(); ++j) {
      const bool kept = std::find(design.kept.begin(), design.kept.end(), j) != design.kept.end();
      ASSERT_EQ(kept, !entry.at("coefficients")[j].is_null()) << design.columns[j];
      if (!kept) continue;
      EXPECT_NEAR(model.effects.coefficients[j], entry.at("coefficients")[j], 1e-8 * sigma);
    }
    for (std::size_t i = 0; i < design.kept.size(); ++i) {
      for (std::size_t j = 0; j < design.kept.size(); ++j)
        EXPECT_NEAR(model.effects.covariance[design.kept[i] * design.columns.size() + design.kept[j]],
                    entry.at("covariance")[i * design.kept.size() + j], 1e-9 * sigma * sigma);
    }
  }
}

TEST(AgainstEmmeans, MarginalMeansEqual) {
  for_every_request([](const FixedEffects&, const MarginalMeans& means, const json& request) {
    std::size_t i = 0;
    for (const auto& group : means.groups) {
      for (const auto& mean : group.means) {
        const auto& row = request.at("means").at(i++);
        expect_estimate(mean, row, 1e-7, group.name + " " + mean.name);
        if (mean.inference) expect_p(mean.inference->p, row.at("p"), 1e-8, mean.name);
      }
    }
    EXPECT_EQ(i, request.at("means").size());
  });
}

// emmeans counts pairs that cannot be estimated in their family; here they do not count.
TEST(AgainstEmmeans, PairsWithEveryAdjustmentEqual) {
  for_every_request([](const FixedEffects& model, const MarginalMeans& means, const json& request) {
    for (std::size_t g = 0; g < means.groups.size(); ++g) {
      const auto& group = means.groups[g];
      const auto& expected = request.at("groups").at(g);
      const bool complete = std::none_of(expected.at("none").begin(), expected.at("none").end(),
                                         [](const auto& row) { return row.at("estimate").is_null(); });
      for (const auto& [name, adjustment] :
           {std::pair{"none", Adjustment::kNone}, std::pair{"bonferroni", Adjustment::kBonferroni},
            std::pair{"holm", Adjustment::kHolm}, std::pair{"fdr", Adjustment::kFdr}}) {
        const auto pairs = estimate_contrasts(model, group, pairwise_contrasts(group), adjustment, kConfidence);
        ASSERT_EQ(pairs.size(), expected.at(name).size());
        if (!complete && adjustment != Adjustment::kNone) continue;
        const double interval = adjustment == Adjustment::kFdr ? testing::kInfinity : 1e-7;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          const auto& row = expected.at(name)[i];
          const auto what = std::string{name} + " " + group.name + " " + pairs[i].name;
          expect_estimate(pairs[i], row, interval, what);
          if (pairs[i].inference) expect_p(pairs[i].inference->p, row.at("p"), 1e-8, what);
        }
      }
    }
  });
}

TEST(AgainstEmmeans, TukeyKramerPairsEqualTheirIntegralAndEmmeans) {
  std::size_t compared = 0;
  for_every_request([&](const FixedEffects& model, const MarginalMeans& means, const json& request) {
    for (std::size_t g = 0; g < means.groups.size(); ++g) {
      const auto& group = means.groups[g];
      const auto& expected = request.at("groups").at(g);
      const auto pairs = estimate_contrasts(model, group, pairwise_contrasts(group), Adjustment::kTukey, kConfidence);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& integral = expected.at("tukey_integral").at(i);
        const auto& row = expected.at("tukey").at(i);
        if (!pairs[i].inference || integral.is_null()) continue;
        expect_p(pairs[i].inference->p, integral, integral.get<double>() > 1e-6 ? 1e-7 : 1.0, pairs[i].name);
        const bool complete = std::none_of(expected.at("none").begin(), expected.at("none").end(),
                                           [](const auto& each) { return each.at("estimate").is_null(); });
        if (!complete || std::abs(row.at("p").get<double>() - integral.get<double>()) > 1e-6) continue;
        expect_estimate(pairs[i], row, 5e-3, pairs[i].name);
        ++compared;
      }
    }
  });
  EXPECT_GE(compared, 100u);
}

TEST(AgainstEmmeans, PlannedContrastsEqual) {
  std::size_t compared = 0;
  for_every_request([&](const FixedEffects& model, const MarginalMeans& means, const json& request) {
    for (std::size_t g = 0; g < means.groups.size(); ++g) {
      for (const auto& row : request.at("groups").at(g).at("custom")) {
        const std::vector<MeanContrast> contrast{{"planned", row.at("weights")}};
        const auto estimate = estimate_contrasts(model, means.groups[g], contrast, Adjustment::kNone).at(0);
        expect_estimate(estimate, row, 1e-7, row.at("weights").dump());
        if (estimate.inference) expect_p(estimate.inference->p, row.at("p"), 1e-8, "p");
        ++compared;
      }
    }
  });
  EXPECT_GE(compared, 15u);
}

TEST(MarginalMeans, CountEveryCombinationOnce) {
  const Factor a{"a", {"x", "y"}, {0, 0, 0, 1, 1, 1}};
  const Factor b{"b", {"u", "v"}, {0, 0, 1, 0, 1, 1}};
  const auto model =
      fit_linear_model(std::vector{1.0, 2.0, 6.0, 4.0, 5.0, 9.0}, std::vector{a, b}, testing::kCrossed).value();
  const auto means = marginal_means(model.effects, std::vector<std::size_t>{0}).groups.at(0).means;
  EXPECT_NEAR(*means.at(0).estimate, 3.75, 1e-14);  // the raw mean is 3
}

// The finding of a confounded factor, which raw means turn upside down.
TEST(MarginalMeans, OfAConfoundedFactorDoNotTakeTheOtherFactorsEffect) {
  Factor strategy{"strategy", {"common", "joint"}, {}};
  Factor composition{"composition", {"low", "high"}, {}};
  std::vector<double> response;
  const auto add = [&](std::size_t s, std::size_t c, int times) {
    for (int i = 0; i < times; ++i) {
      strategy.codes.push_back(s);
      composition.codes.push_back(c);
      response.push_back(1.0 * static_cast<double>(c) + (i % 2 == 0 ? 0.1 : -0.1));
    }
  };
  add(0, 0, 40);
  add(0, 1, 4);
  add(1, 0, 4);
  add(1, 1, 40);
  const auto model =
      fit_linear_model(response, std::vector{strategy, composition}, std::vector<std::vector<std::size_t>>{{0}, {1}})
          .value();
  const auto raw = split_by(response, strategy);
  EXPECT_NEAR(mean(raw[1]) - mean(raw[0]), 0.8181818, 1e-6);
  const auto adjusted = marginal_means(model.effects, std::vector<std::size_t>{0}).groups.at(0);
  const auto difference =
      estimate_contrasts(model.effects, adjusted, pairwise_contrasts(adjusted), Adjustment::kTukey).at(0);
  EXPECT_NEAR(*difference.estimate, 0.0, 1e-14);
  EXPECT_GT(difference.inference->p, 0.99);
}

}  // namespace
}  // namespace kith
