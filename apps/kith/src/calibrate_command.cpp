#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/present/json.hpp"
#include "kith/study_design/calibration.hpp"
#include "page.hpp"
#include "planning_input.hpp"
#include "progress.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct CalibrateOptions {
  std::string study;
  std::string targets;  ///< "-" is standard input.
  std::string out;      ///< The study file to write; empty: none.
  std::optional<std::uint64_t> seed;
  std::size_t threads = 0;             ///< 0: as many as there are cores. Changes the speed, never the results.
  std::optional<std::size_t> teams;    ///< Per cell and setting tried.
  std::optional<std::size_t> confirm;  ///< Per cell, to confirm the best settings.
  bool quick = false;
  bool yes = false;  ///< Replace an existing file.
  std::vector<std::string> set;
  ProgressMode progress = ProgressMode::kAuto;
};

// The largest |miss| that still counts as met.
bool is_met(const TargetOutcome& outcome) { return std::abs(outcome.miss) <= 1.0; }

// The standard error of a figure, in tolerances.
double error_in_tolerances(const Target& target, const TargetOutcome& outcome) {
  const double tolerance = target.is_factor ? std::log(target.tolerance) : target.tolerance;
  return compared_error(target, outcome.model, outcome.standard_error) / tolerance;
}
constexpr double kLargeError = 0.5;

// As many digits as tell the figure from its noise.
std::string figure(double value) {
  return fmt::format("{:.{}f}", value, std::abs(value) >= 100.0 ? 0 : std::abs(value) >= 1.0 ? 2 : 3);
}

// Whether an interval ends because the parameter may not go further, or because the search did not.
std::string range_text(const ParameterRange& range, const FreeParameter& parameter) {
  const auto interval = fmt::format("{:.3g} .. {:.3g}", range.low, range.high);
  const bool at_min = range.open_low && range.low <= parameter.min;
  const bool at_max = range.open_high && range.high >= parameter.max;
  if (at_min && at_max) return interval + " (the whole range: no limit)";
  std::string note;
  const auto add = [&](const std::string& text) { note += (note.empty() ? "" : ", ") + text; };
  if (at_min) add("no lower limit in the range");
  if (at_max) add("no upper limit in the range");
  if (range.open_low && !at_min) add("or less: the last design ended here");
  if (range.open_high && !at_max) add("or more: the last design ended here");
  return note.empty() ? interval : interval + " (" + note + ")";
}

std::string parameters_table(const TargetSet& set, const Calibration& result, const Console& console) {
  TextTable table{"lrrl"};
  table.add({"parameter", "study", "calibrated", "95 % interval (others adjusted)"});
  for (std::size_t k = 0; k < set.parameters.size(); ++k) {
    table.add({set.parameters[k].name, fmt::format("{}", set.parameters[k].present),
               fmt::format("{}", result.best.values[k]), range_text(result.ranges[k], set.parameters[k])});
  }
  return table.text(console);
}

std::string targets_table(const TargetSet& set, const Calibration& result, const Console& console) {
  TextTable table{"lrlrrrll"};
  table.add({"target", "published", "(se)", "model", "(se)", "off by", "", "wish"});
  for (std::size_t t = 0; t < set.targets.size(); ++t) {
    const auto& target = set.targets[t];
    const auto& outcome = result.best.targets[t];
    const auto published = target.standard_error ? fmt::format("({:.2g})", *target.standard_error) : "(not given)";
    const auto wish = (target.is_factor ? "x/ " : "+- ") + figure(target.tolerance);
    table.add({to_string(target), figure(target.value), published, figure(outcome.model),
               fmt::format("({:.2g})", outcome.standard_error), fmt::format("{:+.1f} se", outcome.misfit),
               is_met(outcome) ? "met" : "missed", wish});
  }
  return table.text(console) +
         console.dim(
             "off by: in standard errors of the difference, published and simulated together; without a\n"
             "published one, the tolerance counts as two. model (se): jackknife over replicates.\n"
             "wish: the tolerance") +
         "\n";
}

