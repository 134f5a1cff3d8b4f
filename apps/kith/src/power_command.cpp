#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "build_facts.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/planning/power.hpp"
#include "kith/present/json.hpp"
#include "kith/runs/run_folder.hpp"
#include "planning_input.hpp"
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

// What the default analyses test, as far as the design allows. Beyond three features the outcomes of the exam come
// first and knowledge, which says little there, comes last.
std::vector<Effect> default_effects(const StudySpec& spec, std::size_t num_features) {
  const std::vector<const char*> periods{"periods: strategy", "periods: composition",
                                         "periods: strategy x composition"};
  const std::vector<const char*> knowledge{"knowledge: strategy", "knowledge: composition",
                                           "knowledge: strategy x composition"};
  const std::vector<const char*> others{"area_sr: strategy", "periods: group - baseline"};
  const std::vector<const char*> exam{"exam_share_right: strategy", "exam_regret: strategy",
                                      "exam_worst_share_right: strategy", "exam_regret: group - baseline"};
  const bool has_exam = spec.exam != ExamLevel::kNone;
  std::vector<const char*> texts;
  const auto add = [&](const std::vector<const char*>& more) { texts.insert(texts.end(), more.begin(), more.end()); };
  if (has_exam && num_features > 3) {
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

// What the analyses take for granted, in sentences.
std::vector<std::string> assumptions(const StudySpec& spec, bool paired) {
  std::vector<std::string> sentences{
      "Each team contributes one value (knowledge is the mean over its members), so members are not counted as "
      "independent."};
  if (paired) {
    sentences.emplace_back(
        "Every strategy teaches the same people (--paired), so strategies are compared within people: analysis of "
        "variance with the Greenhouse-Geisser correction, and paired t tests. \"By F\" does not apply.");
  } else {
    sentences.emplace_back("Every cell teaches different people, so teams are independent.");
    const bool same = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
    if (same) {
      sentences.emplace_back(
          "The study file has pairing = \"replicate\": to analyse strategies that teach the same people, add "
          "--paired.");
    }
  }
  return sentences;
}

std::string assumptions_text(const StudySpec& spec, bool paired, const Console& console) {
  std::string text = "Assumptions:\n";
  for (const auto& sentence : assumptions(spec, paired)) text += "  " + sentence + "\n";
  return console.dim(text);
}

// --- text -------------------------------------------------------------------------

std::string size_text(const Effect& effect, double size) {
  const auto* const how = effect.imposed ? "imposed" : "as simulated";
  if (effect.kind == Effect::Kind::kContrast) return fmt::format("difference {:.3g} {}", size, how);
  return fmt::format("partial eta squared {:.2g} {}", size, how);
}

std::string needed_text(const PowerCurve& curve, const PowerOptions& options) {
  const auto& needed = curve.needed;
  const auto largest = options.teams.back();
  std::string text;
  if (!needed.estimate) {
    text = fmt::format("power {:g} needs more than {} teams per cell", options.target, largest);
    if (needed.low) text += fmt::format(" (at least {:.0f})", std::ceil(*needed.low));
  } else {
    const bool smallest = *needed.estimate <= static_cast<double>(options.teams.front());
    text = fmt::format("power {:g} {} {:.0f} teams per cell", options.target,
                       smallest ? "needs at most" : "needs at least", std::ceil(*needed.estimate));
    if (!smallest || !needed.high || *needed.high > *needed.estimate) {
      text += fmt::format(
          " ({:.0f} .. {})", std::ceil(*needed.low),
          needed.high ? fmt::format("{:.0f}", std::ceil(*needed.high)) : fmt::format("more than {}", largest));
    }
  }
  if (needed.analytic) text += fmt::format("; non-central F: {}", *needed.analytic);
  return text;
}

// "0 to 1"
std::string range_text(const EffectCells& cells) {
  return std::isinf(cells.high) ? fmt::format("{:g} or more", cells.low)
                                : fmt::format("{:g} to {:g}", cells.low, cells.high);
}

// What the effects of one quantity are effects on: means and standard deviations of the cells, and what imposed effects
// make of the means.
std::string cells_text(Quantity quantity, std::span<const PowerCurve> curves, std::span<const EffectCells> cells,
                       const Console& console) {
  std::vector<std::string> head{"strategy", "composition", "mean", "sd"};
  std::vector<std::vector<std::string>> rows;
  std::string notes, range;
  std::size_t imposed = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& effect = curves[i].effect;
    if (effect.quantity != quantity) continue;
    range = range_text(cells[i]);
    if (effect.imposed) {
      ++imposed;
      head.push_back(fmt::format("imposed {}", imposed));
      notes += fmt::format("imposed {}: {}\n", imposed, to_string(effect));
    }
    for (const auto& cell : cells[i].cells) {
      const auto known = std::find_if(rows.begin(), rows.end(), [&](const auto& row) {
        return row[0] == cell.strategy && row[1] == cell.composition;
      });
      auto& row =
          known == rows.end()
              ? rows.emplace_back(std::vector<std::string>{
                    cell.strategy, cell.composition, fmt::format("{:.4g}", cell.mean), fmt::format("{:.3g}", cell.sd)})
              : *known;
      if (!cell.imposed) continue;
      row.resize(head.size() - 1);
      row.push_back(fmt::format("{:.4g}", *cell.imposed));
    }
  }
  TextTable table{"ll" + std::string(head.size() - 2, 'r')};
  table.add(head);
  for (auto& row : rows) {
    row.resize(head.size());
    table.add(row);
  }
  return console.bold(std::string{name_of(quantity)} + " of simulated teams") + " (can be " + range + ")\n" +
         table.text(console) + console.dim(notes) + "\n";
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

// One line per size; the bar is the power, ':' the power wanted.
std::string curve_text(const PowerCurve& curve, const PowerOptions& options, const Console& console) {
  constexpr std::size_t kBarWidth = 40;
  TextTable table{"rrlrl"};
  table.add({"teams", "power", "95 % interval", "by F", "0" + std::string(kBarWidth - 2, ' ') + "1"});
  for (const auto& point : curve.points) {
    std::string bar(kBarWidth, ' ');
    const auto full = static_cast<std::size_t>(std::lround(point.power * static_cast<double>(kBarWidth)));
    std::fill_n(bar.begin(), full, '#');
    const auto wanted = static_cast<std::size_t>(options.target * static_cast<double>(kBarWidth));
    if (wanted >= full) bar[std::min(wanted, kBarWidth - 1)] = ':';
    bar.resize(std::max(full, std::min(wanted, kBarWidth - 1) + 1));
    table.add({fmt::format("{}", point.teams), fmt::format("{:.3f}", point.power),
               fmt::format("{:.2f} .. {:.2f}", point.low, point.high),
               point.analytic_power ? fmt::format("{:.3f}", *point.analytic_power) : "", bar});
  }
  return console.bold(to_string(curve.effect)) + ": " + size_text(curve.effect, curve.size) + "\n" +
         needed_text(curve, options) + "\n" + table.text(console) + "\n";
}

std::string replication_text(const std::vector<PublishedFinding>& findings, const Replication& result,
                             const StudySpec& spec, const Console& console) {
  TextTable table{"llrlrrr"};
  table.add({"finding", "published", "significant", "95 % interval", "eta2", "power by F", "power imposed"});
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto& finding = findings[i];
    const auto& outcome = result.findings[i];
    auto published = fmt::format("{}{:g}", finding.significant ? "p < " : "p >= ", finding.alpha);
    if (finding.f) published += fmt::format(", F = {:g}", *finding.f);
    table.add({to_string(finding.effect), published,
               fmt::format("{:.1f} %",
                           100.0 * static_cast<double>(outcome.significant) / static_cast<double>(result.studies)),
               fmt::format("{:.1f} .. {:.1f} %", 100.0 * outcome.low, 100.0 * outcome.high),
               outcome.published_eta_squared ? fmt::format("{:.3f}", *outcome.published_eta_squared) : "",
               outcome.analytic_power ? fmt::format("{:.2f}", *outcome.analytic_power) : "",
               outcome.imposed_power ? fmt::format("{:.2f}", outcome.imposed_power->power) : ""});
  }
  return fmt::format("{} of {} teams per cell, each with people of its own\n", counted(result.studies, "study run"),
                     spec.replicates) +
         table.text(console) +
         console.dim(
             "significant: share of the studies. eta2: partial eta squared of the published F.\n"
             "power: of such a study if this were the true effect, by the non-central F\n"
             "distribution and imposed on simulated teams") +
         fmt::format("\n\nAll findings as published: {} of {} studies; on average {:.1f} of {} findings.\n",
                     result.all_agree, result.studies, result.mean_agreement, findings.size());
}

// Here the simulated people are those of the study, and the analysis may not know.
std::string replication_assumptions(const StudySpec& spec, bool paired, const Console& console) {
  std::string text = "Assumptions:\n  " + assumptions(spec, paired).front() + "\n";
  const bool same = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
  if (same && !paired) {
    text +=
        "  The study teaches the same people with every strategy (pairing = \"replicate\") and the tests treat teams "
        "as\n"
        "  independent, as the published ones do: tests of strategy find too little. Add --paired to test within\n"
        "  people, or --set design.pairing=none to simulate different people.\n";
  } else if (same) {
    text += "  Every strategy teaches the same people; strategies are compared within people.\n";
  } else if (paired) {
    text +=
        "  --paired compares teams of equal number, but this study teaches different people (pairing = \"none\").\n";
  } else {
    text += "  Every cell teaches different people, so teams are independent.\n";
  }
  return console.dim(text);
}

// --- JSON -------------------------------------------------------------------------

template <typename T>
Json known(const std::optional<T>& value) {
  return value ? Json(*value) : Json{};
}

Json power_json(const PowerPoint& point) {
  return {{"teams", point.teams}, {"power", point.power},           {"low", point.low},
          {"high", point.high},   {"pool_error", point.pool_error}, {"analytic_power", known(point.analytic_power)}};
}

Json curve_json(const PowerCurve& curve, const EffectCells& cells) {
  Json points = Json::array(), means = Json::array();
  for (const auto& cell : cells.cells) {
    means.push_back({{"strategy", cell.strategy},
                     {"composition", cell.composition},
                     {"mean", cell.mean},
                     {"sd", cell.sd},
                     {"imposed", known(cell.imposed)}});
  }
  for (const auto& point : curve.points) points.push_back(power_json(point));
  return {{"effect", to_string(curve.effect)},
          {"imposed", curve.effect.imposed.has_value()},
          {"size", curve.size},
          {"measure", curve.effect.kind == Effect::Kind::kContrast ? "difference" : "partial eta squared"},
          {"points", points},
          {"range", {{"low", cells.low}, {"high", std::isinf(cells.high) ? Json{} : Json(cells.high)}}},
          {"cells", means},
          {"needed",
           {{"estimate", known(curve.needed.estimate)},
            {"low", known(curve.needed.low)},
            {"high", known(curve.needed.high)},
            {"analytic", known(curve.needed.analytic)}}}};
}

Json replication_json(const std::vector<PublishedFinding>& findings, const Replication& result) {
  Json list = Json::array();
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto& outcome = result.findings[i];
    list.push_back({{"effect", to_string(findings[i].effect)},
                    {"alpha", findings[i].alpha},
                    {"published_significant", findings[i].significant},
                    {"published_f", known(findings[i].f)},
                    {"significant", outcome.significant},
                    {"low", outcome.low},
                    {"high", outcome.high},
                    {"published_eta_squared", known(outcome.published_eta_squared)},
                    {"analytic_power", known(outcome.analytic_power)},
                    {"imposed_power", outcome.imposed_power ? power_json(*outcome.imposed_power) : Json{}}});
  }
  return {{"studies", result.studies},
          {"findings", list},
          {"all_agree", result.all_agree},
          {"mean_agreement", result.mean_agreement}};
}

