#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "kith/random/distributions.hpp"
#include "kith/stats/mixed_model.hpp"

namespace kith {
namespace {

// Teams of three learners, four strategies by three types; optionally each learner several times.
struct Learners {
  std::vector<Factor> factors{{"strategy", {"0", "1", "2", "3"}, {}}, {"type", {"0", "1", "2"}, {}}};
  std::vector<Factor> groups{{"team", {}, {}}, {"team:member", {}, {}}};
  std::vector<double> response;

  Learners(std::size_t teams, std::size_t periods) {
    RandomStream random{12};
    for (std::size_t team = 0; team < teams; ++team) {
      groups[0].levels.push_back(std::to_string(team));
      const double of_team = standard_normal(random);
      for (std::size_t member = 0; member < 3; ++member) {
        groups[1].levels.push_back(std::to_string(3 * team + member));
        const double of_member = standard_normal(random);
        for (std::size_t period = 0; period < periods; ++period) {
          factors[0].codes.push_back(team % 4);
          factors[1].codes.push_back(member);
          groups[0].codes.push_back(team);
          groups[1].codes.push_back(3 * team + member);
          response.push_back(of_team + of_member + standard_normal(random));
        }
      }
    }
  }
};

const std::vector<std::vector<std::size_t>> kStrategyByType{{0}, {1}, {0, 1}};

void fit_learners(benchmark::State& state, const Learners& learners, std::size_t groupings, bool test_variances) {
  for (auto _ : state) {
    const auto model = fit_mixed_model(learners.response, learners.factors, kStrategyByType,
                                       std::span{learners.groups}.first(groupings), {.test_variances = test_variances});
    benchmark::DoNotOptimize(term_tests(model->fixed, SumsOfSquares::kTypeIII));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(learners.response.size()));
}

// What does a random intercept of teams cost, with the tests of all terms? Up to 60 000 learners.
void BM_RandomIntercept(benchmark::State& state) {
  fit_learners(state, Learners{static_cast<std::size_t>(state.range(0)), 1}, 1, false);
}
BENCHMARK(BM_RandomIntercept)->Arg(240)->Arg(20'000)->Unit(benchmark::kMillisecond);

// The same with the likelihood-ratio test of the variance and the interval of the intraclass correlation.
void BM_RandomInterceptWithItsTest(benchmark::State& state) {
  fit_learners(state, Learners{static_cast<std::size_t>(state.range(0)), 1}, 1, true);
}
BENCHMARK(BM_RandomInterceptWithItsTest)->Arg(240)->Arg(20'000)->Unit(benchmark::kMillisecond);

// What do members within teams cost? 60 000 rows of 15 000 members.
void BM_NestedRandomIntercepts(benchmark::State& state) {
  fit_learners(state, Learners{static_cast<std::size_t>(state.range(0)), 4}, 2, true);
}
BENCHMARK(BM_NestedRandomIntercepts)->Arg(60)->Arg(5'000)->Unit(benchmark::kMillisecond);

// What do people crossed with items cost, whose decomposition fills in? Up to 60 000 rows of 600 people and 100 items.
void BM_CrossedRandomIntercepts(benchmark::State& state) {
  const auto people = static_cast<std::size_t>(state.range(0));
  constexpr std::size_t kItems = 100;
  RandomStream random{13};
  const auto numbered = [](const char* name, std::size_t levels) {
    Factor factor{name, {}, {}};
    for (std::size_t level = 0; level < levels; ++level) factor.levels.push_back(std::to_string(level));
    return factor;
  };
  std::vector<Factor> groups{numbered("person", people), numbered("item", kItems)};
  std::vector<Factor> factors{numbered("condition", 3)};
  std::vector<double> of_item(kItems), response;
  for (auto& one : of_item) one = 0.5 * standard_normal(random);
  for (std::size_t person = 0; person < people; ++person) {
    const double own = standard_normal(random);
    for (std::size_t item = 0; item < kItems; ++item) {
      groups[0].codes.push_back(person);
      groups[1].codes.push_back(item);
      factors[0].codes.push_back((person + item) % 3);
      response.push_back(own + of_item[item] + standard_normal(random));
    }
  }
  for (auto _ : state) {
    const auto model = fit_mixed_model(response, factors, std::vector<std::vector<std::size_t>>{{0}}, groups);
    benchmark::DoNotOptimize(term_tests(model->fixed, SumsOfSquares::kTypeIII));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(response.size()));
}
BENCHMARK(BM_CrossedRandomIntercepts)->Arg(60)->Arg(600)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kith