std::vector<std::string> with_parameters(std::vector<std::string> head, const TargetSet& set) {
  for (const auto& parameter : set.parameters) head.push_back(parameter.name);
  return head;
}

std::string candidates_table(const TargetSet& set, const Calibration& result, const Console& console) {
  TextTable table{"lr" + std::string(set.parameters.size(), 'r')};
  table.add(with_parameters({"confirmed with new teams", "misfit"}, set));
  for (const auto& candidate : result.candidates) {
    std::vector<std::string> row{candidate.label, fmt::format("{:.2f}", candidate.misfit)};
    for (const double value : candidate.values) row.push_back(fmt::format("{}", value));
    table.add(row);
  }
  return table.text(console) +
         console.dim(
             "misfit: chi-squared with the model discrepancy; settings within 3.84 do not differ in one parameter") +
         "\n";
}

std::string sensitivity_table(const TargetSet& set, const Calibration& result, const Console& console) {
  TextTable table{"lr" + std::string(set.parameters.size(), 'r')};
  table.add(with_parameters({"share of variance", "explained"}, set));
  for (std::size_t t = 0; t < set.targets.size(); ++t) {
    std::vector<std::string> row{to_string(set.targets[t]),
                                 fmt::format("{:.0f}%", 100.0 * std::max(0.0, result.sensitivity_explained[t]))};
    for (const auto& sensitivity : result.sensitivities[t])
      row.push_back(fmt::format("{:.0f}% {}", 100.0 * sensitivity.total_share, sensitivity.slope < 0.0 ? "-" : "+"));
    table.add(row);
  }
  return table.text(console) +
         console.dim(
             "share of the figure's variance over the whole ranges that each parameter explains, with\n"
             "its interactions, by a quadratic model; + or -: the figure rises or falls with it.\n"
             "explained: share that the model predicts for settings left out") +
         "\n";
}

std::string discrepancy_sentence(const Calibration& result) {
  if (!result.misfit_p) {
    return "The targets determine as many parameters as there are targets, so they cannot show whether the model\n"
           "disagrees with them; intervals assume that it does not.\n";
  }
  const auto test =
      fmt::format("chi-squared {:.1f}, {:.1f} degrees of freedom, {}", result.least_misfit, result.degrees_of_freedom,
                  *result.misfit_p < 0.001 ? "p < 0.001" : fmt::format("p = {:.3f}", *result.misfit_p));
  if (result.discrepancy <= 0.0)
    return "The model misses these targets by no more than chance explains (" + test + ").\n";
  return fmt::format(
      "The model misses these targets by about {:.1f} published standard errors beyond chance\n({}); "
      "intervals include that discrepancy.\n",
      result.discrepancy, test);
}

std::string conflict_sentences(const TargetSet& set, const Calibration& result) {
  const auto missed = std::count_if(result.best.targets.begin(), result.best.targets.end(),
                                    [](const TargetOutcome& outcome) { return !is_met(outcome); });
  std::string text = missed == 0 ? "All targets are met within their tolerances.\n"
                                 : fmt::format("{} of {} targets are missed.\n", missed, set.targets.size());
  std::size_t uncertain = 0;
  for (std::size_t t = 0; t < set.targets.size(); ++t)
    if (error_in_tolerances(set.targets[t], result.best.targets[t]) > kLargeError) ++uncertain;
  if (uncertain > 0) {
    text += fmt::format(
        "For {} of {} targets the standard error is larger than half the tolerance, so whether they are met is\n"
        "uncertain: simulate more teams (--teams, --confirm).\n",
        uncertain, set.targets.size());
  }
  text += discrepancy_sentence(result);
  constexpr std::size_t kShown = 4;
  for (std::size_t i = 0; i < std::min(kShown, result.conflicts.size()); ++i) {
    const auto& conflict = result.conflicts[i];
    text += fmt::format(
        "The {} and the {} conflict: each can be met alone, but together one misses by at least {:.1f} se.\n",
        to_string(set.targets[conflict.first]), to_string(set.targets[conflict.second]), conflict.closest);
  }
  return text;
}

