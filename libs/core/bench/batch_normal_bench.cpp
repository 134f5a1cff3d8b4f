#include "kith/core/batch_normal.hpp"

#include <benchmark/benchmark.h>

#include <vector>

#include "kith/core/distributions.hpp"

namespace kith {
namespace {

constexpr std::int64_t kNormals = 2048;

// What do the normals cost that move 1 000 particles?
void BM_BatchNormal(benchmark::State& state) {
  RandomStream random{1};
  NormalPairs::Block cosine;
  NormalPairs::Block sine;
  for (auto _ : state) {
    const NormalPairs normal{random};
    for (std::uint64_t block = 0; block < kNormals / (2 * NormalPairs::kBlock); ++block) {
      normal.fill(block, cosine, sine);
      benchmark::DoNotOptimize(cosine.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * kNormals);
}
BENCHMARK(BM_BatchNormal);

// The baseline: the same transform, one pair at a time, with the functions of the C library.
void BM_NaiveNormal(benchmark::State& state) {
  std::vector<double> out(kNormals);
  RandomStream random{1};
  for (auto _ : state) {
    fill_standard_normal(out, random);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * kNormals);
}
BENCHMARK(BM_NaiveNormal);

}  // namespace
}  // namespace kith
