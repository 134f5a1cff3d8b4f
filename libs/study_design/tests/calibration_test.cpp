#include "kith/study_design/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "evaluation.hpp"
#include "item_delivery.hpp"
#include "kith/random/distributions.hpp"
#include "kith/stats/distributions.hpp"
#include "kith/stats/moments.hpp"
#include "misfit.hpp"
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
  EXPECT_LT(result->best.misfit, result->candidates.front().misfit);
  EXPECT_LT(std::abs(result->best.targets[0].miss), 2.0);  // confirmed with 20 teams: an se of one tolerance
  EXPECT_GT(result->best.values[0], 1.0);
  EXPECT_EQ(result->ranges.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LE(result->ranges[k].low, result->best.values[k]);
    EXPECT_GE(result->ranges[k].high, result->best.values[k]);
    EXPECT_LT(result->ranges[k].low, result->ranges[k].high);  // one mean cannot tell two parameters
  }
  EXPECT_EQ(result->discrepancy, 0.0);
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
  EXPECT_EQ(one->best.misfit, three->best.misfit);
  EXPECT_EQ(one->ranges[0].low, three->ranges[0].low);
  EXPECT_EQ(one->ranges[1].high, three->ranges[1].high);
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
  const TeamPool pool{{"common"}, {"NN"}, {{{5.0, 7.0, 8.0, 12.0}}}};
  const auto point = point_of(set.targets, evaluate(set.targets, pool), {}, "");
  EXPECT_DOUBLE_EQ(point.targets[0].model, 8.0);
  EXPECT_NEAR(point.targets[0].standard_error, std::sqrt((9.0 + 1.0 + 0.0 + 16.0) / 3.0 / 4.0), 1e-12);  // sd / sqrt(n)
  // 1.5 periods too many; the published standard error is half a tolerance, 0.2.
  EXPECT_NEAR(point.targets[0].misfit, 1.5 / std::sqrt(0.04 + 26.0 / 12.0), 1e-9);
}

TEST(Evaluation, HasTheFThatTheEffectWouldHaveAtThePublishedSize) {
  // Cells 0 +- 1 and 2 +- 1 with 1000 teams each: eta squared is 1/2, less what chance adds.
  std::vector<double> low, high;
  for (std::size_t i = 0; i < 1000; ++i) {
    low.push_back(i % 2 == 0 ? -1.0 : 1.0);
    high.push_back(low.back() + 2.0);
  }
  const TeamPool pool{{"common", "joint"}, {"NN", "NP"}, {{low, high}, {low, high}}};
  Target target;
  target.statistic = Statistic::kF;
  target.effect = Effect{};
  target.effect->kind = Effect::Kind::kComposition;
  target.df1 = 1.0;
  target.df2 = 36.0;
  const auto evaluation = evaluate(std::vector{target}, pool);
  // Non-centrality 1 * 40 observations; mean 36 / 34 * (1 + 40).
  EXPECT_NEAR(evaluation.figures[0], 36.0 / 34.0 * 41.0, 0.3);
  EXPECT_EQ(evaluation.without.size(), 1000u);
}

// A model that is exact: two figures, linear in one parameter, with errors of their own.
class LinearModel {
 public:
  LinearModel(double first, double second) {
    for (auto& target : targets_) target.standard_error = 0.1;
    targets_[0].value = first;
    targets_[1].value = second;
    targets_[1].quantity = Quantity::kKnowledge;
    for (std::size_t i = 0; i <= 10; ++i) {
      const double x = static_cast<double>(i) / 10.0;
      points_.push_back({x});
      // Two replicates around the figure: without each, the other's. Their errors are tiny and not correlated.
      const double e = 1e-4;
      evaluations_.push_back({{x, x}, {{x + e, x + e}, {x + e, x - e}, {x - e, x + e}, {x - e, x - e}}});
    }
  }
  [[nodiscard]] Surfaces surfaces() const { return {targets_, Box::whole(1), points_, evaluations_}; }

 private:
  std::vector<Target> targets_{2};
  std::vector<std::vector<double>> points_;
  std::vector<Evaluation> evaluations_;
};

