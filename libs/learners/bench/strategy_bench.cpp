#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "kith/domains/domain_file.hpp"
#include "kith/learners/bayesian_learner.hpp"
#include "kith/learners/run_period.hpp"

namespace kith {
namespace {

// What does a period of a team of three cost, with its simulated people and the exam left out of the session?
void BM_Period(benchmark::State& state, const std::string& strategy) {
  static const Atlas atlas{load_domain("item-delivery")};
  TeachingCache cache{atlas};
  const auto choice = strategy_named(strategy);
  std::size_t periods = 0;
  std::uint64_t team = 0;
  for (auto _ : state) {
    std::vector<RandomStream> streams;
    Learners learners;
    for (std::uint64_t person = 0; person < 3; ++person) {
      const auto stream = RandomStream{1}.split(team).split(person);
      streams.push_back(stream.split("teacher belief"));
      learners.push_back(std::make_unique<BayesianLearner>(
          ParticleBelief{cache.cover(atlas.prior_cone(), 1000), {}},
          BayesianPerson{
              .ability = 0.7 + 0.05 * static_cast<double>(person), .confirm_gain = 0.02, .correct_gain = 0.05},
          LikelihoodForm::kDiscontinuous, stream.split("learner")));
    }
    Session session{cache, {.mastery = stop_rule_named("fixed")}, choice, streams, RandomStream{1}.split(team++)};
    while (choice.kind.needs_truth ? session.propose(cache, truth_about(session, learners)) : session.propose(cache)) {
      run_period(session, cache, learners);
      ++periods;
    }
  }
  state.counters["period"] =
      benchmark::Counter(static_cast<double>(periods), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(BM_Period, joint, std::string{"joint"})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Period, plan, std::string{"plan"})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_Period, oracle, std::string{"oracle"})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kith
