#include "kith/analysis/contrasts.hpp"

#include <gtest/gtest.h>

#include "kith/core/error.hpp"

namespace kith {
namespace {

using Weights = std::vector<PlannedContrast::Weight>;

TEST(ParseContrast, AveragesLevelsWithoutNumbers) {
  const auto contrast = parse_contrast("H1: joint + common - individual-high - individual-low");
  EXPECT_EQ(contrast.name, "H1");
  EXPECT_EQ(contrast.factor, "");
  EXPECT_EQ(contrast.weights,
            (Weights{{"joint", 0.5}, {"common", 0.5}, {"individual-high", -0.5}, {"individual-low", -0.5}}));
  EXPECT_EQ(contrast, [] {
    auto same = difference_of_means("H1", {"joint", "common"}, {"individual-high", "individual-low"});
    return same;
  }());
}

TEST(ParseContrast, TakesNumbersAsWeights) {
  const auto contrast = parse_contrast("slope [dose]: -1*low + 0*mid + 1*high");
  EXPECT_EQ(contrast.name, "slope");
  EXPECT_EQ(contrast.factor, "dose");
  EXPECT_EQ(contrast.weights, (Weights{{"low", -1.0}, {"mid", 0.0}, {"high", 1.0}}));
}

TEST(ParseContrast, NamesItselfIfNobodyDoes) {
  EXPECT_EQ(parse_contrast("a - b").name, "a - b");
  EXPECT_EQ(parse_contrast("[g]: a - b").name, "a - b");
  EXPECT_EQ(parse_contrast("- b + a").weights, (Weights{{"b", -1.0}, {"a", 1.0}}));
}

TEST(ParseContrast, TakesLevelsInBackQuotes) {
  EXPECT_EQ(parse_contrast("`very low` - 1:2").weights, (Weights{{"very low", 1.0}, {"1:2", -1.0}}));
}

TEST(ParseContrast, RefusesWhatComparesNothing) {
  for (const auto* text : {"", "a", "a + b", "a - a", "a b", "a - - b", "a -", "2*a - b", "`a - b", "x]: a - b"})
    EXPECT_THROW((void)parse_contrast(text), Error) << text;
}

TEST(ParseSmallestEffect, IsInUnitsOrInStandardDeviations) {
  EXPECT_EQ(parse_smallest_effect("0.5").size, 0.5);
  EXPECT_FALSE(parse_smallest_effect("0.5").standardized);
  EXPECT_EQ(parse_smallest_effect("d=0.3").size, 0.3);
  EXPECT_TRUE(parse_smallest_effect("d=0.3").standardized);
  for (const auto* text : {"", "d", "d=", "0", "-1", "inf", "g=1", "0.5x"})
    EXPECT_THROW((void)parse_smallest_effect(text), Error) << text;
}

}  // namespace
}  // namespace kith
