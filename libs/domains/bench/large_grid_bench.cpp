#include <benchmark/benchmark.h>

#include <string>

#include "domain_texts.hpp"
#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

// side x side cells, two in five of them rubble or mud, from one corner to the other.
std::string grid(std::size_t side) {
  RandomStream random{side};
  return testing::terrain_grid(side, [&](std::size_t, std::size_t) { return "..r.m"[uniform_index(5, random)]; });
}

// How long does `kith validate` take for one large map? Exploring, planning exactly, and looking for ties.
void BM_Validate(benchmark::State& state) {
  const std::string text = grid(static_cast<std::size_t>(state.range(0)));
  std::size_t states = 0;
  for (auto _ : state) states = parse_domain(text, "grid").domain->num_starts();
  state.counters["states"] = static_cast<double>(states);
}
BENCHMARK(BM_Validate)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

// And one plan of it, in integers ...
void BM_PlanExactly(benchmark::State& state) {
  const Domain domain = *parse_domain(grid(static_cast<std::size_t>(state.range(0))), "grid").domain;
  for (auto _ : state) benchmark::DoNotOptimize(plan_exactly(domain.mdp(MdpIndex{0}), domain.weights().integer));
}
BENCHMARK(BM_PlanExactly)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

// ... or as somebody with real weights?
void BM_Behave(benchmark::State& state) {
  const Domain domain = *parse_domain(grid(static_cast<std::size_t>(state.range(0))), "grid").domain;
  for (auto _ : state) benchmark::DoNotOptimize(behave(domain.mdp(MdpIndex{0}), domain.weights().raw));
}
BENCHMARK(BM_Behave)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kith
