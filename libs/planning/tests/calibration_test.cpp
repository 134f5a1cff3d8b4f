#include "kith/planning/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "evaluation.hpp"
#include "item_delivery.hpp"
#include "parameter_box.hpp"
#include "small_study.hpp"

namespace kith {
namespace {

using testing::item_delivery;
using testing::small_study;

TargetSet target_set(double periods) {
  TargetSet set;
  set.targets.push_back({.teams = *parse_selection("group", small_study({}).study->variants.front()),
                         .value = periods,
                         .tolerance = 0.4,
                         .source = {}});
  set.parameters.push_back({.name = "scale",
                            .keys = {"learner.N.ability_scale"},
                            .min = 0.5,
                            .max = 2.0,
                            .logarithmic = true,
                            .present = 1.0});
  set.parameters.push_back(
      {.name = "assumed ability", .keys = {"teacher.assumed_ability"}, .min = 0.7, .max = 0.9, .present = 0.8});
  return set;
}

CalibrationOptions small_search(std::size_t threads = 1) {
  CalibrationOptions options;
  options.rounds = 2;
  options.points = 12;
  options.teams = 8;
  options.confirm_teams = 20;
  options.threads = threads;
  return options;
}

TEST(Calibrate, BringsAFigureWithinItsToleranceAndChangesNoMoreThanNeeded) {
  // At scale 1 the mean is about 6.5; fewer periods take a scale above 1.
  const auto set = target_set(5.5);
  const auto result = calibrate(item_delivery(), small_study, set, small_search());
  ASSERT_TRUE(result);
  EXPECT_EQ(result->candidates.front().label, "the study as it is");
  EXPECT_GT(std::abs(result->candidates.front().targets[0].miss), 1.0);
  EXPECT_LT(result->best.discrepancy, result->candidates.front().discrepancy);
  EXPECT_LT(std::abs(result->best.targets[0].miss), 2.0);  // confirmed with 20 teams: an se of one tolerance
  EXPECT_GT(result->best.values[0], 1.0);
  EXPECT_EQ(result->ranges.size(), 2u);
  EXPECT_LE(result->ranges[0].low, result->ranges[0].high);
  EXPECT_FALSE(result->first_quantity);  // one quantity: nothing to trade
}

TEST(Calibrate, GivesTheSameResultOnAnyNumberOfThreads) {
  auto options = small_search(1);
  options.points = 8;
  options.teams = 3;
  options.confirm_teams = 4;
  const auto one = calibrate(item_delivery(), small_study, target_set(6.5), options);
  options.threads = 3;
  const auto three = calibrate(item_delivery(), small_study, target_set(6.5), options);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->best.values, three->best.values);
  EXPECT_EQ(one->best.discrepancy, three->best.discrepancy);
  EXPECT_EQ(one->best.standard_error, three->best.standard_error);
}

TEST(Calibrate, StopsWhenTold) {
  auto options = small_search();
  options.on_progress = [](std::size_t done, std::size_t) { return done < 5; };
  EXPECT_FALSE(calibrate(item_delivery(), small_study, target_set(6.5), options));
}

TEST(Calibrate, RefusesNonsense) {
  auto set = target_set(6.5);
  auto options = small_search();
  options.points = 3;
  EXPECT_THROW((void)calibrate(item_delivery(), small_study, set, options), std::invalid_argument);
  set.parameters.clear();
  EXPECT_THROW((void)calibrate(item_delivery(), small_study, set, small_search()), std::invalid_argument);
}

TEST(Evaluation, HasTheJackknifeErrorOfAMean) {
  const auto set = target_set(6.5);
  std::vector<TeamRecord> teams(4);
  const std::vector<std::size_t> periods{5, 7, 8, 12};
  for (std::size_t i = 0; i < 4; ++i) {
    teams[i].address.replicate = i + 1;
    teams[i].periods = periods[i];
  }
  const auto point = point_of(set.targets, evaluate(set.targets, teams, 4), {}, "");
  EXPECT_DOUBLE_EQ(point.targets[0].model, 8.0);
  EXPECT_NEAR(point.targets[0].standard_error, std::sqrt((9.0 + 1.0 + 0.0 + 16.0) / 3.0 / 4.0), 1e-12);  // sd / sqrt(n)
}

TEST(Rounded, KeepsTheDigitsThatARangeSupports) {
  EXPECT_EQ(rounded(0.08312, 0.06, 0.11, false), 0.08);
  EXPECT_EQ(rounded(0.8731, 0.85, 0.9, false), 0.87);
  EXPECT_EQ(rounded(731.0, 250.0, 2000.0, true), 700.0);
  EXPECT_EQ(rounded(7.4, 7.0, 7.5, true), 7.0);
}

}  // namespace
}  // namespace kith
