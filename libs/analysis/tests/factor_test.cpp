#include "kith/analysis/factor.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace kith {
namespace {

const std::vector<std::string> kValues{"joint", "common", "joint", "low"};

TEST(Factor, KeepsItsLevelsInTheOrderOfFirstAppearance) {
  const auto factor = make_factor("strategy", kValues);
  EXPECT_EQ(factor.levels, (std::vector<std::string>{"joint", "common", "low"}));
  EXPECT_EQ(factor.codes, (std::vector<std::size_t>{0, 1, 0, 2}));
}

TEST(Factor, SplitsValuesByLevelInTheirOrder) {
  const std::vector<double> values{1, 2, 3, 4};
  EXPECT_EQ(split_by(values, make_factor("strategy", kValues)), (std::vector<std::vector<double>>{{1, 3}, {2}, {4}}));
  EXPECT_THROW((void)split_by(std::vector<double>{1.0}, make_factor("strategy", kValues)), std::invalid_argument);
}

TEST(Factor, InteractionHasEveryPairOfLevels) {
  const auto a = make_factor("a", std::vector<std::string>{"x", "y"});
  const auto b = make_factor("b", std::vector<std::string>{"1", "2"});
  const auto both = interaction(a, b);
  EXPECT_EQ(both.name, "a:b");
  EXPECT_EQ(both.levels, (std::vector<std::string>{"x:1", "x:2", "y:1", "y:2"}));
  EXPECT_EQ(both.codes, (std::vector<std::size_t>{0, 3}));
}

TEST(Factor, DropsLevelsWithoutObservations) {
  const Factor factor{"f", {"a", "b", "c"}, {2, 0, 2}};
  EXPECT_EQ(drop_unused(factor), (Factor{"f", {"a", "c"}, {1, 0, 1}}));
}

}  // namespace
}  // namespace kith
