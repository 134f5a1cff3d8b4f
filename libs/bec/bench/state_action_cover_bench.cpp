#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "random_grid_world.hpp"

namespace kith {
namespace {

using testing::ConsistentLearner;
using testing::random_grid_world;
using testing::RandomGridWorld;
using testing::share_wrong;

constexpr std::size_t kWorlds = 20;

std::vector<RandomGridWorld> worlds() {
  std::vector<RandomGridWorld> all;
  for (std::size_t i = 0; i < kWorlds; ++i) all.push_back(random_grid_world(RandomStream{2019}.split(i)));
  return all;
}

Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& weights) {
  return {weights.data(), static_cast<Eigen::Index>(weights.size())};
}

// The mean share of wrong actions, in percent, of learners who agree with what some states convey.
double percent_wrong(const RandomGridWorld& world, const StateActionCover& shown, RandomStream random) {
  constexpr int kLearners = 50;
  ConsistentLearner learner{shown.conveyed, as_vector(world.weights)};
  double sum = 0.0;
  for (int i = 0; i < kLearners; ++i) sum += share_wrong(world, shown.robot, learner.next(random));
  return 100.0 * sum / kLearners;
}

// How many state-action pairs does a set cover show of a 9 x 9 grid world with eight features, how long does it take to
// find one, and what do learners do wrong who have seen it? The time is that of one world.
void BM_StateActionCover(benchmark::State& state) {
  const auto all = worlds();
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& world = all[i++ % kWorlds];
    benchmark::DoNotOptimize(cover_state_actions(world.mdp, world.weights, world.cells));
  }
  double pairs = 0.0, facets = 0.0, wrong = 0.0, random_wrong = 0.0;
  std::size_t fewest = RandomGridWorld::kCells, most = 0;
  for (std::size_t k = 0; k < kWorlds; ++k) {
    const auto cover = cover_state_actions(all[k].mdp, all[k].weights, all[k].cells).value();
    const auto n = cover.states.size();
    pairs += static_cast<double>(n);
    facets += static_cast<double>(cover.facets.cols());
    fewest = std::min(fewest, n);
    most = std::max(most, n);
    wrong += percent_wrong(all[k], cover, RandomStream{5}.split(k));
    // As many pairs, drawn at random.
    auto random = RandomStream{6}.split(k);
    auto cells = all[k].cells;
    for (std::size_t j = 0; j < n; ++j) std::swap(cells[j], cells[j + uniform_index(cells.size() - j, random)]);
    cells.resize(n);
    auto some = cover_state_actions(all[k].mdp, all[k].weights, cells).value();
    some.conveyed = some.facets;
    random_wrong += percent_wrong(all[k], some, random);
  }
  state.counters["pairs"] = pairs / kWorlds;
  state.counters["fewest"] = static_cast<double>(fewest);
  state.counters["most"] = static_cast<double>(most);
  state.counters["facets"] = facets / kWorlds;
  state.counters["percent_wrong"] = wrong / kWorlds;
  state.counters["percent_wrong_random_pairs"] = random_wrong / kWorlds;
}
BENCHMARK(BM_StateActionCover)->Unit(benchmark::kMillisecond)->Iterations(static_cast<std::int64_t>(kWorlds) * 5);

}  // namespace
}  // namespace kith
