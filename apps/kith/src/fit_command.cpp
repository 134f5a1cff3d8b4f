#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "command.hpp"
#include "fit_output.hpp"
#include "interrupt.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/fit/answer_regions.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/import_logs.hpp"
#include "page.hpp"
#include "planning_input.hpp"
#include "progress.hpp"

namespace kith::cli {
namespace {

struct FitCommandOptions {
  std::vector<std::string> logs;  ///< Run folders and tables of trials.
  std::string answers = "path";   ///< What of an answer counts: "path" or "verdict".
  std::string out;                ///< File for the JSON result; empty: none.
  std::size_t types = 0;          ///< Types without labels; 0: as labelled.
  std::size_t folds = 5;          ///< Of the cross-validation; 0: none.
  std::size_t replicates = 2;     ///< Runs of the filter per person.
  std::uint64_t seed = 1;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  bool yes = false;         ///< Replace an existing file.
  ProgressMode progress = ProgressMode::kAuto;
};

int finish(const FitCommandOptions& options, const Json& document, const std::string& text, Console& console) {
  if (!options.out.empty()) write_file_atomically(options.out, document.dump(2) + "\n");
  console.print([&] { return document; }, [&] { return text; });
  if (!options.out.empty()) console.info("result written to " + options.out);
  return 0;
}

// "computing the likelihood of 60 people takes about 12 s", from the time that one run takes for a few of them and two
// of the abilities. Cost is proportional to people, runs and abilities.
std::string likelihood_work_text(const ResponseLogs& logs, const ParameterGrid& grid, LikelihoodOptions options) {
  const auto threads = options.parallel.threads > 0 ? options.parallel.threads : std::thread::hardware_concurrency();
  const auto few = std::clamp<std::size_t>(threads, 1, logs.people.size());
  ResponseLogs probe{.people = {}, .models = logs.models, .sample = {}, .notes = {}};
  for (std::size_t i = 0; i < few; ++i) probe.people.push_back(logs.people[i * logs.people.size() / few]);
  auto coarse = grid;
  const auto n = grid.abilities.size();
  coarse.abilities = {grid.abilities[n / 4], grid.abilities[n - 1 - n / 4]};
  const auto runs = static_cast<double>(options.replicates);
  options.replicates = 1;
  options.parallel.on_progress = [](std::size_t, std::size_t) { return stop_signal() == 0; };
  const auto begin = std::chrono::steady_clock::now();
  (void)log_likelihoods(probe, coarse, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double share = static_cast<double>(few) / static_cast<double>(logs.people.size()) *
                       static_cast<double>(coarse.abilities.size()) / static_cast<double>(n);
  return fmt::format("computing the likelihood of {} people takes {}", logs.people.size(),
                     duration_text(took.count() * runs / share));
}

// Which weights give the answers of people, where no tables say it. False if it was interrupted.
bool sample_paths(ResponseLogs& logs, const FitCommandOptions& options, AnswerDetail detail, Console& console) {
  const auto num_notes = logs.notes.size();
  Progress progress{options.progress, console, "people"};
  const bool complete =
      find_answer_regions(logs, {.detail = detail,
                                 .seed = options.seed,
                                 .parallel = {.threads = options.threads, .on_progress = progress.until_stopped()}});
  progress.finish();
  if (!console.quiet()) console.show({logs.notes.begin() + static_cast<std::ptrdiff_t>(num_notes), logs.notes.end()});
  return complete;
}

void declare(OptionList& list, FitCommandOptions& options) {
  list.texts("logs", options.logs, "LOGS", "Run folders and tables with a row per trial").required();
  list.word("--answers", options.answers, "WHAT", {"path", "verdict"},
            "What of an answer counts: the path, or whether it is right");
  list.integer("--types", options.types, {1, 6}, "Types of people without labels (default: as labelled)");
  list.integer("--folds", options.folds, {0, 1000}, "Parts of the cross-validation; 0: none");
  list.integer("--replicates", options.replicates, {1, 1000}, "Runs of the particle filter per person");
  list.integer("--seed", options.seed, {}, "Seed of all random streams");
  list.threads(options.threads, "; never changes a result");
  list.text("-o,--out", options.out, "FILE", "Write the result to this file, as JSON");
  list.flag("--yes", options.yes, "Replace the file of -o if there is one");
  list.progress(options.progress);
  list.json();
}

int run(const FitCommandOptions& options, Console& console) {
  require_replaceable(options.out, options.yes);
  const auto detail = options.answers == "path" ? AnswerDetail::kPath : AnswerDetail::kVerdict;
  auto logs = import_logs({options.logs.begin(), options.logs.end()}, detail);
  if (!console.quiet()) console.show(logs.notes);
  watch_signals();
  Progress progress{options.progress, console, "replays"};
  const ParallelOptions parallel{.threads = options.threads, .on_progress = progress.until_stopped()};
  const LikelihoodOptions how{.replicates = options.replicates, .seed = options.seed, .parallel = parallel};
  if (!sample_paths(logs, options, detail, console)) return interrupted("interrupted; nothing was written", console);
  FitOptions fit_options;
  fit_options.replicates = options.replicates;
  fit_options.seed = options.seed;
  fit_options.num_types = options.types;
  fit_options.folds = options.folds;
  fit_options.parallel = parallel;
  if (!console.quiet() && !logs.people.empty()) console.info(likelihood_work_text(logs, grid_of(fit_options), how));
  const auto report = fit_learners(logs, fit_options);
  progress.finish();
  if (!report.complete) return interrupted("interrupted; nothing was written", console);
  const auto recovered = recovery(logs, report);
  return finish(options, to_json(report, recovered, logs.notes), text_of(report, recovered, console), console);
}

}  // namespace

void add_fit(Commands& commands) {
  commands.add<FitCommandOptions>("fit", "Estimate how people learn from what they saw and answered",
                                  {"kith fit results/paper -o fit.json", "kith fit trials.csv --types 2"}, declare,
                                  run);
}

}  // namespace kith::cli
