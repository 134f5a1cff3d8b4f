#include "kith/random/batch_normal.hpp"

#include <benchmark/benchmark.h>

#include <vector>

#include "kith/random/distributions.hpp"

namespace kith {
namespace {

// What do the 2 000 normals cost that move 1 000 particles?
void BM_BatchNormal(benchmark::State& state) {
  std::vector<float> out(2000);
  RandomStream random{1};
  for (auto _ : state) {
    batch_standard_normal(out, random);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * 2000);
}
BENCHMARK(BM_BatchNormal);

// The baseline: the same transform, one pair at a time, with the functions of the C library.
void BM_NaiveNormal(benchmark::State& state) {
  std::vector<double> out(2000);
  RandomStream random{1};
  for (auto _ : state) {
    fill_standard_normal(out, random);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * 2000);
}
BENCHMARK(BM_NaiveNormal);

}  // namespace
}  // namespace kith
