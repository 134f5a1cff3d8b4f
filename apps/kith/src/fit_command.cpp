#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "fit_json.hpp"
#include "fit_text.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/fit/accuracy.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/grid_search.hpp"
#include "kith/fit/import_logs.hpp"
#include "kith/present/json.hpp"
#include "progress.hpp"

namespace kith::cli {
namespace {

void check_out(const FitCommandOptions& options) {
  std::error_code ignored;
  if (options.out.empty() || options.yes || !std::filesystem::is_regular_file(options.out, ignored)) return;
  throw Error{ErrorKind::kUsage, options.out + " exists; choose another name, or add --yes to replace it"};
}

int wrote_nothing(Console& console) {
  const std::string message = "interrupted; nothing was written";
  console.warning(message);
  if (console.json()) {
    Diagnostic diagnostic;
    diagnostic.id = "interrupted";
    diagnostic.message = message;
    console.print_json(error_document({diagnostic}));
  }
  return 128 + (stop_signal() != 0 ? stop_signal() : SIGINT);
}

int finish(const FitCommandOptions& options, const Json& document, const std::string& text, Console& console) {
  if (!options.out.empty()) write_file_atomically(options.out, document.dump(2) + "\n");
  if (console.json()) {
    console.print_json(document);
  } else {
    console.print(text);
  }
  if (!options.out.empty()) console.info("result written to " + options.out);
  return 0;
}

// Learning goes on without process noise in the published search.
std::optional<std::vector<GridSearchGroup>> search_grid(ResponseLogs logs, const LikelihoodOptions& options) {
  for (auto& model : logs.models) model.filter.process_noise = 0.0;
  const auto table = log_likelihoods(logs, published_grid(), options);
  if (!table.complete) return std::nullopt;
  return grid_search(logs, table);
}

}  // namespace

int run_fit(const FitCommandOptions& options, Console& console) {
  check_out(options);
  const auto detail = options.answers == "path" ? AnswerDetail::kPath : AnswerDetail::kVerdict;
  const auto imported = import_logs({options.logs.begin(), options.logs.end()}, detail);
  if (!console.quiet()) console.show(imported.logs.notes);
  if (!imported.accuracy.empty()) {
    if (options.method == "grid") {
      throw Error{ErrorKind::kUsage,
                  "--method grid needs logs that tell what people saw; these tell only what they answered"};
    }
    const auto fit = fit_accuracy(imported.accuracy);
    return finish(options, to_json(fit), text_of(fit, console), console);
  }

  watch_signals();
  Progress progress{options.progress, console};
  const ParallelOptions parallel{.threads = options.threads, .on_progress = [&](std::size_t done, std::size_t total) {
                                   progress.update(done, total);
                                   return stop_signal() == 0;
                                 }};
  if (options.method == "grid") {
    const auto groups =
        search_grid(imported.logs, {.replicates = options.replicates, .seed = options.seed, .parallel = parallel});
    progress.finish();
    if (!groups) return wrote_nothing(console);
    return finish(options, to_json(*groups), text_of(*groups, console), console);
  }
  FitOptions fit_options;
  fit_options.replicates = options.replicates;
  fit_options.seed = options.seed;
  fit_options.num_types = options.types;
  fit_options.folds = options.folds;
  fit_options.parallel = parallel;
  const auto report = fit_learners(imported.logs, fit_options);
  progress.finish();
  if (!report.complete) return wrote_nothing(console);
  return finish(options, to_json(report, imported.logs.notes), text_of(report, console), console);
}

}  // namespace kith::cli