TEST(Profile, IsTheIntervalOfANormalMean) {
  const LinearModel model{0.5, 0.5};  // the mean of two figures with a standard error of 0.1 each
  const auto surfaces = model.surfaces();
  const RandomStream random{1};
  const auto estimate = estimate_discrepancy(surfaces, random);
  EXPECT_EQ(estimate.discrepancy, 0.0);
  EXPECT_NEAR(estimate.unit[0], 0.5, 0.01);
  const Misfit misfit{surfaces, 0.0};
  const auto interval =
      profile_interval(misfit, surfaces.box(), estimate.unit, 0, misfit.at(estimate.unit) + significant_loss(estimate));
  EXPECT_NEAR(interval.low, 0.5 - 1.96 * 0.1 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(interval.high, 0.5 + 1.96 * 0.1 / std::sqrt(2.0), 0.01);
  EXPECT_FALSE(interval.reaches_low);
  EXPECT_FALSE(interval.reaches_high);
}

TEST(Profile, WidensByWhatTheModelCannotRemove) {
  const LinearModel model{0.2, 0.8};  // no setting meets both: each misses by three standard errors
  const auto surfaces = model.surfaces();
  const auto estimate = estimate_discrepancy(surfaces, RandomStream{1});
  EXPECT_NEAR(estimate.misfit, 18.0, 0.5);
  // With v = 1 + tau^2 two slopes of 10 determine 200 / (200 + 12 v) of the parameter, whose prior variance is 1 / 12:
  // 18 / v = 2 - 200 / (200 + 12 v) at v = 12.6.
  EXPECT_NEAR(estimate.discrepancy, std::sqrt(11.6), 0.05);
  // Two targets less 200 / 212 parameters.
  EXPECT_NEAR(estimate.degrees_of_freedom, 2.0 - 200.0 / 212.0, 1e-3);
  EXPECT_NEAR(std::sqrt(significant_loss(estimate)), student_t_quantile(0.975, estimate.degrees_of_freedom), 1e-12);
  const Misfit misfit{surfaces, estimate.discrepancy};
  const auto interval =
      profile_interval(misfit, surfaces.box(), estimate.unit, 0, misfit.at(estimate.unit) + significant_loss(estimate));
  EXPECT_LT(interval.low, 0.2 + 0.02);
  EXPECT_GT(interval.high, 0.8 - 0.02);
}

// --- coverage ---------------------------------------------------------------------

// A study of known parameters, its figures with their own standard errors as targets, calibrated: which intervals of 95
// % contain the parameters? The study is simulated with people of its own.
struct Coverage {
  int first = 0;
  int second = 0;
};

Coverage coverage(std::size_t studies, std::size_t points, std::size_t teams) {
  const auto spec = small_study({}).study->variants.front();
  TargetSet set;
  for (const auto* who : {"group", "baseline"}) {
    for (const auto quantity : {Quantity::kPeriods, Quantity::kKnowledge}) {
      for (const auto statistic : {Statistic::kMean, Statistic::kSd}) {
        Target target;
        target.quantity = quantity;
        target.statistic = statistic;
        target.teams = *parse_selection(who, spec);
        set.targets.push_back(target);
      }
    }
  }
  set.parameters.push_back(
      {.name = "scale", .keys = {"learner.N.ability_scale"}, .min = 0.6, .max = 1.4, .present = 1.0});
  set.parameters.push_back({.name = "eta",
                            .keys = {"teacher.process_noise", "learner.N.process_noise"},
                            .min = 0.02,
                            .max = 0.4,
                            .logarithmic = true,
                            .present = 0.1});
  const RandomStream random{20};
  Coverage covered;
  for (std::size_t i = 0; i < studies; ++i) {
    auto draw = random.split(i);
    // Well inside the ranges, so that no interval is cut off where it would miss.
    const std::vector<double> unit{0.2 + 0.6 * uniform01(draw), 0.2 + 0.6 * uniform01(draw)};
    const auto truth = to_values(set.parameters, unit);
    CalibrationOptions options;
    Laboratory laboratory{item_delivery(), small_study, set, options};
    const auto published = laboratory.run({truth}, 60, 1000 + i);
    for (std::size_t t = 0; t < set.targets.size(); ++t) {
      std::vector<double> without;
      for (const auto& figures : published->front().without) without.push_back(figures[t]);
      set.targets[t].value = published->front().figures[t];
      set.targets[t].standard_error = jackknife_error(without);
      set.targets[t].tolerance = 2.0 * *set.targets[t].standard_error;
    }
    options.rounds = 2;
    options.points = points;
    options.teams = teams;
    options.confirm_teams = 5 * teams;
    options.frontier_points = 0;
    options.seed = 5000 + i;
    const auto result = calibrate(item_delivery(), small_study, set, options);
    const auto contains = [&](std::size_t k) {
      return result->ranges[k].low <= truth[k] && truth[k] <= result->ranges[k].high;
    };
    covered.first += contains(0) ? 1 : 0;
    covered.second += contains(1) ? 1 : 0;
  }
  return covered;
}

TEST(CalibrationCoverageSlow, IntervalsContainTheirParameters) {
  // If 95 % is right, fewer than 137 of 150 happen once in 50 times: P(X <= 136) = 0.02 for X ~ B(150, 0.95).
  const auto covered = coverage(150, 20, 20);
  RecordProperty("scale", covered.first);
  RecordProperty("eta", covered.second);
  EXPECT_GE(covered.first, 137);
  EXPECT_GE(covered.second, 137);
}

TEST(Rounded, KeepsTheDigitsThatARangeSupports) {
  EXPECT_EQ(rounded(0.08312, 0.06, 0.11, false), 0.08);
  EXPECT_EQ(rounded(0.8731, 0.85, 0.9, false), 0.87);
  EXPECT_EQ(rounded(731.0, 250.0, 2000.0, true), 700.0);
  EXPECT_EQ(rounded(7.4, 7.0, 7.5, true), 7.0);
}

}  // namespace
}  // namespace kith
