#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "commands.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "kith/core/error.hpp"
#include "kith/study/run_folder.hpp"
#include "kith/study/study.hpp"
#include "kith/study/summary.hpp"
#include "kith_build_info.hpp"
#include "progress.hpp"
#include "summary_json.hpp"
#include "words.hpp"

namespace kith::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

// What was typed, as the system remembers it.
std::vector<std::string> command_line() {
  std::ifstream file{"/proc/self/cmdline", std::ios::binary};
  const std::string all{std::istreambuf_iterator<char>{file}, {}};
  std::vector<std::string> words;
  for (std::size_t i = 0; i < all.size();) {
    const auto end = std::min(all.find('\0', i), all.size());
    words.push_back(all.substr(i, end - i));
    i = end + 1;
  }
  return words;
}

RunFacts facts_of_build() {
  RunFacts facts;
  facts.version = build_info::kVersion;
  facts.git = build_info::kGitId;
  facts.dirty = build_info::kGitDirty;
  facts.compiler = build_info::kCompiler;
  facts.build_type = build_info::kBuildType;
  facts.flags = build_info::kFlags;
  facts.command_line = command_line();
  return facts;
}

std::string mean_sd_text(const MeanSd& value, int digits) {
  if (!value.sd) return fmt::format("{:.{}f}", value.mean, digits);
  return fmt::format("{:.{}f} ({:.{}f})", value.mean, digits, *value.sd, digits);
}

void add_row(TextTable& table, std::vector<std::string> keys, const CellSummary& cell) {
  keys.push_back(fmt::format("{}", cell.teams));
  keys.push_back(fmt::format("{}", cell.completed));
  keys.push_back(mean_sd_text(cell.periods, 2));
  keys.push_back(mean_sd_text(cell.knowledge, 3));
  keys.push_back(mean_sd_text(cell.area_sr, 3));
  table.add(std::move(keys));
}

// What the figures are, below the table.
std::string table_notes(const StudySummary& summary, const Console& console) {
  std::string text =
      "\ncells: mean (sd over teams); knowledge: the team's mean mass of final belief in the policy's class;\n"
      "area/sr: mean solid angle of the weights that fit one period's lesson, in steradians";
  if (summary.group) text += "\nall groups: the teams of every strategy but the baseline, together";
  return console.dim(text) + "\n";
}

std::string table_of(const Study& study, const StudySummary& summary, const Console& console) {
  const auto& factors = study.variants.front().factors;
  TextTable table{"ll" + std::string(factors.size(), 'l') + "rrrrr"};
  std::vector<std::string> header{"strategy", "composition"};
  for (const auto& factor : factors) header.push_back(factor.key);
  for (const auto* name : {"teams", "completed", "periods", "knowledge", "area/sr"}) header.emplace_back(name);
  table.add(header);
  for (const auto& cell : summary.cells) {
    std::vector<std::string> keys{std::string{name_of(*cell.strategy)}, cell.composition};
    for (const auto& factor : study.variants[cell.variant].factors) keys.push_back(factor.value);
    add_row(table, keys, cell);
  }
  std::vector<std::string> all(2 + factors.size());
  if (summary.group) {
    all[0] = "all groups";
    add_row(table, all, *summary.group);
  }
  if (summary.baseline) {
    all[0] = "all baseline";
    add_row(table, all, *summary.baseline);
  }
  return table.text(console) + table_notes(summary, console);
}

std::vector<std::string> overrides_of(const StudyOptions& options) {
  auto overrides = options.set;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  return overrides;
}

// Whether the results could be written there; nothing is made. @throws kith::Error as RunFolder does.
void check_folder(const StudyOptions& options, const StudyReading& reading) {
  std::filesystem::path path{options.out};
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) {
    (void)RunFolder{path, freeze(reading), options.yes};
    return;
  }
  path = std::filesystem::absolute(path);
  while (!std::filesystem::exists(path, failure) && path.has_relative_path()) path = path.parent_path();
  if (!std::filesystem::is_directory(path, failure))
    throw Error{ErrorKind::kIo, "cannot make the folder " + options.out + ": " + path.string() + " is not a folder"};
  if (access(path.c_str(), W_OK | X_OK) != 0)
    throw Error{ErrorKind::kIo,
                "cannot make the folder " + options.out + ": no permission to write in " + path.string()};
}

