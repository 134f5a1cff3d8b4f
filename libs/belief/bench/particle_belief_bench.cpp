#include "kith/belief/particle_belief.hpp"

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "../tests/observed_truth.hpp"
#include "kith/belief/consistency.hpp"
#include "kith/belief/team_belief.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

// n half-spaces that share the direction (1, 2, -4), as demonstrations of one robot do.
std::vector<HalfSpace> half_spaces(std::size_t n) {
  RandomStream random{1};
  std::vector<HalfSpace> list;
  while (list.size() < n) {
    IntegerVector normal(3);
    for (std::size_t k = 0; k < 3; ++k) normal[k] = static_cast<std::int64_t>(uniform_index(9, random)) - 4;
    const IntegerVector inside{1, 2, -4};
    if (dot(normal, inside) > 0) list.emplace_back(normal);
  }
  return list;
}

Cone prior() { return *Cone::intersection(std::vector{HalfSpace{{0, 0, -1}}}); }

void update(benchmark::State& state, double resample_below, double process_noise) {
  const auto list = half_spaces(static_cast<std::size_t>(state.range(0)));
  const HalfSpaceLikelihood likelihood{0.8};
  const ParticleBelief start{prior(), {.process_noise = process_noise, .resample_below = resample_below}};
  std::vector<HalfSpace> opposite;
  for (const HalfSpace& h : list) opposite.push_back(h.opposite());
  ParticleBelief belief = start;
  const RandomStream random{2};
  std::uint64_t n = 0;
  for (auto _ : state) {
    // Contradicting itself, the evidence never lets the belief settle.
    belief.observe(n % 2 == 0 ? list : opposite, likelihood, random.split(n));
    ++n;
    benchmark::DoNotOptimize(belief.weights().data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(belief.size()));
  state.counters["resamplings"] =
      benchmark::Counter(static_cast<double>(belief.num_resamplings()), benchmark::Counter::kAvgIterations);
}

// What does an update of 1 000 particles cost when it only weighs them?
void BM_Weigh(benchmark::State& state) { update(state, 0.0, 0.1); }
BENCHMARK(BM_Weigh)->Arg(1)->Arg(3)->Arg(8);

// ... and when it always resamples and moves them as well?
void BM_WeighResampleMove(benchmark::State& state) { update(state, 1.0, 0.1); }
BENCHMARK(BM_WeighResampleMove)->Arg(1)->Arg(3)->Arg(8);

void BM_WeighResample(benchmark::State& state) { update(state, 1.0, 0.0); }
BENCHMARK(BM_WeighResample)->Arg(3);

void BM_Diffuse(benchmark::State& state) {
  ParticleBelief belief{prior(), {}};
  const RandomStream random{2};
  std::uint64_t n = 0;
  for (auto _ : state) belief.diffuse(0.05, random.split(n++));
}
BENCHMARK(BM_Diffuse);

// The baseline: one std::exp per particle and half-space, densities multiplied, then normalised.
void BM_NaiveWeigh(benchmark::State& state) {
  const auto list = half_spaces(static_cast<std::size_t>(state.range(0)));
  const HalfSpaceLikelihood likelihood{0.8};
  const ParticleBelief belief{prior(), {}};
  std::vector<double> weights(belief.weights().begin(), belief.weights().end());
  for (auto _ : state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      for (const HalfSpace& h : list) weights[i] *= likelihood.density(h.margin(belief.point(i)));
      sum += weights[i];
    }
    for (double& weight : weights) weight /= sum;
    benchmark::DoNotOptimize(weights.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(weights.size()));
}
BENCHMARK(BM_NaiveWeigh)->Arg(1)->Arg(3)->Arg(8);

// The baseline of a whole step: densities with std::exp, one normalisation, systematic
// resampling by a walk along the cumulative weights, one normal at a time for the noise.
void BM_NaiveWeighResampleMove(benchmark::State& state) {
  const auto list = half_spaces(static_cast<std::size_t>(state.range(0)));
  const HalfSpaceLikelihood likelihood{0.8};
  const ParticleBelief start{prior(), {}};
  std::vector<HalfSpace> opposite;
  for (const HalfSpace& h : list) opposite.push_back(h.opposite());
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < start.size(); ++i) points.push_back(start.point(i));
  std::vector<double> weights(points.size());
  RandomStream random{2};
  std::uint64_t round = 0;
  for (auto _ : state) {
    double sum = 0.0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      weights[i] = 1.0;
      for (const HalfSpace& h : round % 2 == 0 ? list : opposite) weights[i] *= likelihood.density(h.margin(points[i]));
      sum += weights[i];
      mean += weights[i] * points[i];
    }
    mean.normalize();
    double square = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double angle = std::acos(std::clamp(mean.dot(points[i]), -1.0, 1.0));
      square += weights[i] / sum * angle * angle;
    }
    const double noise = 0.1 * std::sqrt(square) * std::pow(static_cast<double>(points.size()), -1.0 / 6.0);
    std::vector<Eigen::Vector3d> next;
    double reached = weights[0];
    std::size_t from = 0;
    const double offset = uniform01(random);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double at = (static_cast<double>(k) + offset) / static_cast<double>(points.size()) * sum;
      while (reached < at && from + 1 < points.size()) reached += weights[++from];
      const Eigen::Vector3d& p = points[from];
      Eigen::Vector3d moved;
      do {
        const Eigen::Vector3d first = p.unitOrthogonal();
        const double along = noise * standard_normal(random);
        const double across = noise * standard_normal(random);
        const double angle = std::hypot(along, across);
        moved = std::cos(angle) * p + std::sin(angle) / angle * (along * first + across * p.cross(first));
      } while (moved.z() > 0.0);
      next.push_back(moved.normalized());
    }
    points.swap(next);
    ++round;
    benchmark::DoNotOptimize(points.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(BM_NaiveWeighResampleMove)->Arg(3);

// How does a step grow with the number of particles?
void BM_StepOfParticles(benchmark::State& state) {
  const auto list = half_spaces(3);
  const HalfSpaceLikelihood likelihood{0.8};
  ParticleBelief belief{prior(), {.particles = static_cast<std::size_t>(state.range(0)), .resample_below = 1.0}};
  std::vector<HalfSpace> opposite;
  for (const HalfSpace& h : list) opposite.push_back(h.opposite());
  const RandomStream random{2};
  std::uint64_t n = 0;
  for (auto _ : state) {
    belief.observe(n % 2 == 0 ? list : opposite, likelihood, random.split(n));
    ++n;
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BM_StepOfParticles)->Arg(250)->Arg(500)->Arg(1000)->Arg(2000)->Arg(4000)->Arg(16000)->Complexity();

void BM_CopyABelief(benchmark::State& state) {
  const ParticleBelief belief{prior(), {}};
  for (auto _ : state) benchmark::DoNotOptimize(ParticleBelief{belief});
}
BENCHMARK(BM_CopyABelief);

void BM_MakeACover(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(PriorCover{prior(), 1000});
}
BENCHMARK(BM_MakeACover);

// What does an update of 1 000 particles cost in d dimensions? A belief takes in 50 observations of one or two
// half-spaces, one after the other; s_per_update is the mean.
void BM_UpdateInDimensions(benchmark::State& state) {
  const auto d = static_cast<std::size_t>(state.range(0));
  constexpr std::size_t kUpdates = 50;
  RandomStream random{5};
  const auto likelihoods = testing::some_likelihoods(d);
  const Direction truth = testing::draw_truth(d, random);
  const auto observations = testing::draw_observations(truth, kUpdates, likelihoods, random);
  const ParticleBelief start{testing::negative_last(d), {}};
  std::uint64_t n = 0;
  for (auto _ : state) {
    ParticleBelief belief = start;
    testing::observe_all(belief, observations, random.split(n++));
    benchmark::DoNotOptimize(belief.weights().data());
  }
  state.counters["s_per_update"] = benchmark::Counter(
      static_cast<double>(kUpdates), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_UpdateInDimensions)->Arg(4)->Arg(6)->Arg(8)->Unit(benchmark::kMillisecond);

// How long does it take to reconcile 30 members with 4 random half-spaces each?
void BM_ReconcileThirtyMembers(benchmark::State& state) {
  RandomStream random{3};
  std::vector<std::vector<HalfSpace>> lists(30);
  for (auto& list : lists) {
    while (list.size() < 4) {
      IntegerVector normal(3);
      for (std::size_t k = 0; k < 3; ++k) normal[k] = static_cast<std::int64_t>(uniform_index(19, random)) - 9;
      if (!normal.is_zero()) list.emplace_back(normal);
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(largest_consistent_subsets(lists, prior()));
}
BENCHMARK(BM_ReconcileThirtyMembers)->Unit(benchmark::kMillisecond);

// And three members of whom one contradicts the others?
void BM_ReconcileThreeMembers(benchmark::State& state) {
  const auto list = half_spaces(3);
  const std::vector<std::vector<HalfSpace>> lists{list, {list[0].opposite()}, {list[1]}};
  for (auto _ : state) benchmark::DoNotOptimize(largest_consistent_subsets(lists, prior()));
}
BENCHMARK(BM_ReconcileThreeMembers);

// One period of a team of three: a lesson, answers of which one contradicts the others, and feedback.
void BM_TeamPeriod(benchmark::State& state) {
  const auto list = half_spaces(3);
  const std::vector<std::vector<HalfSpace>> responses{list, {list[0].opposite()}, {list[1]}};
  TeamBelief team{prior(), {}, {RandomStream{1}, RandomStream{2}, RandomStream{3}}, RandomStream{4}};
  std::uint64_t period = 0;
  for (auto _ : state) {
    ++period;
    team.observe_demonstrations(list, period);
    benchmark::DoNotOptimize(team.observe_responses(responses, period));
    team.observe_feedback(list, period);
  }
}
BENCHMARK(BM_TeamPeriod);

}  // namespace
}  // namespace kith
