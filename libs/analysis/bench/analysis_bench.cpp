#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>

#include "kith/analysis/analysis.hpp"
#include "kith/core/distributions.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

// Five strategies, four compositions; the same people under every strategy, or other people in every team.
RunTeams teams_of(std::size_t replicates, bool same_people) {
  RunTeams teams;
  teams.strategy = {"strategy", {"baseline", "individual-low", "individual-high", "common", "joint"}, {}};
  teams.composition = {"composition", {"NNN", "NNP", "NPP", "PPP"}, {}};
  RandomStream random{31};
  for (std::size_t s = 0; s < 5; ++s) {
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t r = 0; r < replicates; ++r) {
        const auto number = teams.size();
        teams.strategy.codes.push_back(s);
        teams.composition.codes.push_back(c);
        teams.setting.emplace_back();
        auto& team = teams.records.emplace_back();
        team.seed_address = fmt::format("7/{}/{}", c, same_people ? r : number);
        team.status = SessionStatus::kComplete;
        team.periods = 4 + uniform_index(6, random);
        team.knowledge = uniform01(random);
        team.area_sr = uniform01(random);
      }
    }
  }
  return teams;
}

// What does the analysis of a study cost? All findings but the manipulation check, of 300 and of 20 000 teams.
void analyse_study(benchmark::State& state, bool same_people) {
  const auto teams = teams_of(static_cast<std::size_t>(state.range(0)) / 20, same_people);
  const AnalysisOptions options;
  for (auto _ : state) {
    for (const auto& [name, values] : outcomes_of(teams)) {
      benchmark::DoNotOptimize(effects(teams, name, values, options));
      benchmark::DoNotOptimize(effects_within(teams, name, values, options));
      benchmark::DoNotOptimize(beliefs(teams, name, values, options));
      benchmark::DoNotOptimize(variation(teams, name, values, options));
      benchmark::DoNotOptimize(paired(teams, name, values, options));
      benchmark::DoNotOptimize(against_baseline(teams, name, values, options));
    }
  }
}
void BM_StudyOfTheSamePeople(benchmark::State& state) { analyse_study(state, true); }
BENCHMARK(BM_StudyOfTheSamePeople)->Arg(300)->Arg(20'000)->Unit(benchmark::kMillisecond);
void BM_StudyOfOtherPeople(benchmark::State& state) { analyse_study(state, false); }
BENCHMARK(BM_StudyOfOtherPeople)->Arg(300)->Arg(20'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kith
