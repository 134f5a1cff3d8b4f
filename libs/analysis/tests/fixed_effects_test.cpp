#include "kith/analysis/fixed_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "common.hpp"
#include "kith/analysis/linear_model.hpp"
#include "kith/analysis/marginal_means.hpp"

namespace kith {
namespace {

using Terms = std::vector<std::vector<std::size_t>>;
using Indices = std::vector<std::size_t>;

const Factor kStrategy{"strategy", {"joint", "common", "nobody"}, {0, 0, 1, 1, 0, 1}};
const Factor kType{"type", {"novice", "expert"}, {0, 0, 0, 1, 1, 1}};

TEST(FactorDesign, CodesTermsAsRDoesAndDropsUnusedLevels) {
  const auto design = make_factor_design(6, std::vector{kStrategy, kType}, testing::kCrossed);
  ASSERT_TRUE(design) << design.reason();
  EXPECT_EQ(design->columns, (std::vector<std::string>{"(Intercept)", "strategy[common]", "type[expert]",
                                                       "strategy[common]:type[expert]"}));
  EXPECT_EQ(design->factors.at(0).levels, (std::vector<std::string>{"joint", "common"}));
  EXPECT_EQ(design->grid, (std::vector<double>{1, 0, 0, 0, 1, 0, 1, 0, 1, 1, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(design->counts, (Indices{2, 1, 1, 2}));
  EXPECT_EQ(design->kept, (Indices{0, 1, 2, 3}));
  EXPECT_TRUE(design->null_space.empty());
}

TEST(FactorDesign, NamesIndicatorsWhereTheMarginIsMissing) {
  const auto design = make_factor_design(6, std::vector{kStrategy, kType}, Terms{{0, 1}});
  ASSERT_TRUE(design) << design.reason();
  EXPECT_EQ(design->columns.size(), 5u);
  EXPECT_EQ(design->kept, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(design->null_space.size(), 5u);
}

TEST(FactorDesign, FindsTheDirectionsThatNoObservationSees) {
  // Both factors are one: only the sum of their effects can be estimated.
  const Factor twin{"twin", {"x", "y"}, {0, 0, 1, 1, 0, 1}};
  const auto design = make_factor_design(6, std::vector{kStrategy, twin}, Terms{{0}, {1}});
  ASSERT_TRUE(design) << design.reason();
  EXPECT_EQ(design->kept, (Indices{0, 1}));
  EXPECT_EQ(design->null_space, (std::vector<double>{0, -1, 1}));
}

TEST(FactorDesign, RejectsWhatIsNoDesign) {
  EXPECT_FALSE(make_factor_design(0, {}, {}));
  EXPECT_THROW((void)make_factor_design(6, std::vector{kStrategy}, Terms{{1}}), std::invalid_argument);
  EXPECT_THROW((void)make_factor_design(5, std::vector{kStrategy}, Terms{{0}}), std::invalid_argument);
  std::vector<Factor> many(24, kType);
  EXPECT_FALSE(make_factor_design(6, many, Terms{{0}}));
}

TEST(FixedEffects, TakesCoefficientsOfTheKeptColumnsOnly) {
  const Factor twin{"twin", {"x", "y"}, {0, 0, 1, 1, 0, 1}};
  const auto design = make_factor_design(6, std::vector{twin, kStrategy, kType}, Terms{{0}, {1}, {2}});
  ASSERT_EQ(design->kept, (Indices{0, 1, 3}));
  const std::vector<double> covariance{1, 2, 3, 2, 5, 6, 3, 6, 9};
  std::vector<double> asked;
  const auto model = make_fixed_effects(*design, std::vector{1.0, 2.0, 3.0}, covariance, [&](auto weights) {
    asked.assign(weights.begin(), weights.end());
    return 7.0;
  });
  EXPECT_EQ(model.coefficients, (std::vector<double>{1, 2, 0, 3}));
  EXPECT_EQ(model.covariance, (std::vector<double>{1, 2, 0, 3, 2, 5, 0, 6, 0, 0, 0, 0, 3, 6, 0, 9}));
  const auto estimate = estimate_combination(model, "type", {0, 0, 0, 2});
  EXPECT_EQ(*estimate.estimate, 6.0);
  EXPECT_EQ(estimate.inference->standard_error, 6.0);
  EXPECT_EQ(estimate.inference->df, 7.0);
  EXPECT_EQ(asked, (std::vector<double>{0, 0, 2}));
  EXPECT_FALSE(estimate_combination(model, "strategy alone", {0, 0, 1, 0}).estimate);
  EXPECT_THROW((void)estimate_combination(model, "short", {1.0}), std::invalid_argument);
  EXPECT_THROW((void)make_fixed_effects(*design, std::vector{1.0}, covariance, {}), std::invalid_argument);
}

TEST(LinearModel, HasNoStandardErrorsWithoutSpreadButKnowsTheMeans) {
  const Factor group{"group", {"a", "b"}, {0, 0, 1, 1}};
  const auto model = fit_linear_model(std::vector{0.1, 0.1, 0.7, 0.7}, std::vector{group}, Terms{{0}});
  ASSERT_TRUE(model);
  EXPECT_EQ(model->effects.no_standard_errors, "no spread within the cells");
  const auto means = marginal_means(model->effects, Indices{0});
  EXPECT_NEAR(*means.groups.at(0).means.at(1).estimate, 0.7, 1e-15);
  EXPECT_FALSE(means.groups.at(0).means.at(1).inference);
}

TEST(LinearModel, OfOneObservationPerGroupSaysWhyThereAreNoStandardErrors) {
  const Factor group{"group", {"a", "b"}, {0, 1}};
  const auto model = fit_linear_model(std::vector{1.0, 3.0}, std::vector{group}, Terms{{0}});
  ASSERT_TRUE(model);
  EXPECT_EQ(model->residual_df, 0u);
  const auto means = marginal_means(model->effects, Indices{0});
  const auto& family = means.groups.at(0);
  const auto pairs = estimate_contrasts(model->effects, family, pairwise_contrasts(family), Adjustment::kTukey);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].name, "b - a");
  EXPECT_NEAR(*pairs[0].estimate, 2.0, 1e-15);
  EXPECT_EQ(pairs[0].inference.reason(), "no residual degrees of freedom: as many parameters as observations");
}

TEST(LinearModel, MeansOfHugeAndTinyValuesStayFinite) {
  const Factor group{"group", {"a", "b"}, {0, 0, 1, 1}};
  for (const int exponent : {-500, 0, 500}) {
    std::vector<double> response{1.0, 2.0, 4.0, 7.0};
    for (auto& value : response) value = std::ldexp(value, exponent);
    const auto model = fit_linear_model(response, std::vector{group}, Terms{{0}});
    ASSERT_TRUE(model) << model.reason();
    const auto family = marginal_means(model->effects, Indices{0}).groups.at(0);
    const auto pair = estimate_contrasts(model->effects, family, pairwise_contrasts(family), Adjustment::kNone).at(0);
    EXPECT_NEAR(std::ldexp(*pair.estimate, -exponent), 4.0, 1e-14) << exponent;
    EXPECT_NEAR(pair.inference->statistic, 4.0 / std::sqrt(2.5), 1e-14) << exponent;
  }
  const auto beyond = fit_linear_model(std::vector{1e300, 2e300, 4e300, 7e300}, std::vector{group}, Terms{{0}});
  EXPECT_FALSE(beyond);
}

TEST(MarginalMeans, NameTheCombinationThatNobodyHas) {
  const Factor a{"strategy", {"joint", "common"}, {0, 0, 1, 1, 0}};
  const Factor b{"type", {"novice", "expert"}, {0, 1, 0, 0, 1}};
  const auto model = fit_linear_model(std::vector{1.0, 2.0, 3.0, 4.0, 6.0}, std::vector{a, b}, testing::kCrossed);
  ASSERT_TRUE(model);
  const auto means = marginal_means(model->effects, Indices{0}).groups.at(0);
  EXPECT_TRUE(means.means.at(0).estimate);
  EXPECT_EQ(means.means.at(1).estimate.reason(), "no observation has strategy 'common' and type 'expert'");
  const auto pair = estimate_contrasts(model->effects, means, pairwise_contrasts(means), Adjustment::kTukey).at(0);
  EXPECT_EQ(pair.estimate.reason(), "no observation has strategy 'common' and type 'expert'");
  EXPECT_EQ(pair.inference.reason(), pair.estimate.reason());
}

TEST(MarginalMeans, RejectFactorsThatAreNone) {
  const auto model =
      fit_linear_model(std::vector{1.0, 2.0, 3.0, 4.0, 6.0, 5.0}, std::vector{kStrategy, kType}, Terms{{0}, {1}});
  ASSERT_TRUE(model);
  EXPECT_THROW((void)marginal_means(model->effects, Indices{}), std::invalid_argument);
  EXPECT_THROW((void)marginal_means(model->effects, Indices{2}), std::invalid_argument);
  EXPECT_THROW((void)marginal_means(model->effects, Indices{0}, Indices{0}), std::invalid_argument);
}

TEST(Contrasts, MustHaveWeightsThatSumToZero) {
  EXPECT_EQ(contrast_error(std::vector{1.0, -0.5, -0.5}, 3), "");
  EXPECT_EQ(contrast_error(std::vector{1.0, -0.3333333, -0.3333333, -0.3333333}, 4), "");
  EXPECT_EQ(contrast_error(std::vector{1.0, -0.5}, 3), "it has 2 weights for 3 means");
  EXPECT_EQ(contrast_error(std::vector{0.0, 0.0}, 2), "all its weights are zero");
  EXPECT_NE(contrast_error(std::vector{1.0, -0.5}, 2), "");
  EXPECT_NE(contrast_error(std::vector{1.0, testing::kInfinity}, 2), "");
  const auto model = fit_linear_model(std::vector{1.0, 2.0, 3.0, 4.0, 6.0, 5.0}, std::vector{kType}, Terms{{0}});
  const auto means = marginal_means(model->effects, Indices{0}).groups.at(0);
  EXPECT_THROW(
      (void)estimate_contrasts(model->effects, means, std::vector<MeanContrast>{{"x", {1.0, 1.0}}}, Adjustment::kNone),
      std::invalid_argument);
  EXPECT_EQ(pairwise_contrasts(means).at(0).name, "expert - novice");
}

}  // namespace
}  // namespace kith