std::string frontier_table(const TargetSet& set, const Calibration& result, const Console& console) {
  if (!result.first_quantity || result.frontier.empty()) return "";
  std::vector<std::size_t> means;
  for (std::size_t t = 0; t < set.targets.size(); ++t) {
    if (set.targets[t].statistic == Statistic::kMean) means.push_back(t);
  }
  TextTable table{"rr" + std::string(means.size() + set.parameters.size(), 'r')};
  std::vector<std::string> header{fmt::format("{} error", name_of(*result.first_quantity)),
                                  fmt::format("{} error", name_of(*result.second_quantity))};
  for (const auto t : means)
    header.push_back(fmt::format("{} {}", to_string(set.targets[t].teams), name_of(set.targets[t].quantity)));
  table.add(with_parameters(std::move(header), set));
  for (const auto& point : result.frontier) {
    std::vector<std::string> row{fmt::format("{:.2f}", point.first_error), fmt::format("{:.2f}", point.second_error)};
    for (const auto t : means) row.push_back(figure(point.point.targets[t].model));
    for (const double value : point.point.values) row.push_back(fmt::format("{:.3g}", value));
    table.add(row);
  }
  return "\nTrade-off: no setting is better than another of these in both.\n" + table.text(console) +
         console.dim("error: root mean square of how far the means miss, in published standard errors") + "\n";
}

std::string report(const TargetSet& set, const Calibration& result, const Console& console) {
  return parameters_table(set, result, console) + "\n" + targets_table(set, result, console) + "\n" +
         candidates_table(set, result, console) + "\n" + sensitivity_table(set, result, console) + "\n" +
         conflict_sentences(set, result) + frontier_table(set, result, console);
}

// --- JSON ---------------------------------------------------------------------------

Json calibration_json(const TargetSet& set, const CalibrationPoint& point) {
  Json values = Json::object();
  for (std::size_t k = 0; k < set.parameters.size(); ++k) values[set.parameters[k].name] = point.values[k];
  Json targets = Json::array();
  for (const auto& target : point.targets)
    targets.push_back({{"model", target.model},
                       {"standard_error", target.standard_error},
                       {"misfit", target.misfit},
                       {"miss", target.miss}});
  return {{"label", point.label},
          {"values", values},
          {"teams_per_cell", point.teams_per_cell},
          {"misfit", point.misfit},
          {"targets", targets}};
}

Json target_json(const Target& target) {
  Json json{{"statistic", target.effect                          ? "F"
                          : target.statistic == Statistic::kMean ? "mean"
                                                                 : "sd"},
            {"value", target.value},
            {"standard_error", target.standard_error ? Json(*target.standard_error) : Json(nullptr)},
            {target.is_factor ? "within_factor" : "tolerance", target.tolerance},
            {"priority", target.priority},
            {"source", target.source}};
  if (target.effect) {
    json["effect"] = to_string(*target.effect);
    json["df"] = {target.df1, target.df2};
  } else {
    json["quantity"] = name_of(target.quantity);
    json["teams"] = to_string(target.teams);
  }
  return json;
}

Json parameters_json(const TargetSet& set, const Calibration& result) {
  Json parameters = Json::array();
  for (std::size_t k = 0; k < set.parameters.size(); ++k) {
    const auto& parameter = set.parameters[k];
    const auto& range = result.ranges[k];
    parameters.push_back({{"name", parameter.name},
                          {"keys", parameter.keys},
                          {"min", parameter.min},
                          {"max", parameter.max},
                          {"present", parameter.present},
                          {"value", result.best.values[k]},
                          {"low", range.low},
                          {"high", range.high},
                          {"open_low", range.open_low},
                          {"open_high", range.open_high}});
  }
  return parameters;
}

