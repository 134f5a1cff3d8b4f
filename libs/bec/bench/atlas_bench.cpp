#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"
#include "value_iteration.hpp"

namespace kith {
namespace {

const Atlas& atlas() {
  static const Atlas made{load_domain("item-delivery")};
  return made;
}

// Weights to whom steps cost something, as a learner may hold them.
std::vector<Eigen::Vector3d> some_weights(std::size_t n) {
  RandomStream random{8};
  std::vector<Eigen::Vector3d> weights;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = Cone{}.sample(random);
    weights.emplace_back(p[0], p[1], -std::abs(p[2]));
  }
  return weights;
}

// What does a domain cost before the first team is taught?
void BM_BuildAtlas(benchmark::State& state) {
  const auto domain = load_domain("item-delivery");
  for (auto _ : state) benchmark::DoNotOptimize(Atlas{domain}.num_states());
}
BENCHMARK(BM_BuildAtlas)->Unit(benchmark::kMillisecond);

// Where in the partition does a weight lie?
void BM_LocateCell(benchmark::State& state) {
  const auto weights = some_weights(1024);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(atlas().tables().cells().locate(weights[i++ % weights.size()]));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_LocateCell);

// What would all demonstrations convey to eight imagined people?
void BM_ConveyedToEightByLookUp(benchmark::State& state) {
  const auto weights = some_weights(8);
  for (auto _ : state) {
    std::vector<PolicyCellIndex> cells;
    for (const auto& w : weights) cells.push_back(atlas().tables().cells().locate(w));
    benchmark::DoNotOptimize(atlas().tables().conveyed_by_class(cells));
  }
}
BENCHMARK(BM_ConveyedToEightByLookUp)->Unit(benchmark::kMicrosecond);

// The baseline: value iteration in every MDP for each of the eight, and the
// differences to the robot's counts; not even collected along paths.
void BM_ConveyedToEightByValueIteration(benchmark::State& state) {
  const auto weights = some_weights(8);
  const auto& domain = atlas().domain();
  for (auto _ : state) {
    for (const auto& w : weights) {
      const std::array<double, 3> x{w.x(), w.y(), w.z()};
      for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
        const auto result = testing::value_iteration(domain.mdp(m), x);
        benchmark::DoNotOptimize(result.values.data());
      }
    }
  }
}
BENCHMARK(BM_ConveyedToEightByValueIteration)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kith
