#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "value_iteration.hpp"

namespace kith {
namespace {

struct Floor {
  std::size_t side = 10;
  double slip = 0.0;  // probability of going to either side of where one wanted
  double discount = 1.0;
  bool has_downhill = false;  // the first feature is 1 eastwards and -1 westwards, not rubble
};

// An open grid of side^2 cells with the goal in a corner. A fifth of the cells
// is rubble and a fifth mud, counted on leaving; the third feature counts steps.
Mdp floor(const Floor& options) {
  RandomStream random{options.side};
  const std::size_t side = options.side;
  const std::size_t goal = side * side - 1;
  MdpBuilder builder{goal, 1, 4, 3, options.discount};
  for (std::size_t s = 0; s < goal; ++s) {
    const double kind = uniform01(random);
    std::vector<double> features{kind < 0.2 ? 1.0 : 0.0, kind > 0.8 ? 1.0 : 0.0, 1.0};
    const std::size_t x = s % side;
    const std::size_t y = s / side;
    const std::array<std::size_t, 4> next{y + 1 < side ? s + side : s, x + 1 < side ? s + 1 : s, y > 0 ? s - side : s,
                                          x > 0 ? s - 1 : s};
    for (std::size_t a = 0; a < 4; ++a) {
      if (next[a] == s) continue;
      if (options.has_downhill) features[0] = a == 1 ? 1.0 : a == 3 ? -1.0 : 0.0;
      std::vector<MdpBuilder::Transition> ways{{StateIndex{next[a]}, 1.0 - options.slip, features}};
      if (options.slip > 0.0) {
        ways.push_back({StateIndex{next[(a + 1) % 4]}, options.slip / 2, features});
        ways.push_back({StateIndex{next[(a + 3) % 4]}, options.slip / 2, features});
      }
      builder.add_choice(StateIndex{s}, ActionIndex{a}, ways);
    }
  }
  return std::move(builder).build();
}

std::vector<std::array<double, 3>> beliefs() {
  RandomStream random{5};
  std::vector<std::array<double, 3>> weights(64);
  for (auto& w : weights) w = {-3.0 * uniform01(random), -3.0 * uniform01(random), -0.1 - uniform01(random)};
  return weights;
}

// What does somebody with a given belief do, on a floor where nothing they can do earns? Label setting ...
void BM_Behave(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0))});
  const auto weights = beliefs();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(behave(mdp, weights[i++ % weights.size()]));
}
BENCHMARK(BM_Behave)->Arg(10)->Arg(32)->Arg(70)->Arg(100)->Arg(200)->Unit(benchmark::kMicrosecond);

// ... against value iteration, which finds the values only ...
void BM_ValueIteration(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0))});
  const auto weights = beliefs();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(testing::value_iteration(mdp, weights[i++ % weights.size()]));
}
BENCHMARK(BM_ValueIteration)->Arg(10)->Arg(32)->Arg(70)->Arg(100)->Arg(200)->Unit(benchmark::kMicrosecond);

// ... and exactly, by label correcting, for whole weights.
void BM_PlanExactly(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0))});
  for (auto _ : state) benchmark::DoNotOptimize(plan_exactly(mdp, {-3, -2, -1}));
}
BENCHMARK(BM_PlanExactly)->Arg(10)->Arg(32)->Arg(70)->Arg(100)->Arg(200)->Unit(benchmark::kMicrosecond);

// And with the benefit of the doubt?
void BM_BehaveInFavour(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0))});
  const auto weights = beliefs();
  constexpr std::array kRobot{-2.0, -1.5, -1.0};
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(behave_in_favour(mdp, weights[i++ % weights.size()], kRobot));
}
BENCHMARK(BM_BehaveInFavour)->Arg(32)->Arg(100)->Unit(benchmark::kMicrosecond);

// How soon is a belief without an optimum dismissed, one to which leaving rubble is worth more than a step?
void BM_BehaveWithoutOptimum(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0))});
  constexpr std::array kGreedy{2.5, -1.0, -1.0};
  for (auto _ : state) benchmark::DoNotOptimize(behave(mdp, kGreedy));
}
BENCHMARK(BM_BehaveWithoutOptimum)->Arg(32)->Arg(100)->Unit(benchmark::kMicrosecond);

// Where steps downhill gain and the way back up costs as much again: label correcting throughout.
void BM_BehaveWithGains(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0)), .has_downhill = true});
  constexpr std::array kWeights{1.5, -1.0, -1.0};
  for (auto _ : state) benchmark::DoNotOptimize(behave(mdp, kWeights));
}
BENCHMARK(BM_BehaveWithGains)->Arg(32)->Arg(100)->Unit(benchmark::kMicrosecond);

// What does chance cost? A robot that slips to either side one time in ten, undiscounted ...
void BM_BehaveOnSlipperyFloor(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0)), .slip = 0.2});
  const auto weights = beliefs();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(behave(mdp, weights[i++ % weights.size()], {.scale = 1 << 20}));
}
BENCHMARK(BM_BehaveOnSlipperyFloor)->Arg(10)->Arg(32)->Arg(70)->Arg(100)->Unit(benchmark::kMicrosecond);

// ... against value iteration and iterated feature expectations, less exact ...
void BM_ValueIterationOnSlipperyFloor(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0)), .slip = 0.2});
  const auto weights = beliefs();
  std::size_t i = 0;
  for (auto _ : state) {
    const auto found = testing::value_iteration(mdp, weights[i++ % weights.size()]);
    benchmark::DoNotOptimize(found.greedy_choice.data());
  }
}
BENCHMARK(BM_ValueIterationOnSlipperyFloor)->Arg(10)->Arg(32)->Arg(70)->Arg(100)->Unit(benchmark::kMicrosecond);

// ... and discounted.
void BM_BehaveDiscounted(benchmark::State& state) {
  const Mdp mdp = floor({.side = static_cast<std::size_t>(state.range(0)), .slip = 0.2, .discount = 0.95});
  const auto weights = beliefs();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(behave(mdp, weights[i++ % weights.size()], {.scale = 1 << 20}));
}
BENCHMARK(BM_BehaveDiscounted)->Arg(10)->Arg(32)->Arg(70)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kith