Json document_of(const std::string& study, std::uint64_t seed, const TargetSet& set, const Calibration& result) {
  Json targets = Json::array();
  for (std::size_t t = 0; t < set.targets.size(); ++t) {
    auto target = target_json(set.targets[t]);
    target["surface_error"] = result.surface_error[t];
    target["surface_explained"] = result.explained[t];
    Json sensitivities = Json::object();
    for (std::size_t k = 0; k < set.parameters.size(); ++k) {
      const auto& one = result.sensitivities[t][k];
      sensitivities[set.parameters[k].name] = {
          {"main_share", one.main_share}, {"total_share", one.total_share}, {"slope", one.slope}};
    }
    target["sensitivity"] = sensitivities;
    target["sensitivity_explained"] = result.sensitivity_explained[t];
    targets.push_back(target);
  }
  Json candidates = Json::array();
  for (const auto& candidate : result.candidates) candidates.push_back(calibration_json(set, candidate));
  Json conflicts = Json::array();
  for (const auto& conflict : result.conflicts)
    conflicts.push_back({{"first", conflict.first}, {"second", conflict.second}, {"closest", conflict.closest}});
  Json frontier = Json::array();
  for (const auto& one : result.frontier) {
    auto point = calibration_json(set, one.point);
    point["errors"] = {{std::string{name_of(*result.first_quantity)}, one.first_error},
                       {std::string{name_of(*result.second_quantity)}, one.second_error}};
    frontier.push_back(point);
  }
  return {{"schema", "kith.calibration/1"},
          {"study", study},
          {"seed", seed},
          {"teams", result.teams_simulated},
          {"parameters", parameters_json(set, result)},
          {"targets", targets},
          {"discrepancy", result.discrepancy},
          {"least_misfit", result.least_misfit},
          {"degrees_of_freedom", result.degrees_of_freedom},
          {"misfit_p", result.misfit_p ? Json(*result.misfit_p) : Json(nullptr)},
          {"best", calibration_json(set, result.best)},
          {"candidates", candidates},
          {"conflicts", conflicts},
          {"frontier", frontier}};
}

// --- the file -------------------------------------------------------------------------

std::string commented(const std::string& text) {
  std::string lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto line = text.substr(begin, end - begin);
    lines += (line.empty() ? "#" : "# " + line) + "\n";
    begin = end + 1;
  }
  return lines;
}

std::string plain_report(const TargetSet& set, const Calibration& result) {
  const Console console{{.color = ColorMode::kNever}};
  return parameters_table(set, result, console) + "\n" + targets_table(set, result, console) + "\n" +
         conflict_sentences(set, result);
}

// The complete study with the calibrated values, the domain named as seen from its new place.
std::string study_file(const CalibrateOptions& options, const StudyText& source, const TargetSet& set,
                       const Calibration& result) {
  auto reading = source.read(overrides_of(set.parameters, result.best.values));
  for (auto& spec : reading.study->variants) {
    if (spec.id.find("calibrated") == std::string::npos || spec.id.find("uncalibrated") != std::string::npos)
      spec.id += "-calibrated";  // another study than the one that it began with
    const auto domain = source.folder() / spec.domain;
    std::error_code failure;
    if (spec.domain.find('.') == std::string::npos || !std::filesystem::exists(domain, failure)) continue;
    const auto folder = std::filesystem::absolute(options.out, failure).parent_path();
    const auto path = std::filesystem::absolute(domain, failure);
    const auto seen_from_there = std::filesystem::proximate(path, folder, failure);
    spec.domain = failure ? path.string() : seen_from_there.string();
  }
  return commented(fmt::format("{} with parameters calibrated to {} (seed {}, {} simulated teams).\n\n", options.study,
                               options.targets, options.seed.value_or(1), result.teams_simulated)) +
         commented(plain_report(set, result)) + "\n" + to_toml(*reading.study, *reading.domain);
}

