// What is made of results: analyses, reports, audits, fits, power. Documents are JSON, the program's own.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "assignment.hpp"
#include "build_facts.hpp"
#include "embedded.hpp"
#include "errors.hpp"
#include "fit_output.hpp"
#include "kith/analysis/analysis.hpp"
#include "kith/analysis/study_power.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/parallel.hpp"
#include "kith/files/published_run.hpp"
#include "kith/fit/answer_regions.hpp"
#include "kith/fit/import_logs.hpp"
#include "kith/fit/recovery.hpp"
#include "kith/report/report.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/study_run.hpp"
#include "kith/store/event_file.hpp"
#include "kith/store/session_audit.hpp"
#include "kith/study/audit_people.hpp"
#include "own_kinds.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

Correction correction_of(const std::string& word) {
  if (word == "bonferroni") return Correction::kBonferroni;
  if (word == "holm") return Correction::kHolm;
  if (word == "fdr") return Correction::kFdr;
  if (word == "none") return Correction::kNone;
  throw py::value_error{"correction must be 'bonferroni', 'holm', 'fdr' or 'none', not '" + word + "'"};
}

std::string analyze(const std::string& folder, double alpha, const std::string& correction,
                    const std::vector<std::string>& contrasts, const std::vector<std::string>& by) {
  if (!(alpha >= 1e-6) || alpha >= 0.5) throw py::value_error{"alpha must be above 0 and below 0.5"};
  AnalysisOptions options;
  options.alpha = alpha;
  options.correction = correction_of(correction);
  options.by = by;
  for (const auto& text : contrasts) options.contrasts.push_back(parse_contrast(text));
  return wait_for([folder, options] {
    const auto analysis = analyze_run(folder, options);
    Json document{{"schema", "kith.analyze/5"},
                  {"subject", analysis.subject},
                  {"alpha", options.alpha},
                  {"notes", analysis.notes},
                  {"findings", Json::parse(findings_json(analysis))},
                  {"not_analysed", analysis.not_analysed}};
    return document.dump();
  });
}

// The page of a report, or its document.
std::string report(const std::string& folder, bool as_page) {
  const OwnKinds own;
  Watch watch;
  return wait_for(watch, py::none(), [&] {
    ReportOptions options;
    options.kinds = own.kinds();
    options.on_step = [&](std::string_view) {
      if (watch.stop) throw Stopped{};
    };
    auto document = build_report(folder, options);
    if (!as_page) return document;
    if (kith::detail::kReportPage.empty()) {
      throw Error{ErrorKind::kInfeasible, "this kith was built without pages for browsers",
                  Advice{"install Node.js and npm and build it again"}};
    }
    return render_report(document, kith::detail::kReportPage);
  });
}

std::string fit(const std::vector<std::string>& logs, const std::string& answers, std::size_t types, std::size_t folds,
                std::size_t replicates, std::uint64_t seed, std::size_t threads, const py::object& on_progress) {
  if (answers != "path" && answers != "verdict") throw py::value_error{"answers must be 'path' or 'verdict'"};
  if (types > 6 || folds > 1000 || replicates < 1 || replicates > 1000)
    throw py::value_error{"types must be at most 6, folds at most 1000 and replicates 1 to 1000"};
  if (logs.empty()) throw py::value_error{"there are no logs"};
  Watch watch;
  return wait_for(watch, on_progress, [&] {
    const auto detail = answers == "path" ? AnswerDetail::kPath : AnswerDetail::kVerdict;
    auto imported = import_logs({logs.begin(), logs.end()}, detail);
    const ParallelOptions parallel{.threads = threads, .on_progress = [&](std::size_t done, std::size_t total) {
                                     watch.tell(done, total);
                                     return !watch.stop;
                                   }};
    if (!find_answer_regions(imported, {.detail = detail, .seed = seed, .parallel = parallel})) throw Stopped{};
    FitOptions options;
    options.replicates = replicates;
    options.seed = seed;
    options.num_types = types;
    options.folds = folds;
    options.parallel = parallel;
    const auto found = fit_learners(imported, options);
    if (!found.complete) throw Stopped{};
    return cli::to_json(found, recovery(imported, found), imported.notes).dump();
  });
}

std::string audit(const std::string& folder, std::size_t team, const std::string& room, double forgetting,
                  std::size_t threads, const py::object& on_progress) {
  if (!(forgetting >= 0.0) || forgetting > 1e6) throw py::value_error{"forgetting must be 0 or more, in radians"};
  const bool is_live = std::filesystem::exists(std::filesystem::path{folder} / kEventFile);
  if (is_live && team != 0) throw py::value_error{"team is of a run; a live session has rooms"};
  if (!is_live && !room.empty()) throw py::value_error{"room is of a live session; a run has teams"};
  const OwnKinds own;
  Watch watch;
  const auto tell = [&](std::size_t done, std::size_t total) {
    watch.tell(done, total);
    return !watch.stop;
  };
  return wait_for(watch, on_progress, [&] {
    if (is_live) {
      const auto on_room = [&](std::size_t done, std::size_t total) {
        if (!tell(done, total)) throw Stopped{};
      };
      const auto live = audit_session(
          EventFile::read(folder), {.source = folder, .room = room, .forgetting = forgetting, .on_progress = on_room});
      return audit_json(*live.study->atlas, live.report, cli::program_name()).dump();
    }
    auto reading = read_run_folder(folder, own.kinds());
    if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
    const auto& study = *reading.study;
    require_teaching_memory(*reading.domain);
    const Atlas atlas{*reading.domain};
    std::vector<TeamRecord> records;
    const auto journal = Journal::read(std::filesystem::path{folder} / kJournalFile);
    teams_of(study, journal)([&](const TeamRecord& record) {
      if (team == 0 || record.address.team == team) records.push_back(record);
    });
    if (records.empty())
      throw Error{ErrorKind::kInfeasible, team == 0 ? "no team of " + folder + " has been taught yet"
                                                    : "team " + std::to_string(team) + " has not been taught"};
    std::vector<std::vector<AuditedPerson>> people(records.size());
    const bool all = for_each_index(records.size(), {.threads = threads, .on_progress = tell}, [&](std::size_t i) {
      TeachingCache cache{atlas};
      people[i] = audit_team(cache, study, records[i], forgetting);
    });
    if (!all) throw Stopped{};
    AuditReport result{
        .source = folder, .people = {}, .options = audit_options(study.variants.front().teaching, forgetting)};
    for (auto& person : people) result.people.insert(result.people.end(), person.begin(), person.end());
    return audit_json(atlas, result, cli::program_name()).dump();
  });
}