int dry_run(const Study& study, std::size_t teams, Console& console) {
  const auto& spec = study.variants.front();
  if (console.json()) {
    print_plan(study, teams, console);
    return 0;
  }
  console.print(
      fmt::format("study {}: {} in {}, seed {}\n  {} x {} x {} x {}\nNothing was run.\n", spec.id,
                  counted(teams, "team"), spec.domain, spec.seed, counted(study.variants.size(), "variant"),
                  spec.strategies.size() == 1 ? "1 strategy" : fmt::format("{} strategies", spec.strategies.size()),
                  counted(spec.compositions.size(), "composition"), counted(spec.replicates, "replicate")));
  return 0;
}

int interrupted(const StudyOptions& options, std::size_t done, std::size_t total, bool had_results, Console& console) {
  const int signal = stop_signal();
  const auto message =
      fmt::format("interrupted after {} of {} teams; nothing was written{}. The same command runs the study again",
                  done, total, had_results ? ", and the results in " + options.out + " are as they were" : "");
  console.warning(message);
  if (console.json()) {
    Diagnostic diagnostic;
    diagnostic.id = "interrupted";
    diagnostic.message = message;
    console.print_json(error_document({diagnostic}));
  }
  return 128 + (signal != 0 ? signal : SIGINT);
}

}  // namespace

int run_study(const StudyOptions& options, Console& console) {
  const auto begin = Clock::now();
  auto facts = facts_of_build();
  facts.started = utc_now();
  const auto note = [&](const std::string& text) {
    facts.log.push_back(utc_now() + " " + text);
    console.detail(text);
  };

  const auto reading = study_of(options.study, overrides_of(options));
  if (!console.quiet()) console.show(reading.diagnostics);
  const auto& study = *reading.study;
  const auto addresses = team_addresses(study);
  if (options.dry_run && !options.out.empty()) check_folder(options, reading);
  if (options.dry_run) return dry_run(study, addresses.size(), console);
  if (options.out.empty()) throw Error{ErrorKind::kUsage, "kith study needs -o DIR, the folder for the results"};

  watch_signals();
  RunFolder folder{options.out, freeze(reading), options.yes};
  facts.domain = study.variants.front().domain;
  facts.threads = options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
  note(fmt::format("study {}: {} teams in {}", study.variants.front().id, addresses.size(), facts.domain));
  facts.timings.emplace_back("read", seconds_since(begin));

  const auto plan_begin = Clock::now();
  const Atlas atlas{*reading.domain};
  facts.timings.emplace_back("plan", seconds_since(plan_begin));
  note(fmt::format("planned {} demonstrations", atlas.num_demos()));

  const auto teach_begin = Clock::now();
  Progress progress{options.progress, console};
  const auto result = run_teams(atlas, study, addresses,
                                {.threads = options.threads, .on_progress = [&](std::size_t done, std::size_t total) {
                                   progress.update(done, total);
                                   return stop_signal() == 0;
                                 }});
  progress.finish();
  if (result.stopped && result.teams.size() < addresses.size()) {
    return interrupted(options, result.teams.size(), addresses.size(), folder.has_results(), console);
  }
  facts.timings.emplace_back("teach", seconds_since(teach_begin));
  note(fmt::format("taught {} teams", result.teams.size()));
  const auto summary = summarize(result.teams);
  facts.stopped = utc_now();
  folder.publish(study, result.teams, facts);

  const double seconds = seconds_since(begin);
  if (console.json()) {
    print_summary(study, summary, result.teams.size(), seconds, console);
    return 0;
  }
  console.print(table_of(study, summary, console));
  console.info(fmt::format("{} in {:.2f} s; tables in {}/tables, columns in codebook.json",
                           counted(result.teams.size(), "team"), seconds, options.out));
  return 0;
}

}  // namespace kith::cli
