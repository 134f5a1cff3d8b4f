#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "build_facts.hpp"
#include "command.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "kith/analysis/study_power.hpp"
#include "kith/core/error.hpp"
#include "kith/core/stream.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/runs/run_folder.hpp"
#include "planning_input.hpp"
#include "power_view.hpp"
#include "preregistration.hpp"
#include "progress.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct PowerCommandOptions {
  std::string study;
  std::vector<std::string> effects;
  double target = 0.8;
  double alpha = 0.05;
  std::vector<std::uint32_t> teams;  ///< Per cell; empty: a range of sizes, or those of the study.
  std::optional<std::size_t> pool;   ///< Teams per cell to draw studies from.
  std::size_t draws = 1000;
  bool paired = false;
  std::string findings;     ///< A targets file: repeat the study and look for its findings.
  std::string preregister;  ///< File for a preregistration of the study; empty: none.
  std::string results;      ///< Where a run of the study would be; empty: results/ID.
  std::size_t studies = 200;
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never the results.
  std::vector<std::string> set;
  ProgressMode progress = ProgressMode::kAuto;
};

constexpr std::size_t kDefaultPool = 1'000;

// --- input ------------------------------------------------------------------------

Effect effect_of(const std::string& text, const StudySpec& spec) {
  auto reading = parse_effect(text, spec);
  if (!reading.effect) {
    throw Error{{Diagnostic{.id = "E0809", .message = reading.problem, .file = "--effect", .hint = reading.hint}}};
  }
  return *reading.effect;
}

// Which planned contrasts kith power cannot plan for; empty: none.
std::string without_power(const StudySpec& spec) {
  std::vector<std::string> names;
  for (const auto& contrast : spec.contrasts) {
    if (effects_of(contrast, spec).empty()) names.push_back("'" + contrast.name + "'");
  }
  if (names.empty()) return "";
  return fmt::format(
      "no power is estimated for the planned contrasts {}, which neither compare two means of strategies nor two "
      "compositions",
      fmt::join(names, ", "));
}

// What the study plans to compare; else what the default analyses test, as far as the design allows. Beyond three
// features the outcomes of the exam come first and knowledge, which says little there, comes last.
std::vector<Effect> default_effects(const StudySpec& spec, std::size_t num_features) {
  const std::vector<const char*> periods{"periods: strategy", "periods: composition",
                                         "periods: strategy x composition"};
  const std::vector<const char*> knowledge{"knowledge: strategy", "knowledge: composition",
                                           "knowledge: strategy x composition"};
  const std::vector<const char*> others{"area_sr: strategy", "periods: group - baseline"};
  const std::vector<const char*> exam{"exam_share_right: strategy", "exam_regret: strategy",
                                      "exam_worst_share_right: strategy", "exam_regret: group - baseline"};
  const bool has_exam = spec.exam != ExamLevel::kNone;
  if (!spec.contrasts.empty()) {
    std::vector<Effect> planned;
    for (const auto& contrast : spec.contrasts) {
      const auto all = effects_of(contrast, spec);
      planned.insert(planned.end(), all.begin(), all.end());
    }
    if (!planned.empty()) return planned;
    refuse(without_power(spec) + "; name what to plan for with --effect");
  }
  std::vector<const char*> texts;
  const auto add = [&](const std::vector<const char*>& more) { texts.insert(texts.end(), more.begin(), more.end()); };
  if (exam_leads(has_exam, num_features)) {
    add({"exam_regret: strategy", "exam_regret: composition", "exam_regret: strategy x composition",
         "exam_share_right: strategy", "exam_worst_share_right: strategy", "exam_regret: group - baseline"});
    add(periods);
    add(others);
    add(knowledge);
  } else {
    add(periods);
    add(knowledge);
    add(others);
    add({"knowledge: group - baseline"});
    if (has_exam) add(exam);
  }
  std::vector<Effect> effects;
  for (const auto* text : texts) {
    if (auto reading = parse_effect(text, spec); reading.effect) effects.push_back(*reading.effect);
  }
  if (!effects.empty()) return effects;
  refuse("this study has nothing to compare: it has one cell, or only the baseline");
}

// Those of --teams, and for a preregistration that of the study, ascending.
std::vector<std::size_t> sizes_of(const PowerCommandOptions& options, std::size_t replicates) {
  std::set<std::size_t> sizes{options.teams.begin(), options.teams.end()};
  const auto usual = PowerOptions{}.teams;
  if (sizes.empty()) sizes = {usual.begin(), usual.end()};
  if (!options.preregister.empty()) {
    if (replicates < 2)
      refuse("--preregister: the study has one team per cell, so nothing can be tested; set replicates");
    sizes.insert(replicates);
  }
  return {sizes.begin(), sizes.end()};
}