void check_out(const CalibrateOptions& options) {
  if (options.out.empty()) return;
  std::error_code failure;
  for (const auto& input : {options.study, options.targets}) {
    if (std::filesystem::equivalent(options.out, input, failure)) refuse("-o must not be the input " + input);
  }
  require_replaceable(options.out, options.yes);
}

CalibrationOptions search_options(const CalibrateOptions& options) {
  CalibrationOptions search;
  if (options.quick) {
    search.rounds = 2;
    search.points = 36;
    search.teams = 8;
    search.frontier_points = 5;
  }
  if (options.teams) search.teams = *options.teams;
  search.confirm_teams = options.confirm.value_or(5 * search.teams);
  search.seed = options.seed.value_or(1);
  search.threads = options.threads;
  return search;
}

void declare(OptionList& list, CalibrateOptions& options) {
  list.study(options.study).required();
  list.text("--targets", options.targets, "FILE",
            "File with the published figures, their tolerances and the free parameters");
  list.text("-o,--out", options.out, "FILE", "Write the calibrated study to this file");
  list.threads(options.threads, "; never changes a result");
  list.integer("--seed", options.seed, {}, "Random seed of the search (default: 1)");
  list.integer("--teams", options.teams, {2, 100'000},
               "Teams per cell for each setting of the last design (default: 40)");
  list.integer("--confirm", options.confirm, {2, 1'000'000},
               "Teams per cell to confirm the best settings (default: five times --teams)");
  list.flag("--quick", options.quick, "Coarse search in about a tenth of the time");
  list.set(options.set);
  list.flag("--yes", options.yes, "Replace the file of -o if there is one");
  list.progress(options.progress);
  list.json();
}

int run(const CalibrateOptions& options, Console& console) {
  if (options.targets.empty()) refuse("kith calibrate needs --targets FILE");
  if (options.study == "-" && options.targets == "-") refuse("only one of STUDY and --targets can be standard input");
  check_out(options);
  const StudyText source{options.study, options.set};
  const auto reading = source.read({});
  if (!console.quiet()) show_warnings(reading, console);
  check_single_variant(options.study, *reading.study);
  const auto set = targets_of(options.targets, source);
  if (set.targets.empty() || set.parameters.empty()) {
    throw Error{{Diagnostic{.id = "E0811",
                            .message = set.targets.empty() ? "there is no [[target]]" : "there is no [[parameter]]",
                            .file = options.targets}}};
  }

  watch_signals();
  const Atlas atlas = planned(*reading.domain, console);
  Progress progress{options.progress, console};
  auto search = search_options(options);
  search.on_progress = progress.until_stopped();
  if (!console.quiet()) {
    const auto& spec = reading.study->variants.front();
    const auto teams = most_teams_per_cell(search) * spec.strategies.size() * spec.compositions.size();
    console.info("at most: " + work_text(atlas, spec, search.threads, teams));
  }
  const auto result = calibrate(
      atlas, [&](const auto& overrides) { return source.read(overrides); }, set, search);
  progress.finish();
  if (!result) return interrupted("interrupted; nothing was written", console);
  if (!options.out.empty()) write_file_atomically(options.out, study_file(options, source, set, *result));
  console.print([&] { return document_of(options.study, search.seed, set, *result); },
                [&] { return report(set, *result, console); });
  console.info(fmt::format("{} simulated{}", counted(result->teams_simulated, "team"),
                           options.out.empty() ? "" : "; the calibrated study is in " + options.out));
  return 0;
}

}  // namespace

void add_calibrate(Commands& commands) {
  commands.add<CalibrateOptions>("calibrate", "Fit a study's free parameters to published figures",
                                 {"kith calibrate paper-uncalibrated --targets targets.toml -o mine.toml",
                                  "kith calibrate paper --targets studies/paper-targets.toml --quick"},
                                 declare, run);
}

}  // namespace kith::cli
