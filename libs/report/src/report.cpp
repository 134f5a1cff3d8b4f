#include "kith/report/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "first_screen.hpp"
#include "kith/analysis/analysis.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/text.hpp"
#include "outcomes.hpp"
#include "parameters.hpp"
#include "sections.hpp"
#include "sentences.hpp"
#include "session_tables.hpp"
#include "team_tables.hpp"

namespace kith {
namespace detail {
namespace {

constexpr std::size_t kMaxPoints = 6'000;  // teams listed one by one, in all

// What a column of statistics is called behind the column that they are of.
struct Statistic {
  std::string_view suffix, text;
};
constexpr std::array kMoments{Statistic{"_mean", ", mean"}, Statistic{"_sd", ", sd"}, Statistic{"_low", ", 95 % low"},
                              Statistic{"_high", ", 95 % high"}, Statistic{"_standing", ", within its row"}};
constexpr std::array kInterval{Statistic{"_low", ", 95 % low"}, Statistic{"_high", ", 95 % high"}};
constexpr std::array kForecast{Statistic{"_mean", ", mean"}, Statistic{"_low", ", 80 % low"},
                               Statistic{"_high", ", 80 % high"}};

// Stands for the outcomes that are analysed.
constexpr std::string_view kOutcomeRows = "outcomes";

// The heading of a column and of its statistics.
struct Heading {
  std::string_view column;
  std::string_view text{};  // empty: there are only statistics
  std::span<const Statistic> statistics{};
  std::string_view stem{};  // of the headings of the statistics; empty: the text
};
constexpr std::array kHeadings{
    Heading{"strategy", "Strategy"},
    Heading{"composition", "Composition"},
    Heading{"type", "Learner type"},
    Heading{"kc", "Component"},
    Heading{"teams", "Teams"},
    Heading{"team", "Team"},
    Heading{"replicate", "Replicate"},
    Heading{"completed", "Completed"},
    Heading{"people", "People still taught"},
    Heading{"answers", "Answers"},
    Heading{"period", "Period"},
    Heading{"period_of_kc", "Period of the component"},
    Heading{kOutcomeRows},
    Heading{"share_right", "Share right", kInterval},
    Heading{"worst_share_right", "Worst member's share right", kInterval},
    Heading{"regret", "Regret", kInterval},
    Heading{"items", "Items shown", kInterval, "Items"},
    Heading{"minutes", "Teaching minutes", kInterval},
    Heading{"person_minutes", "Person minutes", kInterval},
    Heading{"on_front", "On the front"},
    Heading{"front_share", "On the front, share of bootstrap samples"},
    Heading{"forecast", "Forecast", kForecast},
    Heading{"predicted", "Predicted"},
    Heading{"actual", "Actual", kInterval},
    Heading{"correlation", "Correlation"},
    Heading{"told", "Told"},
    Heading{"told_correctly", "Of these, correctly"},
    Heading{"within", "Within", kInterval},
    Heading{"area", "", kMoments, "Area (sr)"},
    Heading{"mean_area_sr", "Area (sr), mean"},
    Heading{"mean_log_area", "Log area, mean"},
    Heading{"mean_periods", "Periods, mean"},
    Heading{"mean", "Mean"},
    Heading{"share", "Share"},
    Heading{"low", "95 % low"},
    Heading{"high", "95 % high"},
    Heading{"n", "Teams"},
    Heading{"done", "Done"},
    Heading{"at_risk", "At risk"},
    Heading{"phase", "Phase"},
    Heading{"seconds", "Seconds"},
    Heading{"group", "Group"},
    Heading{"key", "Key"},
    Heading{"value", "Value"},
    Heading{"meaning", "Meaning"},
};

Json headings() {
  Json columns = Json::object();
  const auto add = [&](std::string_view column, const std::string& text, std::string_view stem, auto statistics) {
    if (!text.empty()) columns[std::string{column}] = text;
    for (const auto& statistic : statistics)
      columns[std::string{column}.append(statistic.suffix)] = std::string{stem}.append(statistic.text);
  };
  for (const auto& [column, text, statistics, stem] : kHeadings) {
    if (column != kOutcomeRows) {
      add(column, std::string{text}, stem.empty() ? text : stem, statistics);
      continue;
    }
    for (const auto* outcome : analysed_outcomes(true, false))
      add(outcome->column, capitalised(std::string{outcome->name}), outcome->stem,
          std::span<const Statistic>{kMoments});
  }
  return columns;
}

bool is_skipped(const TeamRecord& team) { return team.status == SessionStatus::kSkipped; }

Json labels_of(const RunFiles& run, const ReportDesign& design) {
  Json strategies = Json::object(), types = Json::object();
  for (const auto& series : design.series) strategies[series.code] = series.label;
  for (const auto& type : run.types()) {
    const std::string letter{type.letter};
    types[letter] = type.label.empty() ? letter : type.label;
  }
  std::map<char, std::string> names;
  for (const auto& type : run.types()) names[type.letter] = type.label;
  return {{"strategies", std::move(strategies)},
          {"types", std::move(types)},
          {"meanings", meanings(design, names)},
          {"columns", headings()}};
}

// ", at 6 settings of teacher.process_noise and teacher.particles"
std::string settings_of(const RunFiles& run) {
  if (run.spec().factors.empty()) return "";
  return ", at " + std::to_string(run.study.variants.size()) + " settings of " +
         joined(run.spec().factors, " and ", &FactorSetting::key);
}

// "300 teams of 3 simulated people were taught what a robot does, in 5 ways."
std::string summary_of(const RunFiles& run, const RunData& data) {
  const auto by_size = [](const std::string& a, const std::string& b) { return a.size() < b.size(); };
  const auto& all = run.spec().compositions;
  const auto [least, most] = std::minmax_element(all.begin(), all.end(), by_size);
  auto people = std::to_string(least->size());
  if (least->size() < most->size()) people += " to " + std::to_string(most->size());
  const auto teams = data.teams.size(), ways = run.spec().strategies.size();
  return std::to_string(teams) + (teams == 1 ? " team of " : " teams of ") + people + " simulated " +
         (most->size() == 1 ? "person" : "people") + (teams == 1 ? " was" : " were") +
         " taught how a robot decides by watching what it does, in " + std::to_string(ways) +
         (ways == 1 ? " way" : " ways") + settings_of(run) + ".";
}

Json overview_of(const RunFiles& run, const ReportDesign& design, const RunData& data, const Analysis& analysis) {
  Json strategies = Json::array(), factors = Json::array();
  for (const auto& series : design.series) strategies.push_back(series.code);
  for (const auto& factor : run.spec().factors) factors.push_back(factor.key);

  const auto completed =
      std::count_if(data.teams.begin(), data.teams.end(), [](const auto& team) { return team.completed(); });
  const auto skipped = std::count_if(data.teams.begin(), data.teams.end(), is_skipped);

  const FirstScreen screen{.design = design,
                           .data = data,
                           .findings = analysis.findings,
                           .paired = run.spec().pairing == Pairing::kReplicate,
                           .by_tests = run.spec().teaching.mastery == stop_rule_named("all-right")};

  Json overview{{"simulated", true},
                {"teams", data.teams.size()},
                {"people", design.people},
                {"completed", completed},
                {"done", screen.by_tests ? "passed all tests" : "were taught to the end"},
                {"fixed_periods", has_fixed_periods(screen)},
                {"skipped", skipped},
                {"replicates", run.spec().replicates},
                {"seed", std::to_string(run.spec().seed)},
                {"strategies", std::move(strategies)},
                {"compositions", run.spec().compositions},
                {"factors", std::move(factors)},
                {"finding", headline(screen)},
                {"summary", Json::array({summary_of(run, data)})},
                {"answers", answers(screen)},
                {"limits", limits(screen)}};
  if (auto figure = differences(screen); !figure.is_null()) overview["differences"] = std::move(figure);
  if (data.leads_with_exam) overview["leads"] = "exam";
  return overview;
}

// timings.csv, if there is one; it does not bear on results, so that a run may come without it.
std::optional<Json> timings_table(const RunFiles& run, std::vector<std::string>& notes) {
  const auto file = run.folder / "timings.csv";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    notes.emplace_back("timings.csv is missing, so the duration of the run is unknown.");
    return std::nullopt;
  }
  const std::vector<Column> columns{{"phase", ColumnType::kText, "", "", true},
                                    {"seconds", ColumnType::kReal, "", "s", true}};
  JsonTable table{{"phase", "seconds"}};
  for (const auto& row : read_csv_file(file, columns).rows) {
    table.add(Json::array({std::get<std::string>(row[0]), number(std::get<double>(row[1]))}));
  }
  return std::move(table).take();
}

// By learner type: mass of a belief in the policy's class before teaching.
// Where the policy's class is an estimate, how good it is.
void note_estimate(const Atlas& atlas, std::vector<std::string>& notes) {
  const auto left = atlas.regret_left();
  if (!left) return;
  notes.push_back(
      "The behaviour equivalence class of the policy is an estimate, because the robot's paths from the few "
      "starts do not meet every state: people who satisfy it keep " +
      shortest(std::round(1000.0 * *left) / 10.0) + " % of the regret that people have before any lesson.");
}

std::vector<double> mass_before(const RunFiles& run, const Atlas& atlas) {
  std::vector<double> masses;
  for (const auto& type : run.types()) {
    std::optional<PriorCover> cover;
    const LearnerStart start{.cover = [&](std::size_t num_points) -> const PriorCover& {
      return cover.emplace(prior_of(type, atlas.prior_cone()), num_points, std::span<const std::size_t>{},
                           known_to(type, atlas.prior_cone()));
    }};
    const RandomStream random{run.spec().seed};
    const auto person = type.model->make(type.parameters, type.model->draw(type.parameters, random), start, random);
    masses.push_back(person->mass_in(atlas.policy_bec_half_spaces()));
  }
  return masses;
}

Json tables_of(const RunFiles& run, const ReportDesign& design, const RunData& data, const Atlas& atlas,
               std::size_t points, std::vector<std::string>& notes) {
  Json tables{{"cells", cells_table(design, data)},
              {"teams", teams_table(run, design, data, points)},
              {"completion", completion_table(design, data)}};
  if (data.has_periods) {
    tables["area"] = area_table(design, data);
    tables["knowledge_by_period"] = knowledge_by_period_table(run, design, data, mass_before(run, atlas));
    tables["correct_by_period"] = correct_by_period_table(run, design, data);
    tables["periods_by_component"] = periods_by_component_table(design, data);
  }
  if (data.has_exam && data.has_costs) tables["efficiency"] = efficiency_table(run, design, data);
  if (!data.exam_paths.empty()) tables["exam_by_period"] = exam_by_period_table(design, data);
  if (data.has_forecasts) {
    tables["forecasts"] = forecasts_table(design, data);
    if (data.has_periods) tables["forecast_calibration"] = forecast_calibration_table(data);
  }
  if (data.has_estimates && data.has_periods) {
    if (auto table = mastery_calibration_table(data)) tables["mastery_calibration"] = *std::move(table);
    if (!data.ability_estimates.empty()) tables["ability_estimates"] = ability_estimates_table(design, data);
  }
  if (auto timings = timings_table(run, notes)) tables["timings"] = *std::move(timings);
  tables["parameters"] = parameters_table(run);
  return tables;
}

void note_impoverished_beliefs(const RunData& data, std::vector<std::string>& notes) {
  const auto recorded =
      std::count_if(data.teams.begin(), data.teams.end(), [](const auto& t) { return t.fewest_particles.has_value(); });
  const auto few = std::count_if(data.teams.begin(), data.teams.end(), [](const auto& t) {
    return t.fewest_particles && *t.fewest_particles < kFewParticles;
  });
  if (few == 0) return;
  const auto percent = std::max<std::ptrdiff_t>(1, (200 * few + recorded) / (2 * recorded));
  notes.push_back("In " + std::to_string(few) + " of " + std::to_string(recorded) + " teams (" +
                  std::to_string(percent) +
                  " %), the belief of a member had fewer than 10 effective particles for something that the member was "
                  "shown, so what it holds depends on which points happened to fit. Run the study with more particles "
                  "(learner.X.particles = 5000) to see whether results change.");
}

// What a reader should know about the data.
void note_data(const RunFiles& run, const ReportDesign& design, const RunData& data, std::size_t points,
               std::vector<std::string>& notes) {
  for (const auto& what : run.published.missing())
    notes.push_back("The run is incomplete, and all results describe only the teams that are present: " + what + ".");
  for (const auto& before : run.manifest.value("grown", std::vector<std::string>{}))
    notes.push_back("The run had " + before +
                    ", and teams were added later. If those were analysed, the tests below are "
                    "not tests of one planned sample.");
  note_impoverished_beliefs(data, notes);
  const auto skipped = std::count_if(data.teams.begin(), data.teams.end(), is_skipped);
  if (skipped > 0) {
    notes.push_back(
        std::to_string(skipped) + " of " + std::to_string(data.teams.size()) +
        " teams did not learn all of a knowledge component, because nothing that could be shown conveys the "
        "rest. They do not count as completed: the completion curves treat them as censored.");
  }
  const auto censored = std::count_if(data.teams.begin(), data.teams.end(),
                                      [](const auto& t) { return !t.completed() && !is_skipped(t); });
  if (censored > 0) {
    notes.push_back(std::to_string(censored) + " of " + std::to_string(data.teams.size()) +
                    " teams reached the limit of " + std::to_string(run.spec().teaching.max_periods) +
                    " periods before they had learned everything. The completion curves treat them as censored; means "
                    "include them with the periods they had.");
  }
  if (!data.has_periods) {
    notes.emplace_back(
        "Only teams were recorded (record.level = \"team\"), so there are no figures over periods. To get them, run "
        "the "
        "study with record.level = \"period\".");
  }
  const auto most =
      std::max_element(design.cells.begin(), design.cells.end(), [](auto& a, auto& b) { return a.teams < b.teams; });
  if (most->teams > points) {
    notes.push_back("Individual teams are shown for the first " + std::to_string(points) +
                    " replicates of every cell; means, intervals and tests use all teams.");
  }
  if (!run.spec().factors.empty()) {
    notes.emplace_back(
        "The study varies parameters: every strategy appears once per setting. The summary is over all settings.");
  }
}

// A design in which nothing can be compared has no findings, and that is no error.
Analysis analyse(const RunFiles& run, std::vector<std::string>& notes) try {
  auto analysis = analyze_run(run.folder, {});
  // The notes of the analysis are about the size of the design and missing teams, which the report says itself.
  if (auto text = not_analysed_text(analysis); !text.empty()) notes.push_back(std::move(text));
  return analysis;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::kInfeasible) throw;
  if (error.diagnostics().empty()) throw;
  notes.push_back("Nothing was tested: " + error.diagnostics().front().message + ".");
  return {};
}

Json reproduction_of(const RunFiles& run) {
  auto version = "kith " + manifest_text(run, "version");
  const auto git = manifest_text(run, "git");
  if (!git.empty() && git != "unknown") version += " (git " + git + ")";
  Json hashes = Json::object();
  for (const auto* folder : {"inputs", "tables"}) {
    const auto found = run.manifest.find(folder);
    if (found == run.manifest.end() || !found->is_object()) continue;
    for (const auto& [name, hash] : found->items()) hashes[std::string{folder} + "/" + name] = hash;
  }
  return {{"command", "kith study study.toml -o DIR"},
          {"version", version},
          {"study_toml", run.study_toml},
          {"domain_toml", run.domain_toml},
          {"hashes", std::move(hashes)}};
}

// Answers in an event store are no tables yet.
void refuse_live_sessions(const std::filesystem::path& folder) {
  std::error_code failure;
  if (!std::filesystem::exists(folder / "session.sqlite", failure)) return;
  refuse_run(ErrorKind::kInvalidInput, "E0602", folder,
             "the folder holds live sessions, from which tables are exported",
             "run 'kith session export " + folder.string() + " -o TABLES', then 'kith report TABLES'");
}

Json document_of(const std::filesystem::path& folder, const ReportOptions& options) {
  const auto step = [&](std::string_view text) {
    if (options.on_step) options.on_step(text);
  };

  const auto run = open_run(folder, options.kinds);
  const auto design = design_of(run);

  step("planning the robot's paths");
  const Atlas atlas{run.domain};
  auto data = read_run_data(run, design, atlas.knowledge_components().size(), step);
  auto notes = std::move(data.notes);
  const auto points = std::min(options.points_per_cell, std::max<std::size_t>(1, kMaxPoints / design.cells.size()));
  note_data(run, design, data, points, notes);
  note_estimate(atlas, notes);

  step("computing tables");
  auto tables = tables_of(run, design, data, atlas, points, notes);
  step("analysing");
  const auto analysis = analyse(run, notes);
  step("rerunning three teams");
  auto beliefs = belief_spheres(run, design, data, atlas, options.sphere_particles, notes);
  step("reading the lessons of single teams");
  auto lessons = team_lessons(run, design, data, atlas, notes);

  const auto& spec = run.spec();
  Json document{{"schema", "kith.report/1"},
                {"title", spec.title.empty() ? spec.id : spec.title},
                {"study", spec.id},
                {"domain", run.domain.id()},
                {"version", manifest_text(run, "version")},
                {"created", manifest_text(run, "stopped")},
                {"labels", labels_of(run, design)},
                {"overview", overview_of(run, design, data, analysis)},
                {"outcomes", outcomes_json(data.has_exam)},
                {"notes", notes},
                {"tables", std::move(tables)},
                {"findings", Json::parse(findings_json(analysis))},
                {"methods", methods_of(run, design, data, analysis)},
                {"reproduce", reproduction_of(run)}};

  if (auto found = matrices(run, data); !found.empty()) document["matrices"] = std::move(found);
  if (beliefs) document["beliefs"] = *std::move(beliefs);
  if (lessons) document["lessons"] = *std::move(lessons);
  return document;
}

}  // namespace
}  // namespace detail

std::string build_report(const std::filesystem::path& run_folder, const ReportOptions& options) {
  detail::refuse_live_sessions(run_folder);
  const auto document = detail::is_session_export(run_folder) ? detail::session_report(run_folder, options)
                                                              : detail::document_of(run_folder, options);
  return document.dump(-1, ' ', true, detail::Json::error_handler_t::replace);
}

}  // namespace kith
