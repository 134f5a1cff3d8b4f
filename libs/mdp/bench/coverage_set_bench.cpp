#include "kith/mdp/coverage_set.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "value_iteration.hpp"

namespace kith {
namespace {

// An open grid of side^2 cells with the goal in a corner. A fifth of the cells
// is rubble and a fifth mud, counted on leaving; the third feature counts steps.
Mdp grid(std::size_t side) {
  RandomStream random{side};
  const std::size_t goal = side * side - 1;
  MdpBuilder builder{goal, 1, 4, 3, 1.0};
  for (std::size_t s = 0; s < goal; ++s) {
    const double kind = uniform01(random);
    const std::vector<double> features{kind < 0.2 ? 1.0 : 0.0, kind > 0.8 ? 1.0 : 0.0, 1.0};
    const std::size_t x = s % side;
    const std::size_t y = s / side;
    const std::array<bool, 4> is_open{y + 1 < side, y > 0, x > 0, x + 1 < side};
    const std::array<std::size_t, 4> next{s + side, s - side, s - 1, s + 1};
    for (std::size_t a = 0; a < 4; ++a) {
      if (!is_open[a]) continue;
      const MdpBuilder::Transition transition{StateIndex{next[a]}, 1.0, features};
      builder.add_choice(StateIndex{s}, ActionIndex{a}, std::span{&transition, 1});
    }
  }
  return std::move(builder).build();
}

std::vector<std::array<double, 3>> weights_inside(std::size_t n) {
  RandomStream random{5};
  std::vector<std::array<double, 3>> weights(n);
  for (auto& w : weights) w = {-3.0 * uniform01(random), -3.0 * uniform01(random), -0.1 - uniform01(random)};
  return weights;
}

// What does it cost to know every trajectory that can be optimal, once per process?
void BM_CoverageSets(benchmark::State& state) {
  const Mdp mdp = grid(static_cast<std::size_t>(state.range(0)));
  std::size_t num_vertices = 0;
  for (auto _ : state) num_vertices = coverage_sets(mdp).num_vertices();
  state.counters["vertices"] = static_cast<double>(num_vertices);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mdp.num_states()));
}
BENCHMARK(BM_CoverageSets)->Arg(4)->Arg(6)->Arg(10)->Arg(16)->Unit(benchmark::kMicrosecond);

// And then to know the optimal value of every state under one more belief, by look-up ...
void BM_ValuesByLookUp(benchmark::State& state) {
  const Mdp mdp = grid(static_cast<std::size_t>(state.range(0)));
  const CoverageSets sets = coverage_sets(mdp);
  const auto weights = weights_inside(64);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& w = weights[i++ % weights.size()];
    double total = 0.0;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      double best = -std::numeric_limits<double>::infinity();
      for (const IntegerVector& mu : sets.vertices(StateIndex{s})) best = std::max(best, dot(mu, w));
      total += best;
    }
    benchmark::DoNotOptimize(total);
  }
}
BENCHMARK(BM_ValuesByLookUp)->Arg(4)->Arg(6)->Arg(10)->Arg(16)->Unit(benchmark::kMicrosecond);

// ... by planning ...
void BM_ValuesByBehave(benchmark::State& state) {
  const Mdp mdp = grid(static_cast<std::size_t>(state.range(0)));
  const auto weights = weights_inside(64);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(behave(mdp, weights[i++ % weights.size()]));
}
BENCHMARK(BM_ValuesByBehave)->Arg(4)->Arg(6)->Arg(10)->Arg(16)->Unit(benchmark::kMicrosecond);

void BM_ValuesByPlanExactly(benchmark::State& state) {
  const Mdp mdp = grid(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(plan_exactly(mdp, {-3, -2, -1}));
}
BENCHMARK(BM_ValuesByPlanExactly)->Arg(4)->Arg(6)->Arg(10)->Arg(16)->Unit(benchmark::kMicrosecond);

// ... and, the naive way, by value iteration from nothing.
void BM_ValuesByValueIteration(benchmark::State& state) {
  const Mdp mdp = grid(static_cast<std::size_t>(state.range(0)));
  const auto weights = weights_inside(64);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(testing::value_iteration(mdp, weights[i++ % weights.size()]));
}
BENCHMARK(BM_ValuesByValueIteration)->Arg(4)->Arg(6)->Arg(10)->Arg(16)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kith
