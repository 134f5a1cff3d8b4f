#include <fmt/format.h>
#include <fmt/ranges.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string_view>

#include "bench_report.hpp"
#include "commands.hpp"
#include "exit_codes.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith_build_info.hpp"
#include "machine.hpp"
#include "name_pattern.hpp"
#include "progress.hpp"

namespace kith::cli {
namespace {

// Regular expressions can take for ever; names are short, and few.
std::function<bool(const std::string&)> selector(const std::string& filter) {
  constexpr std::size_t kLongest = 1000;
  if (filter.size() > kLongest) {
    throw Error{ErrorKind::kUsage,
                fmt::format("--filter has {} characters; at most {} are read", filter.size(), kLongest)};
  }
  return [filter](const std::string& name) { return matches_somewhere(filter, name); };
}

void check_selection(const BenchOptions& options, const std::function<bool(const std::string&)>& selects) {
  std::vector<std::string> names;
  if (options.growth) {
    for (const auto& one : bench::all_growths()) names.push_back(one.name);
  } else {
    for (const auto& one : bench::all_cases()) names.push_back(one.name);
  }
  for (const auto& name : names) {
    if (selects(name)) return;
  }
  throw Error{ErrorKind::kUsage,
              fmt::format("--filter '{}' selects nothing; there are: {}", options.filter, fmt::join(names, ", "))};
}

Baseline read_baseline(const std::string& file, Console& console) {
  const auto input = read_input(file);
  auto reading = parse_baseline(input.text, input.name);
  if (!reading.diagnostics.empty()) throw Error{reading.diagnostics};
  const auto& baseline = reading.baseline;
  const auto compare = [&](const char* what, std::string_view before, std::string_view now) {
    if (before != now) console.warning(fmt::format("the baseline has a different {}: {}", what, before));
  };
  compare("processor", baseline.processor, processor_name());
  compare("compiler", baseline.compiler, build_info::kCompiler);
  compare("build type", baseline.build_type, build_info::kBuildType);
  return std::move(reading.baseline);
}

void check_save(const BenchOptions& options) {
  std::error_code ignored;
  if (!options.save.empty() && std::filesystem::exists(options.save, ignored) && !options.yes)
    throw Error{ErrorKind::kUsage, options.save + " exists; --yes replaces it"};
}

// What keeps figures from meaning what they seem to.
void warn_about_machine(const BenchOutcome& outcome, Console& console) {
  const double cores = static_cast<double>(usable_cores());
  const double waited = bench::waited(outcome.result);
  if (outcome.load_before > 0.3 * cores || waited > 0.05) {
    console.warning(
        fmt::format("the machine is busy: load {:.1f} on {:.0f} cores before, {:.0f} % of the time spent waiting; "
                    "times of studies are too long, but ratios are reliable",
                    outcome.load_before, cores, 100.0 * waited));
  }
  if (std::string_view{build_info::kBuildType} != "Release")
    console.warning(fmt::format("this is a {} build", build_info::kBuildType));
}

// The exit code: 0, or that something is not as it was or should be.
int verdict(const BenchOutcome& outcome, Console& console) {
  bool good = true;
  for (const auto& one : outcome.result.cases) {
    if (!one.disagreement || one.disagreement->empty()) continue;
    console.warning(one.which->name + " and its rival disagree: " + *one.disagreement);
    good = false;
  }
  const auto slower = slower_cases(outcome);
  if (!slower.empty()) {
    console.warning(fmt::format("slower than the baseline by more than {:.0f} %: {}", 100.0 * outcome.tolerance,
                                fmt::join(slower, ", ")));
  }
  return good && slower.empty() ? 0 : exit_code(ErrorKind::kMismatch);
}

// A comparison of nothing would always succeed.
void check_overlap(const Baseline& baseline, const std::function<bool(const std::string&)>& selects,
                   const std::string& file) {
  for (const auto& one : bench::all_cases()) {
    if (selects(one.name) && baseline.cases.count(one.name) > 0) return;
  }
  Diagnostic diagnostic;
  diagnostic.id = "E1004";
  diagnostic.file = file == "-" ? "<stdin>" : file;
  diagnostic.message = "the baseline has none of the cases that would be timed";
  diagnostic.hint = "save one with the same --filter";
  throw Error{{diagnostic}};
}

int list(Console& console) {
  if (console.json()) {
    console.print_json(bench_list_document());
  } else {
    console.print(bench_list_text(console));
  }
  return 0;
}

}  // namespace

int run_bench(const BenchOptions& options, Console& console) {
  if (options.list) return list(console);
  const auto selects = selector(options.filter);
  check_selection(options, selects);
  check_save(options);
  std::optional<Baseline> baseline;
  if (!options.baseline.empty()) {
    baseline = read_baseline(options.baseline, console);
    check_overlap(*baseline, selects, options.baseline);
  }

  BenchOutcome outcome;
  outcome.quick = options.quick;
  outcome.threads = options.threads > 0 ? options.threads : usable_cores();
  outcome.load_before = load_average();
  outcome.tolerance = std::strtod(options.tolerance.c_str(), nullptr);
  outcome.baseline = baseline ? &*baseline : nullptr;

  watch_signals();
  Progress progress{options.progress, console, "cases"};
  bench::SuiteOptions suite;
  suite.quick = options.quick;
  suite.threads = outcome.threads;
  suite.selects = selects;
  suite.growth = options.growth;
  suite.on_progress = [&](std::size_t done, std::size_t total) { progress.update(done, total); };
  suite.stopped = [] { return stop_signal() != 0; };
  outcome.result = bench::run_suite(suite);
  progress.finish();
  outcome.load_after = load_average();
  if (outcome.result.stopped) {
    console.warning("interrupted; nothing was saved");
    return 128 + (stop_signal() != 0 ? stop_signal() : SIGINT);
  }
  warn_about_machine(outcome, console);
  const auto document = bench_document(outcome);
  if (!options.save.empty()) write_file_atomically(options.save, document.dump(2) + "\n");
  if (console.json()) {
    console.print_json(document);
  } else {
    console.print(bench_text(outcome, console));
  }
  return verdict(outcome, console);
}

}  // namespace kith::cli
