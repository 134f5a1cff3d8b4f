#include "kith/analysis/cell_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "common.hpp"

namespace kith {
namespace {

using Indices = std::vector<std::size_t>;
using Values = std::vector<double>;

const Factor kStrategy{"strategy", {"joint", "common", "nobody"}, {0, 0, 0, 0, 1, 1, 1, 1}};
const Factor kType{"type", {"novice", "expert"}, {0, 0, 1, 1, 0, 0, 1, 1}};

auto near(const Values& values) { return ::testing::Pointwise(::testing::DoubleNear(1e-14), values); }

CellDesign design_of(const std::vector<Indices>& terms) {
  return make_cell_design(8, std::vector{kStrategy, kType}, terms).value();
}

TEST(CellDesign, CountsTheCellsOfTheLevelsThatAreThere) {
  const auto design = design_of(testing::kCrossed);
  EXPECT_EQ(design.factors.at(0).levels, (std::vector<std::string>{"joint", "common"}));
  EXPECT_EQ(design.counts, (Indices{2, 2, 2, 2}));
  EXPECT_TRUE(design.is_balanced());
  EXPECT_EQ(design.level(2, 0), 1u);
  EXPECT_EQ(design.level(2, 1), 0u);
  EXPECT_EQ(design.model_df(), 4u);
  EXPECT_EQ(term_name(design.terms.at(2), design.factors), "strategy:type");
}

// Means: 2.5 and 6 under the strategies, 4.25 over all.
TEST(CellDesign, SplitsValuesIntoEffects) {
  const auto design = design_of(testing::kCrossed);
  const Values means{1, 4, 3, 9};
  EXPECT_THAT(design.effect({}, means), near(Values{4.25, 4.25, 4.25, 4.25}));
  EXPECT_THAT(design.effect({0}, means), near(Values{-1.75, -1.75, 1.75, 1.75}));
  EXPECT_THAT(design.effect({1}, means), near(Values{-2.25, 2.25, -2.25, 2.25}));
  EXPECT_THAT(design.effect({0, 1}, means), near(Values{0.75, -0.75, -0.75, 0.75}));
  EXPECT_THAT(design.fitted(means), near(means));
  EXPECT_THAT(design_of(testing::kAdditive).fitted(means), near(Values{0.25, 4.75, 3.75, 8.25}));
}

// Means are weighted by observations: of 1, 1 and 4, that over all is 2.
TEST(CellDesign, OfOneFactorMayHaveCellsOfDifferentSizes) {
  const std::vector factors{Factor{"type", {"novice", "expert"}, {0, 0, 1}}};
  const auto design = make_cell_design(3, factors, testing::kAlone).value();
  EXPECT_FALSE(design.is_balanced());
  EXPECT_THAT(design.effect({0}, {1, 4}), near(Values{-1, 2}));
}

TEST(CellDesign, WeightsOfObservedMeansMakeTheSumOfFittedOnes) {
  const auto design = design_of(testing::kAdditive);
  const Values means{1, 4, 3, 9}, weights{0.5, 0.5, 0, 0};
  const auto fitted = design.fitted(means), of_observed = design.weights_of_observed(weights);
  double expected = 0.0, actual = 0.0;
  for (std::size_t c = 0; c < means.size(); ++c) {
    expected += weights[c] * fitted[c];
    actual += of_observed[c] * means[c];
  }
  EXPECT_NEAR(actual, expected, 1e-15);
}

TEST(CellDesign, RefusesCellsOfDifferentSizes) {
  auto other = kType;
  const auto reason = [](const Factor& b) {
    return make_cell_design(8, std::vector{kStrategy, b}, testing::kCrossed).reason();
  };
  for (const auto& codes : {Indices{0, 0, 0, 1, 0, 0, 1, 1}, Indices{0, 0, 0, 1, 0, 0, 0, 1}}) {
    other.codes = codes;
    EXPECT_EQ(reason(other), "the design is unbalanced: its cells have 1 to 3");
  }
  other.codes = {0, 0, 0, 0, 1, 1, 1, 1};
  EXPECT_EQ(reason(other), "the design is unbalanced: combinations of levels have no observations");
  const std::vector<Factor> many(24, kType);
  EXPECT_FALSE(make_cell_design(8, many, testing::kAlone));
  EXPECT_EQ(make_cell_design(0, {}, {}).reason(), "no observations");
}

TEST(CellDesign, RejectsWhatIsNoDesign) {
  const std::vector factors{kStrategy, kType};
  EXPECT_THROW((void)make_cell_design(8, factors, std::vector<Indices>{{2}}), std::invalid_argument);
  EXPECT_THROW((void)make_cell_design(8, factors, std::vector<Indices>{{0}, {0, 1}}), std::invalid_argument);
  EXPECT_THROW((void)make_cell_design(5, factors, testing::kCrossed), std::invalid_argument);
}

}  // namespace
}  // namespace kith
