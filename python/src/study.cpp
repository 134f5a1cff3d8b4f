// Running, verifying and reading studies.
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "assignment.hpp"
#include "build_facts.hpp"
#include "errors.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/parallel_loop.hpp"
#include "kith/files/published_run.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/study_run.hpp"
#include "kith/runs/verify.hpp"
#include "kith/study/study_memory.hpp"
#include "own_kinds.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

Resume resume_of(const std::string& word) {
  if (word == "auto") return Resume::kAuto;
  if (word == "never") return Resume::kNever;
  if (word == "require") return Resume::kRequire;
  throw py::value_error{"resume must be 'auto', 'never' or 'require', not '" + word + "'"};
}

// What kith study says of a run, beside its tables.
struct Outcome {
  std::size_t teams = 0, resumed = 0;
  std::vector<std::string> notes, failures;
};

Outcome run_study(StudyReading reading, const std::string& out, StudyRunOptions options, Clock::time_point begin) {
  auto facts = cli::facts_of_build();
  facts.started = cli::utc_now();
  facts.threads = options.threads > 0 ? options.threads : default_num_workers();
  require_study_memory(*reading.study, facts.threads);
  require_teaching_memory(*reading.domain, facts.threads);
  const auto plan_begin = Clock::now();
  const Atlas atlas{*reading.domain};
  const double plan_seconds = seconds_since(plan_begin);
  StudyRun run{out, std::move(reading), std::move(options)};
  facts.domain = run.study().variants.front().domain;
  facts.log.push_back(cli::utc_now() + " study " + run.study().variants.front().id + ": " +
                      std::to_string(run.num_teams()) + " teams in " + facts.domain);
  for (const auto& note : run.notes()) facts.log.push_back(cli::utc_now() + " " + note);
  facts.timings.emplace_back("read", seconds_since(begin) - plan_seconds);
  facts.timings.emplace_back("plan", plan_seconds);
  const auto teach_begin = Clock::now();
  if (!run.teach(atlas)) throw Stopped{};
  facts.timings.emplace_back("teach", seconds_since(teach_begin));
  facts.stopped = cli::utc_now();
  run.publish(std::move(facts));
  Outcome outcome{run.num_teams(), run.num_resumed(), run.notes(), {}};
  for (const auto& [team, message] : run.failures())
    outcome.failures.push_back(describe_team(run.study(), team_address(run.study(), team)) + ": " + message);
  return outcome;
}

py::dict study(const std::string& name, const std::string& text, const std::vector<std::string>& overrides,
               const std::string& out, std::size_t threads, const std::string& resume, bool replace, bool keep_going,
               const py::object& on_progress) {
  const auto begin = Clock::now();
  const OwnKinds own;
  auto reading = read_study({name, text, overrides}, own.kinds());
  Watch watch;
  StudyRunOptions options;
  options.program = cli::program_name();
  if (const auto used = own.used_by(reading.study->variants); !used.empty()) options.program += " with " + used;
  options.threads = threads;
  options.resume = resume_of(resume);
  options.replace = replace;
  options.keep_going = keep_going;
  options.on_progress = [&](std::size_t done, std::size_t total, std::size_t failed) {
    watch.tell(done, total, failed);
  };
  options.stopped = [&] { return watch.stop.load(); };
  const auto outcome = wait_for(watch, on_progress, [&] { return run_study(std::move(reading), out, options, begin); });
  for (const auto& note : outcome.notes) warn(note);
  py::dict result;
  result["teams"] = outcome.teams;
  result["resumed"] = outcome.resumed;
  result["failures"] = outcome.failures;
  return result;
}

py::dict verify(const std::string& folder, double sample, std::size_t threads, const py::object& on_progress) {
  if (!(sample > 0.0) || sample > 1.0) throw py::value_error{"sample must be a share above 0 and at most 1"};
  const OwnKinds own;
  Watch watch;
  const auto result = wait_for(watch, on_progress, [&] {
    const auto reading = read_run_folder(folder, own.kinds());
    if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
    VerifyOptions options;
    options.sample = sample;
    options.threads = threads;
    options.on_progress = [&](std::size_t done, std::size_t total, std::size_t failed) {
      watch.tell(done, total, failed);
    };
    options.stopped = [&] { return watch.stop.load(); };
    return verify_run(folder, reading, Atlas{*reading.domain}, options);
  });
  if (!result.mismatches.empty())
    throw Error{ErrorKind::kMismatch, std::to_string(result.mismatches.size()) + " mismatches", result.mismatches};
  py::dict summary;
  summary["teams"] = result.teams;
  summary["checked"] = result.checked;
  summary["files"] = result.files;
  summary["program"] = result.program;
  return summary;
}

// How far the run in a folder is, finished or not.
py::dict status(const std::string& folder) {
  const auto progress = Journal::read(std::filesystem::path{folder} / kJournalFile).progress();
  py::dict result;
  result["done"] = progress.done;
  result["total"] = progress.total;
  std::vector<std::string> failures;
  for (const auto& failure : progress.failures)
    failures.push_back("team " + std::to_string(failure.team) + ": " + failure.message);
  result["failures"] = failures;
  return result;
}

py::str resolved(const std::string& name, const std::string& text, const std::vector<std::string>& overrides) {
  const OwnKinds own;
  const auto reading = read_study({name, text, overrides}, own.kinds());
  return to_toml(*reading.study, *reading.domain);
}

}  // namespace

void bind_study(py::module_& module) {
  module.def("study", &study, py::arg("name"), py::arg("text"), py::arg("overrides"), py::arg("out"),
             py::arg("threads"), py::arg("resume"), py::arg("replace"), py::arg("keep_going"), py::arg("on_progress"));
  module.def("verify", &verify, py::arg("folder"), py::arg("sample"), py::arg("threads"), py::arg("on_progress"));
  module.def("status", &status, py::arg("folder"));
  module.def("resolved", &resolved, py::arg("name"), py::arg("text"), py::arg("overrides"));
  module.def("strategies", [] {
    const OwnKinds own;
    py::dict rows;
    for (const auto& kind : own.strategies()) rows[py::str(std::string{kind.name})] = std::string{kind.description};
    return rows;
  });
  module.def("program", [] { return cli::program_name(); });
}

}  // namespace kith::python