void check_pool(const PowerCommandOptions& options, std::size_t pool, const std::vector<std::size_t>& teams) {
  const auto least = 2 * teams.back();
  if (pool >= least) return;
  const auto which = options.teams.empty() ? fmt::format("--teams is {} by default", fmt::join(teams, ","))
                                           : fmt::format("the largest of --teams is {}", teams.back());
  refuse(
      fmt::format("--pool {} is too small: studies are drawn from the pool, so it needs at least twice the "
                  "teams of the largest study ({}); use --pool {} or smaller --teams",
                  pool, which, least));
}

// Refuses effects that no study can have, and warns of those that no teacher is likely to have.
std::vector<EffectCells> checked_cells(const TeamPool& pool, const std::vector<Effect>& effects, Console& console) {
  constexpr double kHuge = 2.0;
  std::vector<EffectCells> all;
  std::vector<Diagnostic> impossible;
  for (const auto& effect : effects) {
    auto& cells = all.emplace_back(effect_cells(pool, effect));
    if (!cells.impossible.empty()) {
      impossible.push_back({.id = "E0816",
                            .message = fmt::format("'{}' is impossible: {}", to_string(effect), cells.impossible),
                            .file = "--effect",
                            .hint = "impose a smaller effect, or none, to plan for the one that was simulated"});
    } else if (effect.imposed && cells.largest_difference > kHuge) {
      console.warning(
          fmt::format("'{}' makes means differ by {}: hardly any teaching does that", to_string(effect),
                      std::isinf(cells.largest_difference)
                          ? std::string{"something where simulated teams of a cell do not differ at all"}
                          : fmt::format("{:.1f} standard deviations within cells", cells.largest_difference)));
    }
  }
  if (!impossible.empty()) throw Error{impossible};
  return all;
}

int run_curves(const PowerCommandOptions& options, const StudyReading& reading, const Atlas& atlas, Progress& progress,
               Console& console) {
  const auto& spec = reading.study->variants.front();
  std::vector<Effect> effects;
  for (const auto& text : options.effects) effects.push_back(effect_of(text, spec));
  const auto missing = effects.empty() ? without_power(spec) : "";
  if (effects.empty()) effects = default_effects(spec, atlas.domain().num_features());
  if (!missing.empty()) console.warning(missing + "; see --effect");
  PowerOptions power;
  power.teams = sizes_of(options, spec.replicates);
  power.alpha = options.alpha;
  power.target = options.target;
  power.draws = options.draws;
  // A preregistration plans the tests of kith analyze, which knows which strategies teach the same people.
  const bool same_people = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
  power.paired = options.paired || (!options.preregister.empty() && same_people);
  power.seed = options.seed.value_or(spec.seed);
  std::vector<const StudyOutcome*> quantities;
  for (const auto& effect : effects) quantities.push_back(effect.outcome);
  auto pool_spec = recording(spec, quantities);
  pool_spec.replicates = options.pool.value_or(std::max(kDefaultPool, 2 * power.teams.back()));
  // Other teams than those of the study, whatever the seed: a plan must not have seen them.
  pool_spec.seed = RandomStream{power.seed}.split("teams of a plan").address();
  check_pool(options, pool_spec.replicates, power.teams);
  const Study pool_study{{pool_spec}};
  require_pool_memory(pool_study, options.threads, num_teams(pool_study));  // before the time is measured
  if (!console.quiet()) console.info(work_text(try_cells(atlas, pool_spec, options.threads), num_teams(pool_study)));
  const auto pools =
      simulate_pools(atlas, pool_study, {.threads = options.threads, .on_progress = progress.until_stopped()});
  progress.finish();
  if (!pools) return interrupted("interrupted; there is no result", console);
  const auto& pool = pools->front();
  const auto cells = checked_cells(pool, effects, console);
  const auto curves = power_curves(pool, effects, power);
  if (!options.preregister.empty()) {
    const PlannedStudy planned{
        spec,          atlas.domain(), freeze(reading),
        options.study, utc_now(),      options.results.empty() ? "results/" + spec.id : options.results,
        missing};
    write_file_atomically(options.preregister, preregistration_text(planned, curves, cells, power));
  }
  if (console.json()) {
    Json list = Json::array();
    for (std::size_t i = 0; i < curves.size(); ++i) list.push_back(curve_json(curves[i], cells[i]));
    console.print_json(Json{{"schema", "kith.power/1"},
                            {"study", options.study},
                            {"seed", power.seed},
                            {"pool", pool_spec.replicates},
                            {"draws", power.draws},
                            {"alpha", power.alpha},
                            {"target", power.target},
                            {"paired", power.paired},
                            {"assumptions", assumptions(spec, power.paired)},
                            {"effects", list}});
    return 0;
  }
  std::string text;
  for (const auto& curve : curves) text += curve_text(curve, power, console);
  for (const auto& outcome : outcomes()) {
    if (std::find(quantities.begin(), quantities.end(), &outcome) != quantities.end())
      text += cells_text(outcome, curves, cells, console);
  }
  console.print(
      text +
      console.dim(fmt::format("significance level {:g}; {} studies of each size, drawn from {} teams per "
                              "cell,\nnone of which is a team of the study; intervals include the error from both",
                              power.alpha, power.draws, pool_spec.replicates)) +
      "\n" + assumptions_text(spec, power.paired, console));
  return 0;
}

