#include <benchmark/benchmark.h>

#include <string>

#include "kith/domains/domain_file.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

// side x side cells, two in five of them rubble or mud, from one corner to the other.
std::string grid(std::size_t side) {
  RandomStream random{side};
  std::string rows;
  for (std::size_t y = 0; y < side; ++y) {
    std::string row;
    for (std::size_t x = 0; x < side; ++x) row += "..r.m"[uniform_index(5, random)];
    if (y == 0) row.back() = 'G';
    if (y + 1 == side) row.front() = 'S';
    rows += (y == 0 ? "\"" : ",\n\"") + row + '"';
  }
  return "schema = \"kith.domain/1\"\nid = \"grid\"\n[mdp]\nmax_steps = 10000\n[map]\nrows = [" + rows + R"(]
[map.legend]
"." = "floor"
"r" = { terrain = "rubble" }
"m" = { terrain = "mud" }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "rubble"
when = "leave:rubble"
[[feature]]
name = "mud"
when = "leave:mud"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { rubble = -2.7, mud = -1.3, step = -1 }
)";
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
