// kith's way and the plain way, in one run; ratios.py compares them with what they were.
#include <benchmark/benchmark.h>

#include "evidence.hpp"
#include "interaction.hpp"
#include "kith/domains/domain_file.hpp"
#include "naive_counterfactuals.hpp"
#include "naive_filter.hpp"

namespace kith::rivals {
namespace {

const Atlas& atlas() {
  static const Atlas made{load_domain("item-delivery")};
  return made;
}

// A filter step: 1 000 particles are weighed by three constraints, resampled and moved.
template <class Filter, class Observe>
void steps(benchmark::State& state, const Filter& start, Observe&& observe) {
  const Evidence evidence{3};
  Filter filter = start;
  std::uint64_t turn = 0;
  for (auto _ : state) {
    if (turn % kSession == 0) filter = start;
    observe(filter, evidence.at(turn), turn);
    ++turn;
  }
  benchmark::DoNotOptimize(filter.weights()[0]);
}

ParticleBelief start() { return ParticleBelief{prior_cone(), {.resample_below = 1.0}}; }

void step(benchmark::State& state) {
  steps(state, start(), [](ParticleBelief& belief, const std::vector<HalfSpace>& seen, std::uint64_t turn) {
    belief.observe(seen, HalfSpaceLikelihood{0.8}, RandomStream{2}.split(turn));
  });
}
BENCHMARK(step);

void step_naive(benchmark::State& state) {
  steps(state, NaiveFilter{start(), prior_half_spaces(), RandomStream{2}},
        [](NaiveFilter& filter, const std::vector<HalfSpace>& seen, std::uint64_t /*turn*/) {
          filter.observe(seen, HalfSpaceLikelihood{0.8});
        });
}
BENCHMARK(step_naive);

// What all demonstrations of item delivery would convey to eight people, none met before.
void selection(benchmark::State& state) {
  const Interaction interaction{atlas()};
  std::uint64_t turn = 0;
  for (auto _ : state) benchmark::DoNotOptimize(atlas().tables().conveyed_by_class(interaction.cells(turn++ % 64)));
}
BENCHMARK(selection);

void selection_naive(benchmark::State& state) {
  const Interaction interaction{atlas()};
  const NaiveCounterfactuals naive{atlas()};
  std::uint64_t turn = 0;
  for (auto _ : state) benchmark::DoNotOptimize(naive.conveyed(interaction.people(turn++ % 64)));
}
BENCHMARK(selection_naive);

}  // namespace
}  // namespace kith::rivals