int run_replication(const PowerCommandOptions& options, const Study& study, const Atlas& atlas, Progress& progress,
                    Console& console) {
  auto spec = study.variants.front();
  if (options.teams.size() > 1) refuse("--findings repeats a study of one size, so --teams takes one number");
  if (!options.teams.empty()) spec.replicates = options.teams.front();
  const auto findings = findings_of(options.findings, spec);
  if (findings.empty())
    throw Error{{Diagnostic{.id = "E0813", .message = "there is no [[finding]]", .file = options.findings}}};
  ReplicationOptions replication;
  replication.studies = options.studies;
  replication.seed = options.seed.value_or(spec.seed);
  replication.threads = options.threads;
  replication.paired = options.paired;
  replication.on_progress = progress.until_stopped();
  if (!console.quiet()) {
    const auto teams = spec.replicates * spec.strategies.size() * spec.compositions.size() * replication.studies;
    console.info(work_text(try_cells(atlas, spec, options.threads), teams));
  }
  const auto result = replicate_findings(atlas, spec, findings, replication);
  progress.finish();
  if (!result) return interrupted("interrupted; there is no result", console);
  if (console.json()) {
    auto document = Json{{"schema", "kith.power/1"},
                         {"study", options.study},
                         {"seed", replication.seed},
                         {"teams_per_cell", spec.replicates},
                         {"paired", options.paired}};
    document["replication"] = replication_json(findings, *result);
    console.print_json(document);
    return 0;
  }
  console.print(replication_text(findings, *result, spec, console) +
                replication_assumptions(spec, options.paired, console));
  return 0;
}

void declare(OptionList& list, PowerCommandOptions& options) {
  constexpr NumberRange kShare{1e-6, 1.0 - 1e-6};
  list.study(options.study).required();
  auto effects = list.texts(
      "--effect", options.effects, "EFFECT",
      "Effect, such as 'periods: strategy eta2 = 0.02' (may be repeated; default: the planned contrasts, else all)");
  auto target = list.number("--target", options.target, "P", kShare, "Desired power");
  auto alpha = list.number("--alpha", options.alpha, "P", kShare, "Significance level");
  list.integer("--teams", options.teams, {2, 100'000},
               "Teams per cell, separated by commas (default: 5,10,15,20,30,50,100)");
  auto pool =
      list.integer("--pool", options.pool, {4, 1'000'000},
                   "Teams per cell to draw studies from, at least twice the largest of --teams (default: 1000)");
  auto draws = list.integer("--draws", options.draws, {10, 1'000'000}, "Studies drawn for each size");
  list.flag("--paired", options.paired, "Every strategy teaches the same people; compare strategies within people");
  auto findings = list.text("--findings", options.findings, "FILE",
                            "Repeat the study and count how often the findings in this targets file are reproduced");
  for (const auto& other : {effects, target, alpha, pool, draws}) findings.excludes(other);
  list.text("--preregister", options.preregister, "FILE",
            "Write a preregistration of the study to this file: hypotheses, design, sample size, stopping, analyses")
      .excludes(findings);
  list.text("--results", options.results, "DIR",
            "For --preregister: the run folder in which to look for a finished run (default: results/ID)");
  list.integer("--studies", options.studies, {2, 100'000}, "Repetitions for --findings");
  list.threads(options.threads, "; never changes a result");
  list.integer("--seed", options.seed, {}, "Random seed (default: that of the study); never the study's own teams");
  list.set(options.set);
  list.progress(options.progress);
  list.json();
}

int run(const PowerCommandOptions& options, Console& console) {
  const auto reading = study_of(options.study, options.set);
  if (!console.quiet()) show_warnings(reading, console);
  check_single_variant(options.study, *reading.study);
  watch_signals();
  const Atlas atlas = planned(*reading.domain, console);
  Progress progress{options.progress, console};
  if (!options.findings.empty()) return run_replication(options, *reading.study, atlas, progress, console);
  return run_curves(options, reading, atlas, progress, console);
}

}  // namespace

void add_power(Commands& commands) {
  commands.add<PowerCommandOptions>("power", "Estimate how many teams a study needs to show an effect",
                                    {"kith power paper --effect 'knowledge: joint - common = 0.05' --target 0.9",
                                     "kith power studies/paper.toml --findings studies/paper-targets.toml"},
                                    declare, run);
}

}  // namespace kith::cli