Json curve_json(const PowerCurve& curve) {
  const auto known = [](const auto& value) { return value ? Json(*value) : Json{}; };
  Json points = Json::array();
  for (const auto& point : curve.points) {
    points.push_back({{"teams", point.teams},
                      {"power", point.power},
                      {"low", point.low},
                      {"high", point.high},
                      {"analytic_power", known(point.analytic_power)}});
  }
  const auto& needed = curve.needed;
  return {{"effect", to_string(curve.effect)},
          {"size", curve.size},
          {"teams_needed",
           {{"estimate", known(needed.estimate)},
            {"low", known(needed.low)},
            {"high", known(needed.high)},
            {"analytic", known(needed.analytic)}}},
          {"points", points}};
}

std::string power(const std::string& name, const std::string& text, const std::vector<std::string>& overrides,
                  const std::vector<std::string>& effects, std::vector<std::size_t> teams, double target, double alpha,
                  std::size_t pool, std::size_t draws, bool paired, std::size_t threads,
                  const py::object& on_progress) {
  if (!(target > 0.0) || target >= 1.0 || !(alpha > 0.0) || alpha >= 1.0)
    throw py::value_error{"target and alpha must be above 0 and below 1"};
  if (draws < 10 || draws > 1'000'000 || pool > 1'000'000)
    throw py::value_error{"draws must be 10 to a million, and the pool at most a million"};
  std::sort(teams.begin(), teams.end());
  if (teams.empty() || teams.front() < 2) throw py::value_error{"teams must be sizes of 2 or more"};
  const OwnKinds own;
  const auto reading = read_study({name, text, overrides}, own.kinds());
  const auto& spec = reading.study->variants.front();
  if (reading.study->variants.size() > 1) throw py::value_error{"the study varies parameters; remove design.vary"};
  PowerOptions options{
      .teams = teams, .alpha = alpha, .target = target, .draws = draws, .paired = paired, .seed = spec.seed};
  std::vector<Effect> list;
  std::vector<const StudyOutcome*> quantities;
  for (const auto& one : effects) {
    auto effect = parse_effect(one, spec);
    if (!effect.effect)
      throw Error{{Diagnostic{.id = "E0809", .message = effect.problem, .file = "effects", .hint = effect.hint}}};
    list.push_back(*effect.effect);
    quantities.push_back(effect.effect->outcome);
  }
  if (list.empty()) throw py::value_error{"effects must name at least one, such as 'periods: strategy'"};
  auto pool_spec = recording(spec, quantities);
  pool_spec.replicates = std::max(pool, 2 * teams.back());
  const Study pool_study{{pool_spec}};
  Watch watch;
  return wait_for(watch, on_progress, [&] {
    require_pool_memory(pool_study, threads, num_teams(pool_study));
    const Atlas atlas{*reading.domain};
    const auto pools =
        simulate_pools(atlas, pool_study, {.threads = threads, .on_progress = [&](std::size_t done, std::size_t total) {
                                             watch.tell(done, total);
                                             return !watch.stop;
                                           }});
    if (!pools) throw Stopped{};
    Json curves = Json::array();
    for (const auto& curve : power_curves(pools->front(), list, options)) curves.push_back(curve_json(curve));
    return Json{
        {"study", name}, {"pool", pool_spec.replicates}, {"alpha", alpha}, {"target", target}, {"effects", curves}}
        .dump();
  });
}

}  // namespace

void bind_results(py::module_& module) {
  module.def("analyze", &analyze, py::arg("folder"), py::arg("alpha"), py::arg("correction"), py::arg("contrasts"),
             py::arg("by"));
  module.def("report", &report, py::arg("folder"), py::arg("as_page"));
  module.def("fit", &fit, py::arg("logs"), py::arg("answers"), py::arg("types"), py::arg("folds"),
             py::arg("replicates"), py::arg("seed"), py::arg("threads"), py::arg("on_progress"));
  module.def("audit", &audit, py::arg("folder"), py::arg("team"), py::arg("room"), py::arg("forgetting"),
             py::arg("threads"), py::arg("on_progress"));
  module.def("power", &power, py::arg("name"), py::arg("text"), py::arg("overrides"), py::arg("effects"),
             py::arg("teams"), py::arg("target"), py::arg("alpha"), py::arg("pool"), py::arg("draws"),
             py::arg("paired"), py::arg("threads"), py::arg("on_progress"));
}

}  // namespace kith::python
