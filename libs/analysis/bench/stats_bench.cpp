#include <benchmark/benchmark.h>

#include <vector>

#include "kith/analysis/anova.hpp"
#include "kith/analysis/marginal_means.hpp"
#include "kith/analysis/multiple.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

const std::vector<std::vector<std::size_t>> kCrossed{{0}, {1}, {0, 1}};

// Teams of the published design, four strategies by four compositions.
struct Teams {
  std::vector<Factor> factors{{"strategy", {"0", "1", "2", "3"}, {}}, {"composition", {"0", "1", "2", "3"}, {}}};
  std::vector<double> response;

  explicit Teams(std::size_t n) {
    RandomStream random{11};
    for (std::size_t i = 0; i < n; ++i) {
      factors[0].codes.push_back(i % 4);
      factors[1].codes.push_back(i / 4 % 4);
      response.push_back(standard_normal(random));
    }
  }
};

// What does a table cost, from the published 240 teams to a large simulation?
void BM_Anova(benchmark::State& state) {
  const Teams teams{static_cast<std::size_t>(state.range(0))};
  for (auto _ : state) benchmark::DoNotOptimize(anova(teams.response, teams.factors, kCrossed));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_Anova)->Arg(240)->Arg(20'000)->Unit(benchmark::kMicrosecond);

// What does the critical value of all pairs of four groups cost, most of what they cost?
void BM_StudentizedRangeQuantile(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(studentized_range_quantile(0.05, 4, static_cast<double>(state.range(0))));
}
BENCHMARK(BM_StudentizedRangeQuantile)->Arg(5)->Arg(224)->Arg(19'984)->Unit(benchmark::kMillisecond);

// What do marginal means with all their pairs cost, of a factor at each level of another?
void BM_MarginalMeans(benchmark::State& state) {
  const Teams teams{static_cast<std::size_t>(state.range(0))};
  for (auto _ : state) {
    const auto model = *anova(teams.response, teams.factors, kCrossed).effects;
    for (const auto& group : marginal_means(model, 0, 1)) benchmark::DoNotOptimize(estimate_pairs(model, group));
  }
}
BENCHMARK(BM_MarginalMeans)->Arg(240)->Arg(20'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kith
