// Breaks runs of kith in many ways and checks what becomes of them: README.md.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <sstream>
#include <thread>

#include "kith/core/error.hpp"
#include "options.hpp"
#include "sampling.hpp"
#include "summary.hpp"
#include "trial.hpp"

namespace kith::faults {
namespace {

using Clock = std::chrono::steady_clock;

void say(const std::string& text) { (void)std::fputs(text.c_str(), stdout), (void)std::fflush(stdout); }

std::vector<Scenario> chosen_scenarios(const Options& options) {
  auto all = all_scenarios(!options.tools.mpirun.empty());
  if (options.scenarios.empty()) return all;
  std::vector<Scenario> chosen;
  std::istringstream names{options.scenarios};
  for (std::string name; std::getline(names, name, ',');) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    if (found == all.end()) throw Error{ErrorKind::kUsage, "there is no scenario " + name};
    chosen.push_back(*found);
  }
  return chosen;
}

const Scenario& scenario_of(const Case& one, const std::vector<Scenario>& scenarios) {
  const auto found =
      std::find_if(scenarios.begin(), scenarios.end(), [&](const auto& other) { return other.name == one.scenario; });
  if (found == scenarios.end()) throw Error{ErrorKind::kUsage, "there is no scenario " + one.scenario};
  return *found;
}

std::string story(const Case& one, const Outcome& outcome) {
  return "WRONG --case '" + to_text(one) + "': " + outcome.wrong + "\n";
}

int replay(const Options& options, const Models& models, const std::vector<Scenario>& scenarios, Scratch& scratch) {
  const auto one = parse_case(options.only_case);
  if (!one) throw Error{ErrorKind::kUsage, "'" + options.only_case + "' is no case"};
  scratch.keep();
  const auto folder = scratch.path() / "case";
  std::filesystem::create_directory(folder);
  const auto outcome = try_case(*one, scenario_of(*one, scenarios), models, folder);
  say(!outcome.struck ? "the fault did not happen\n" : outcome.wrong.empty() ? "all well\n" : story(*one, outcome));
  say("its folder: " + folder.string() + "\n");
  return outcome.wrong.empty() ? 0 : 1;
}

// A few cases of a family after a few of another, so that all have their share of a limited time.
std::vector<Case> draw_cases(const Options& options, Sampler& sampler) {
  std::vector<std::vector<Case>> families;
  std::size_t total = 0;
  for (const auto& [family, number] : options.cases) {
    families.push_back(sampler.draw(family, number));
    if (families.back().empty()) {
      throw Error{ErrorKind::kUsage,
                  "no case of '" + family + "' can be drawn: does " + options.tools.shim.string() + " load?"};
    }
    total += families.back().size();
  }
  std::vector<Case> cases;
  std::vector<std::size_t> taken(families.size());
  for (std::size_t i = 1; i <= total; ++i) {
    for (std::size_t k = 0; k < families.size(); ++k) {
      const auto due = families[k].size() * i / total;
      while (taken[k] < due) cases.push_back(families[k][taken[k]++]);
    }
  }
  return cases;
}

Outcome try_safely(const Case& one, const Scenario& scenario, const Models& models,
                   const std::filesystem::path& folder) {
  try {
    return try_case(one, scenario, models, folder);
  } catch (const std::exception& error) {
    Outcome outcome;
    outcome.struck = true;
    outcome.wrong = std::string{"the harness fails: "} + error.what();
    return outcome;
  }
}

int try_all(const Options& options, const Models& models, const std::vector<Scenario>& scenarios,
            const Scratch& scratch) {
  Sampler sampler{models, scenarios, options.seed, scratch.path()};
  const auto cases = draw_cases(options, sampler);
  const auto begin = Clock::now();
  std::mutex mutex;
  Summary summary;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (auto i = next++; i < cases.size(); i = next++) {
      const std::chrono::duration<double> passed = Clock::now() - begin;
      if (options.seconds > 0.0 && passed.count() > options.seconds) return;
      const auto folder = scratch.path() / ("case-" + std::to_string(i));
      std::filesystem::create_directory(folder);
      const auto outcome = try_safely(cases[i], scenario_of(cases[i], scenarios), models, folder);
      std::filesystem::remove_all(folder);
      const std::lock_guard lock{mutex};
      summary.add(cases[i], outcome);
      if (!outcome.wrong.empty()) say(story(cases[i], outcome));
    }
  };
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < options.jobs; ++i) workers.emplace_back(work);
  }
  say(summary.text());
  if (summary.num_cases() < cases.size()) {
    say("out of time after " + std::to_string(summary.num_cases()) + " of " + std::to_string(cases.size()) +
        " cases\n");
  }
  return summary.num_wrong() == 0 ? 0 : 1;
}

int run_faults(const Options& options) {
  if (options.help) {
    say(usage());
    return 0;
  }
  const auto scenarios = chosen_scenarios(options);
  Scratch scratch;
  const Models models{options.tools, scratch.path()};
  return options.only_case.empty() ? try_all(options, models, scenarios, scratch)
                                   : replay(options, models, scenarios, scratch);
}

}  // namespace
}  // namespace kith::faults

int main(int argc, char** argv) {
  try {
    return kith::faults::run_faults(kith::faults::parse_options(argc, argv));
  } catch (const kith::Error& error) {
    (void)std::fprintf(stderr, "kith_faults: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    (void)std::fprintf(stderr, "kith_faults: %s\n", error.what());
    return 1;
  }
}
