#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "build_facts.hpp"
#include "command.hpp"
#include "exit_codes.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/explain/json.hpp"
#include "kith/runs/study_run.hpp"
#include "kith/study/study_memory.hpp"
#include "mpi_ranks.hpp"
#include "planning_input.hpp"
#include "progress.hpp"
#include "run_outcome.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct StudyOptions {
  std::string study;
  std::string out;
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  std::vector<std::string> set;
  bool dry_run = false;
  bool yes = false;  ///< Replace the results of a different study.
  Resume resume = Resume::kAuto;
  Shard shard;
  bool keep_going = false;  ///< Go on after a team that failed.
  ProgressMode progress = ProgressMode::kAuto;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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

// What stands in the way of teaching is said as if the study were run.
void say_how_long(const Study& study, const Domain& domain, std::size_t threads, std::size_t teams, Console& console) {
  require_study_memory(study, threads);
  require_teaching_memory(domain, threads);
  const Atlas atlas = planned(domain, console);
  const auto& spec = study.variants.front();
  const auto trial = try_cells(atlas, spec, threads);
  console.info(work_text(trial, teams));
  console.info(items_text(trial, spec));
}

// Tables and journal, measured with several studies of item delivery; others differ by a factor of two.
std::string disk_text(const Study& study) {
  constexpr double kBytesPerMember = 3500.0;
  double members = 0.0;
  for (const auto& spec : study.variants) {
    for (const auto& composition : spec.compositions) {
      members += static_cast<double>(composition.size() * spec.strategies.size() * spec.replicates);
    }
  }
  constexpr double kMega = 1e6, kGiga = 1e9;
  const double bytes = members * kBytesPerMember;
  if (bytes < kMega) return "less than 1 MB";
  return bytes < kGiga ? fmt::format("about {:.0f} MB", bytes / kMega) : fmt::format("about {:.1f} GB", bytes / kGiga);
}

int dry_run(const Study& study, std::size_t teams, Console& console) {
  const auto& spec = study.variants.front();
  if (console.json()) refuse("kith study --dry-run prints no JSON");
  console.print(fmt::format(
      "study {}: {} in {}, seed {}\n  {} x {} x {} x {}\n  {} on disk\nNothing was run.\n", spec.id,
      counted(teams, "team"), spec.domain, spec.seed, counted(study.variants.size(), "variant"),
      spec.strategies.size() == 1 ? "1 strategy" : fmt::format("{} strategies", spec.strategies.size()),
      counted(spec.compositions.size(), "composition"), counted(spec.replicates, "replicate"), disk_text(study)));
  for (const auto& type : spec.learner_types) {
    if (!type.knowing) continue;
    console.print(fmt::format("learners {} know the robot before an update, {}; the teacher {}\n", type.letter,
                              type.knowing->name, spec.teaching.known ? "knows that" : "does not know that"));
  }
  return 0;
}

// All that is finished is saved.
int interrupted(const StudyOptions& options, const StudyRun& run, std::size_t done, Console& console) {
  const auto what = fmt::format("interrupted after {} of {} teams; ", done, run.num_teams()) +
                    (done > 0 ? "they are saved in " + options.out : "nothing was saved");
  return interrupted(what, console,
                     options.study == "-" ? "the same command, with the same study on standard input" : shell_line());
}

StudyRunOptions run_options(const StudyOptions& options) {
  StudyRunOptions run;
  run.program = program_name();
  run.threads = options.threads;
  run.resume = options.resume;
  run.replace = options.yes;
  run.shard = options.shard;
  run.keep_going = options.keep_going;
  run.stopped = [] { return stop_signal() != 0; };
  return run;
}

// Shards have no tables of their own; merging them makes the tables.
int finish_shard(const StudyOptions& options, StudyRun& run, RunFacts facts, double seconds, Console& console) {
  facts.stopped = utc_now();
  run.publish_shard(std::move(facts));
  const auto name = fmt::format("{}/{}", options.shard.index, options.shard.count);
  if (console.json()) {
    console.print_json(Json{{"schema", "kith.study-shard/1"},
                            {"shard", {{"index", options.shard.index}, {"count", options.shard.count}}},
                            {"teams", run.num_done()},
                            {"failed", run.failures().size()},
                            {"seconds", seconds}});
  }
  if (!console.json() || !run.failures().empty()) report_failures(run.study(), run.failures(), console);
  console.info(fmt::format("shard {}: {} in {:.2f} s; merge the shards with: kith merge DIR... -o DIR", name,
                           counted(run.num_done(), "team"), seconds));
  return run.failures().empty() ? 0 : exit_code(ErrorKind::kPartial);
}

// "2/7": part 2 of 7.
Shard shard_of(const std::string& text) {
  const auto slash = std::min(text.find('/'), text.size());
  const auto count = text.substr(std::min(slash + 1, text.size()));
  if (!wrong_integer(count, {1, 1'000'000}).empty() ||
      !wrong_integer(text.substr(0, slash), {1, integer_of(count, {})}).empty()) {
    throw UsageError{"must be I/N, such as 2/7, with I from 1 to N, not '" + text + "'"};
  }
  return {static_cast<std::size_t>(integer_of(text.substr(0, slash), {})),
          static_cast<std::size_t>(integer_of(count, {}))};
}