int run_curves(const PowerCommandOptions& options, const StudyReading& reading, const Atlas& atlas, Progress& progress,
               Console& console) {
  const auto& spec = reading.study->variants.front();
  std::vector<Effect> effects;
  for (const auto& text : options.effects) effects.push_back(effect_of(text, spec));
  if (effects.empty()) effects = default_effects(spec, atlas.domain().num_features());
  PowerOptions power;
  power.teams = sizes_of(options, spec.replicates);
  power.alpha = options.alpha;
  power.target = options.target;
  power.draws = options.draws;
  // A preregistration plans the tests of kith analyze, which knows which strategies teach the same people.
  const bool same_people = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
  power.paired = options.paired || (!options.preregister.empty() && same_people);
  power.seed = options.seed.value_or(spec.seed);
  std::vector<Quantity> quantities;
  for (const auto& effect : effects) quantities.push_back(effect.quantity);
  auto pool_spec = recording(spec, quantities);
  pool_spec.replicates = options.pool.value_or(std::max(kDefaultPool, 2 * power.teams.back()));
  pool_spec.seed = power.seed;
  check_pool(options, pool_spec.replicates, power.teams);
  const Study pool_study{{pool_spec}};
  require_pool_memory(pool_study, options.threads, num_teams(pool_study));  // before the time is measured
  if (!console.quiet()) console.info(work_text(atlas, pool_spec, options.threads, num_teams(pool_study)));
  const auto pools =
      simulate_pools(atlas, pool_study, {.threads = options.threads, .on_progress = progress.until_stopped()});
  progress.finish();
  if (!pools) return interrupted("interrupted; there is no result", console);
  const auto& pool = pools->front();
  const auto cells = checked_cells(pool, effects, console);
  const auto curves = power_curves(pool, effects, power);
  if (!options.preregister.empty()) {
    const PlannedStudy planned{spec, atlas.domain(), freeze(reading), options.study, utc_now()};
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
  for (std::size_t q = 0; q < kNumQuantities; ++q) {
    const auto quantity = static_cast<Quantity>(q);
    if (std::find(quantities.begin(), quantities.end(), quantity) != quantities.end())
      text += cells_text(quantity, curves, cells, console);
  }
  console.print(text +
                console.dim(fmt::format("significance level {:g}; {} studies of each size, drawn from {} teams per "
                                        "cell;\nintervals include the error from both",
                                        power.alpha, power.draws, pool_spec.replicates)) +
                "\n" + assumptions_text(spec, power.paired, console));
  return 0;
}

int run_replication(const PowerCommandOptions& options, const Study& study, const StudyText& source, const Atlas& atlas,
                    Progress& progress, Console& console) {
  auto spec = study.variants.front();
  if (options.teams.size() > 1) refuse("--findings repeats a study of one size, so --teams takes one number");
  if (!options.teams.empty()) spec.replicates = options.teams.front();
  const auto set = targets_of(options.findings, source);
  if (set.findings.empty())
    throw Error{{Diagnostic{.id = "E0813", .message = "there is no [[finding]]", .file = options.findings}}};
  ReplicationOptions replication;
  replication.studies = options.studies;
  replication.seed = options.seed.value_or(spec.seed);
  replication.threads = options.threads;
  replication.paired = options.paired;
  replication.on_progress = progress.until_stopped();
  if (!console.quiet()) {
    const auto teams = spec.replicates * spec.strategies.size() * spec.compositions.size() * replication.studies;
    console.info(work_text(atlas, spec, options.threads, teams));
  }
  const auto result = replicate_findings(atlas, spec, set.findings, replication);
  progress.finish();
  if (!result) return interrupted("interrupted; there is no result", console);
  if (console.json()) {
    auto document = Json{{"schema", "kith.power/1"},
                         {"study", options.study},
                         {"seed", replication.seed},
                         {"teams_per_cell", spec.replicates},
                         {"paired", options.paired}};
    document["replication"] = replication_json(set.findings, *result);
    console.print_json(document);
    return 0;
  }
  console.print(replication_text(set.findings, *result, spec, console) +
                replication_assumptions(spec, options.paired, console));
  return 0;
}

void declare(OptionList& list, PowerCommandOptions& options) {
  constexpr NumberRange kShare{1e-6, 1.0 - 1e-6};
  list.study(options.study).required();
  auto effects = list.texts("--effect", options.effects, "EFFECT",
                            "Effect, such as 'periods: strategy eta2 = 0.02' (may be repeated; default: all)");
  list.number("--target", options.target, "P", kShare, "Desired power");
  list.number("--alpha", options.alpha, "P", kShare, "Significance level");
  list.integer("--teams", options.teams, {2, 100'000},
               "Teams per cell, separated by commas (default: 5,10,15,20,30,50,100)");
  list.integer("--pool", options.pool, {4, 1'000'000},
               "Teams per cell to draw studies from, at least twice the largest of --teams (default: 1000)");
  list.integer("--draws", options.draws, {10, 1'000'000}, "Studies drawn for each size");
  list.flag("--paired", options.paired, "Every strategy teaches the same people; compare strategies within people");
  auto findings = list.text("--findings", options.findings, "FILE",
                            "Repeat the study and count how often the findings in this targets file are reproduced");
  findings.excludes(effects);
  list.text("--preregister", options.preregister, "FILE",
            "Write a preregistration of the study to this file: hypotheses, design, sample size, stopping, analyses")
      .excludes(findings);
  list.integer("--studies", options.studies, {2, 100'000}, "Repetitions for --findings");
  list.threads(options.threads, "; never changes a result");
  list.integer("--seed", options.seed, {}, "Random seed (default: that of the study)");
  list.set(options.set);
  list.progress(options.progress);
  list.json();
}

int run(const PowerCommandOptions& options, Console& console) {
  const StudyText source{options.study, options.set};
  const auto reading = source.read({});
  if (!console.quiet()) console.show(reading.diagnostics);
  check_single_variant(options.study, *reading.study);
  watch_signals();
  const Atlas atlas = planned(*reading.domain, console);
  Progress progress{options.progress, console};
  if (!options.findings.empty()) return run_replication(options, *reading.study, source, atlas, progress, console);
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
