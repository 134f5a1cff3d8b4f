#include "kith/analysis/study_power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "item_delivery.hpp"
#include "kith/analysis/power.hpp"
#include "kith/core/distributions.hpp"
#include "small_study.hpp"
#include "study_tests.hpp"

namespace kith {
namespace {

const std::vector<std::string> kStrategies{"individual-low", "common", "joint"};
const std::vector<std::string> kCompositions{"NN", "NP"};

// Standard normal outcomes without any effect but `raised` added to the last strategy.
TeamPool normal_pool(std::size_t replicates, std::uint64_t seed, double raised = 0.0) {
  RandomStream random{seed};
  std::vector<std::vector<std::vector<double>>> values;
  for (const auto& strategy : kStrategies) {
    values.emplace_back();
    for (std::size_t c = 0; c < kCompositions.size(); ++c) {
      values.back().emplace_back();
      for (std::size_t r = 0; r < replicates; ++r)
        values.back().back().push_back(standard_normal(random) + (strategy == "joint" ? raised : 0.0));
    }
  }
  return {kStrategies, kCompositions, values};
}

PowerOptions sizes(std::vector<std::size_t> teams, std::size_t draws) {
  PowerOptions options;
  options.teams = std::move(teams);
  options.draws = draws;
  return options;
}

Effect strategy_effect(std::optional<double> imposed = {}) {
  return {.outcome = &outcome_named("periods"),
          .kind = Effect::Kind::kStrategy,
          .composition = {},
          .first = {},
          .second = {},
          .imposed = imposed};
}

// Shares right between .9 and 1.
TeamPool shares_pool() {
  RandomStream random{11};
  std::vector<std::vector<std::vector<double>>> values(
      kStrategies.size(), std::vector<std::vector<double>>(kCompositions.size(), std::vector<double>(50)));
  for (auto& strategy : values) {
    for (auto& cell : strategy)
      for (auto& value : cell) value = 0.9 + 0.1 * uniform01(random);
  }
  return {kStrategies, kCompositions, values};
}

TEST(EffectCells, RefuseMeansThatTheOutcomeCannotHave) {
  const auto pool = shares_pool();
  Effect effect;
  effect.outcome = &outcome_named("exam_share_right");
  effect.kind = Effect::Kind::kContrast;
  effect.imposed = 0.5;
  effect.first.strategy = "joint";
  effect.second.strategy = "common";
  const auto refused = effect_cells(pool, effect);
  EXPECT_NE(refused.impossible.find("exam_share_right would have means from "), std::string::npos)
      << refused.impossible;
  EXPECT_NE(refused.impossible.find("it lies between 0 and 1"), std::string::npos) << refused.impossible;
  // Where there is no upper bound, only the lower one refuses.
  effect.outcome = &outcome_named("exam_regret");
  EXPECT_TRUE(effect_cells(pool, effect).impossible.empty());
  effect.imposed = -2.0;
  EXPECT_NE(effect_cells(pool, effect).impossible.find("it lies at 0 or above"), std::string::npos);
  effect.imposed.reset();
  EXPECT_TRUE(effect_cells(pool, effect).impossible.empty());
}

// The law: an effect is refused exactly if one of the means that it gives lies outside the range.
TEST(EffectCells, AreThoseOfTheEffectWithinTheRange) {
  const auto pool = shares_pool();
  for (const auto kind : {Effect::Kind::kStrategy, Effect::Kind::kComposition, Effect::Kind::kInteraction,
                          Effect::Kind::kStrategyWithin, Effect::Kind::kContrast}) {
    for (const double size : {0.01, 0.05, 0.09, 0.2, 0.5, 0.9, 0.99}) {
      Effect effect;
      effect.outcome = &outcome_named("knowledge");
      effect.kind = kind;
      effect.composition = "NP";
      effect.imposed = size;
      effect.first.strategy = "joint";
      effect.second.composition = "NN";
      const auto cells = effect_cells(pool, effect);
      ASSERT_GE(cells.cells.size(), 2u);
      bool fits = true;
      double sum = 0.0, low = 1e9, high = -1e9;
      for (const auto& cell : cells.cells) {
        ASSERT_TRUE(cell.imposed);
        fits = fits && *cell.imposed >= -1e-9 && *cell.imposed <= 1.0 + 1e-9;
        sum += *cell.imposed - cell.mean;
        low = std::min(low, *cell.imposed);
        high = std::max(high, *cell.imposed);
        EXPECT_NEAR(cell.sd, std::sqrt(0.01 / 12.0), 0.008);  // of 50 values: five standard errors
      }
      EXPECT_EQ(cells.impossible.empty(), fits) << cells.impossible;
      EXPECT_NEAR(cells.largest_difference, (high - low) / cells.sd, 1e-9);
      if (kind == Effect::Kind::kContrast) continue;
      EXPECT_NEAR(sum, 0.0, 1e-9);
    }
  }
}

TEST(Power, EqualsTheLevelWithoutAnEffect) {
  const auto pool = normal_pool(2'000, 1);
  std::vector<Effect> effects{strategy_effect()};
  effects.push_back(effects.front());
  effects.back().kind = Effect::Kind::kInteraction;
  effects.push_back(effects.front());
  effects.back().kind = Effect::Kind::kContrast;
  effects.back().first.strategy = "common";
  effects.back().second.strategy = "joint";
  for (const auto& curve : power_curves(pool, effects, sizes({6}, 600))) {
    // Four standard errors: of 600 draws 0.009, and of a pool of 2 000 / 6 disjoint studies at most 0.012.
    EXPECT_NEAR(curve.points[0].power, 0.05, 4.0 * 0.015) << to_string(curve.effect);
    EXPECT_LE(curve.points[0].low, 0.05 + 0.02);
  }
}

TEST(Power, OfAnImposedEffectIsThatOfTheNonCentralF) {
  const auto pool = normal_pool(1'000, 2);
  const double eta = 0.1;
  const std::vector<Effect> effects{strategy_effect(eta)};
  const auto curve = power_curves(pool, effects, sizes({5, 10, 20, 40}, 500)).front();
  EXPECT_EQ(curve.size, eta);
  for (const auto& point : curve.points) {
    const double exact = f_test_power(eta, 2, 6, 6 * point.teams, 0.05);
    EXPECT_DOUBLE_EQ(*point.analytic_power, exact);
    // Four standard errors of 500 draws, 0.022 at most; the pool's own spread is the effect's scale here.
    EXPECT_NEAR(point.power, exact, 4.0 * 0.022) << point.teams;
  }
  ASSERT_TRUE(curve.needed.estimate && curve.needed.low && curve.needed.high && curve.needed.analytic);
  EXPECT_NEAR(*curve.needed.estimate, static_cast<double>(*curve.needed.analytic), 4.0);
  EXPECT_LE(*curve.needed.low, *curve.needed.estimate);
  EXPECT_GE(*curve.needed.high, *curve.needed.estimate);
}

TEST(Power, OfAnImposedDifferenceIsThatOfTheT) {
  const auto pool = normal_pool(1'000, 3);
  auto effect = strategy_effect(0.8);
  effect.kind = Effect::Kind::kContrast;
  effect.first.strategy = "common";
  effect.second.strategy = "joint";
  const auto curve = power_curves(pool, std::vector{effect}, sizes({5, 15}, 500)).front();
  for (const auto& point : curve.points) EXPECT_NEAR(point.power, *point.analytic_power, 4.0 * 0.022);
}

TEST(Power, EstimatesTheSizeOfAnEffectWithoutBias) {
  double sum = 0.0;
  constexpr std::size_t kPools = 20;
  for (std::size_t k = 0; k < kPools; ++k)
    sum += power_curves(normal_pool(60, 100 + k, 0.5), std::vector{strategy_effect()}, sizes({2}, 10)).front().size;
  // Effects -1/6, -1/6, 1/3 (mean square 1/18) against a variance of 1. Four standard errors of 20 pools.
  EXPECT_NEAR(sum / kPools, (1.0 / 18.0) / (1.0 + 1.0 / 18.0), 4.0 * 0.005);
}

TEST(Power, KnowsHowUncertainTheFinitePoolMakesIt) {
  constexpr std::size_t kPools = 30;
  double sum = 0.0, squares = 0.0, claimed = 0.0;
  for (std::size_t k = 0; k < kPools; ++k) {
    const auto pool = normal_pool(60, 200 + k, 0.7);
    const auto point = power_curves(pool, std::vector{strategy_effect()}, sizes({12}, 150)).front().points.front();
    sum += point.power / kPools;
    squares += point.power * point.power / kPools;
    claimed += (point.pool_error * point.pool_error + point.power * (1.0 - point.power) / 150.0) / kPools;
  }
  const double observed = (squares - sum * sum) * kPools / (kPools - 1.0);
  EXPECT_GT(claimed / observed, 0.4);  // 30 pools tell a variance within a factor of 1.8 (95 %)
  EXPECT_LT(claimed / observed, 2.5);
}

TEST(Power, SaysThatAnEffectIsBeyondTheSizesTried) {
  const auto curve = power_curves(normal_pool(100, 4), std::vector{strategy_effect(0.001)}, sizes({3, 6}, 50)).front();
  EXPECT_FALSE(curve.needed.estimate);
  ASSERT_TRUE(curve.needed.analytic);
  EXPECT_GT(*curve.needed.analytic, 1'000u);
}

TEST(Power, RefusesNonsense) {
  const auto pool = normal_pool(20, 5);
  const std::vector effects{strategy_effect()};
  EXPECT_THROW((void)power_curves(pool, effects, sizes({1}, 10)), std::invalid_argument);
  EXPECT_THROW((void)power_curves(pool, effects, sizes({6, 3}, 10)), std::invalid_argument);
  EXPECT_THROW((void)power_curves(pool, effects, sizes({11}, 10)), std::invalid_argument);
  auto options = sizes({3}, 10);
  options.alpha = 1.0;
  EXPECT_THROW((void)power_curves(pool, effects, options), std::invalid_argument);
}

// Outcomes of people who differ much and are taught by every strategy; `raised` is what joint adds.
TeamPool paired_pool(std::size_t replicates, std::uint64_t seed, double raised = 0.0) {
  RandomStream random{seed};
  std::vector<std::vector<std::vector<double>>> values(kStrategies.size());
  for (std::size_t c = 0; c < kCompositions.size(); ++c) {
    for (auto& by_composition : values) by_composition.emplace_back();
    for (std::size_t r = 0; r < replicates; ++r) {
      const double people = 2.0 * standard_normal(random);
      for (std::size_t s = 0; s < kStrategies.size(); ++s)
        values[s][c].push_back(people + standard_normal(random) + (kStrategies[s] == "joint" ? raised : 0.0));
    }
  }
  return {kStrategies, kCompositions, values};
}

TEST(Power, WithinPeopleKeepsTheLevel) {
  const auto pool = paired_pool(2'000, 6);
  std::vector<Effect> effects{strategy_effect(), strategy_effect(), strategy_effect(), strategy_effect()};
  effects[1].kind = Effect::Kind::kComposition;
  effects[2].kind = Effect::Kind::kInteraction;
  effects[3].kind = Effect::Kind::kStrategyWithin;
  effects[3].composition = "NN";
  auto options = sizes({6}, 600);
  options.paired = true;
  for (const auto& curve : power_curves(pool, effects, options)) {
    // As in EqualsTheLevelWithoutAnEffect. Bonferroni and Greenhouse-Geisser may stay below.
    const double least = curve.effect.kind == Effect::Kind::kStrategyWithin ? 0.0 : 0.05 - 4.0 * 0.015;
    EXPECT_GE(curve.points[0].power, least) << to_string(curve.effect);
    EXPECT_LE(curve.points[0].power, 0.05 + 4.0 * 0.015) << to_string(curve.effect);
  }
}

TEST(Power, OfPairsIsHigherWherePeopleDiffer) {
  const auto pool = paired_pool(400, 7, 0.8);
  std::vector<Effect> effects{strategy_effect(), strategy_effect()};
  effects[1].kind = Effect::Kind::kContrast;
  effects[1].first.strategy = "joint";
  effects[1].second.strategy = "common";
  auto options = sizes({10}, 200);
  const auto apart = power_curves(pool, effects, options);
  options.paired = true;
  const auto paired = power_curves(pool, effects, options);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    EXPECT_GT(paired[e].points[0].power, apart[e].points[0].power + 0.2) << to_string(effects[e]);
    EXPECT_FALSE(paired[e].points[0].analytic_power);
  }
}

TEST(Power, WithinPeopleOfTwoStrategiesIsThePairedT) {
  const auto all = paired_pool(40, 8, 0.5);
  std::vector<std::vector<std::vector<double>>> values(2);
  for (std::size_t s = 0; s < 2; ++s) {
    const auto cell = all.cell(outcome_named("periods"), s + 1, 0);
    values[s] = {{cell.begin(), cell.end()}};
  }
  const TeamPool pool{{"common", "joint"}, {"NN"}, values};
  Effect contrast = strategy_effect();
  contrast.kind = Effect::Kind::kContrast;
  contrast.first.strategy = "common";
  contrast.second.strategy = "joint";
  const StudyTests tests{pool, 12, true};
  Draw draw(2, std::vector<std::uint32_t>{3, 1, 4, 15, 9, 2, 6, 5, 35, 8, 7, 30});
  const EffectData data{pool, contrast};
  EXPECT_NEAR(tests.p_value(strategy_effect(), data, draw), tests.p_value(contrast, data, draw), 1e-12);
}

TEST(SimulatePools, KeepsWhatTheTeamsCameTo) {
  const auto spec = testing::small_study({}).study->variants.front();
  const Study study{{spec, spec}};
  const auto pools = simulate_pools(testing::item_delivery(), study, {.threads = 2, .on_progress = {}});
  ASSERT_TRUE(pools);
  const auto addresses = team_addresses(study);
  const auto run = run_teams(testing::item_delivery(), study, addresses, {.threads = 1, .on_progress = {}});
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const auto& pool = (*pools)[addresses[i].variant];
    const std::size_t s = addresses[i].strategy == kBaseline ? 0 : 1;
    EXPECT_EQ(pool.cell(outcome_named("periods"), s, 0)[addresses[i].replicate - 1],
              static_cast<double>(run.teams[i].periods));
    EXPECT_EQ(pool.cell(outcome_named("knowledge"), s, 0)[addresses[i].replicate - 1], run.teams[i].knowledge);
  }
  const auto stopped =
      simulate_pools(testing::item_delivery(), study,
                     {.threads = 1, .on_progress = [](std::size_t done, std::size_t) { return done < 2; }});
  EXPECT_FALSE(stopped);
}

TEST(ReplicateFindings, FindsThatTeachingEverybodyAloneTakesLonger) {
  const auto spec = testing::small_study({"replicates=4"}).study->variants.front();
  const auto effect = *parse_effect("periods: group - baseline", spec).effect;
  PublishedFinding finding;
  finding.effect = effect;
  finding.significant = true;
  const std::vector<PublishedFinding> findings{finding};
  ReplicationOptions options;
  options.studies = 5;
  options.threads = 1;
  const auto one = replicate_findings(testing::item_delivery(), spec, findings, options);
  options.threads = 2;
  const auto two = replicate_findings(testing::item_delivery(), spec, findings, options);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->findings[0].significant, two->findings[0].significant);
  EXPECT_EQ(one->all_agree, one->findings[0].significant);
  EXPECT_GE(one->findings[0].significant, 1u);
}

}  // namespace
}  // namespace kith