void declare(OptionList& list, StudyOptions& options) {
  list.study(options.study).required();
  list.text("-o,--out", options.out, "DIR", "Run folder to create or to update");
  list.threads(options.threads, "; never changes a result");
  list.integer("--seed", options.seed, {}, "The same as --set seed=N");
  list.set(options.set);
  list.flag("--dry-run", options.dry_run, "Print what would be run and about how long it takes; write nothing");
  list.flag("--yes", options.yes, "Replace the results of a different study in the run folder");
  list.choice<Resume>("--resume", options.resume, "WHEN",
                      {{"auto", Resume::kAuto}, {"never", Resume::kNever}, {"require", Resume::kRequire}},
                      "Whether to resume an earlier run");
  list.value("--shard", "I/N", "Run part I of N; kith merge combines the parts",
             [&](const std::string& text) { options.shard = shard_of(text); });
  list.flag("--keep-going", options.keep_going, "Continue after a team fails; exit 6 at the end");
  list.progress(options.progress);
  list.json();
}

int run(const StudyOptions& options, Console& console) {
  const auto begin = Clock::now();
  auto facts = facts_of_build();
  facts.started = utc_now();
  const auto note = [&](const std::string& text) {
    facts.log.push_back(utc_now() + " " + text);
    console.detail(text);
  };

  auto reading = study_of(options.study, overrides_of(options));
  if (!console.quiet()) show_warnings(reading, console);
  if (options.dry_run && !options.out.empty()) check_folder(options, reading);
  if (options.dry_run) {
    const auto teams = num_teams(*reading.study);
    const auto threads = options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
    if (!console.quiet()) say_how_long(*reading.study, *reading.domain, threads, teams, console);
    return dry_run(*reading.study, teams, console);
  }
  if (options.out.empty()) refuse("kith study needs -o DIR, the folder for the results");

  const auto ranks = mpi_ranks();
  const bool speaks = !ranks || ranks->rank() == 0;
  if (!speaks) console = Console{{.quiet = true}};
  watch_signals();
  Progress progress{speaks ? options.progress : ProgressMode::kNone, console};
  std::size_t done = 0;
  auto how = run_options(options);
  how.ranks = ranks.get();
  if (how.threads == 0 && ranks) {
    how.threads = std::max<std::size_t>(1, std::thread::hardware_concurrency() / ranks->num_on_this_machine());
  }
  const auto how_many_threads = how.threads > 0 ? how.threads : std::thread::hardware_concurrency();
  how.on_progress = [&](std::size_t finished, std::size_t total, std::size_t failed) {
    done = finished;
    progress.update(finished, total, failed);
  };
  require_study_memory(*reading.study, how_many_threads);
  require_teaching_memory(*reading.domain, how_many_threads);
  const auto plan_begin = Clock::now();
  const Atlas atlas = planned(*reading.domain, console);
  const double plan_seconds = seconds_since(plan_begin);
  StudyRun run{options.out, std::move(reading), std::move(how)};
  done = run.num_resumed();
  const auto& study = run.study();
  facts.domain = study.variants.front().domain;
  facts.threads = how_many_threads;
  facts.ranks = ranks ? ranks->size() : 1;
  note(fmt::format("study {}: {} in {}", study.variants.front().id, counted(run.num_teams(), "team"), facts.domain));
  for (const auto& text : run.notes()) {
    facts.log.push_back(utc_now() + " " + text);
    console.warning(text);
  }
  if (run.num_resumed() > 0) {
    const auto text = fmt::format("{} of {} teams were already finished", run.num_resumed(), run.num_teams());
    facts.log.push_back(utc_now() + " " + text);
    console.info(text);
  }
  facts.timings.emplace_back("read", seconds_since(begin) - plan_seconds);
  facts.timings.emplace_back("plan", plan_seconds);
  note(fmt::format("planned {} demonstrations", atlas.num_states()));

  const auto teach_begin = Clock::now();
  progress.begin(run.num_resumed());
  const bool finished = run.teach(atlas);
  progress.finish();
  if (!finished) return interrupted(options, run, done, console);
  facts.timings.emplace_back("teach", seconds_since(teach_begin));
  note(fmt::format("taught {} teams", run.num_done() - run.num_resumed()));
  if (options.shard.count > 1) return finish_shard(options, run, std::move(facts), seconds_since(begin), console);
  return publish_run(run, std::move(facts), {options.out, begin, atlas.domain().num_features()}, console);
}

}  // namespace

void add_study(Commands& commands) {
  commands.add<StudyOptions>("study", "Simulate all teams of a study and write its tables",
                             {"kith study studies/paper.toml -o results/paper",
                              "kith study quick -o results/quick --set teacher.process_noise=0.5"},
                             declare, run);
}

}  // namespace kith::cli
