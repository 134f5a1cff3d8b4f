#include "preregistration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "build_facts.hpp"
#include "kith/analysis/plan.hpp"
#include "kith/files/sha256.hpp"

namespace kith::cli {
namespace {

std::vector<std::string> names_of(const std::vector<StrategyChoice>& strategies) {
  std::vector<std::string> names;
  for (const auto& strategy : strategies) names.push_back(strategy.name);
  return names;
}

std::string weights_text(const PlannedContrast& contrast) {
  std::string text;
  for (const auto& [level, weight] : contrast.weights)
    text += fmt::format("{}{:.3g} {}",
                        text.empty()   ? (weight < 0.0 ? "-" : "")
                        : weight < 0.0 ? " - "
                                       : " + ",
                        std::abs(weight), level);
  return text;
}

std::vector<PlannedContrast> contrasts_of(const StudySpec& spec) {
  std::vector<PlannedContrast> contrasts;
  for (const auto& one : spec.contrasts) {
    PlannedContrast contrast{.name = one.name, .factor = one.factor, .response = one.response, .primary = one.primary};
    for (const auto& [level, weight] : one.weights) contrast.weights.push_back({level, weight});
    contrasts.push_back(std::move(contrast));
  }
  return contrasts;
}

std::string design_text(const StudySpec& spec) {
  const auto cells = spec.strategies.size() * spec.compositions.size();
  const bool same = spec.pairing == Pairing::kReplicate && spec.strategies.size() > 1;
  std::string text = "## Design\n\n";
  text += fmt::format("* Strategies ({}): {}\n", spec.strategies.size(), fmt::join(names_of(spec.strategies), ", "));
  text += fmt::format("* Compositions ({}): {}\n", spec.compositions.size(), fmt::join(spec.compositions, ", "));
  for (const auto& factor : spec.factors) text += fmt::format("* {}: {}\n", factor.key, factor.value);
  text += same ? "* Every strategy teaches the same people, so strategies are compared within people.\n"
               : "* Every team has people of its own.\n";
  text +=
      "* Outcomes: the number of interaction periods until everything is learned (`periods`), and the mean over "
      "members of the final belief in the true policy's behaviour (`knowledge`).\n";
  if (spec.exam != ExamLevel::kNone) {
    text +=
        "* Outcomes of an exam over all starts of the domain, which the teacher does not influence: the share of "
        "starts "
        "where members predict the robot (`exam_share_right`), the smallest share of a member "
        "(`exam_worst_share_right`), and what wrong predictions lose (`exam_regret`).\n";
  }
  text += fmt::format("* {} cells with {} teams each: {} teams.\n\n", cells, spec.replicates, cells * spec.replicates);
  return text;
}

std::string size_row(const PowerCurve& curve, std::size_t teams) {
  const auto point =
      std::find_if(curve.points.begin(), curve.points.end(), [&](const PowerPoint& one) { return one.teams == teams; });
  const bool is_contrast = curve.effect.kind == Effect::Kind::kContrast;
  const auto power = point == curve.points.end()
                         ? std::string{}
                         : fmt::format("{:.2f} [{:.2f}, {:.2f}]", point->power, point->low, point->high);
  const auto needed = curve.needed.estimate ? fmt::format("{:.0f}", std::ceil(*curve.needed.estimate))
                                            : fmt::format("more than {}", curve.points.back().teams);
  return fmt::format("| {} | {} {:.3g}{} | {} | {} |\n", to_string(curve.effect),
                     is_contrast ? "difference" : "partial eta squared", curve.size,
                     curve.effect.imposed ? "" : " (as simulated)", power, needed);
}

// What the effects are effects on.
std::string cells_text(std::span<const PowerCurve> curves, std::span<const EffectCells> cells) {
  std::string text =
      "\nMeans (standard deviations) of the simulated teams; where an effect is imposed, the means that it gives:\n\n"
      "| effect | strategy | composition | mean (sd) | imposed mean |\n|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (const auto& cell : cells[i].cells) {
      text += fmt::format("| {} | {} | {} | {:.4g} ({:.3g}) | {} |\n", to_string(curves[i].effect), cell.strategy,
                          cell.composition, cell.mean, cell.sd,
                          cell.imposed ? fmt::format("{:.4g}", *cell.imposed) : std::string{});
    }
  }
  return text;
}

std::string sample_text(const StudySpec& spec, std::span<const PowerCurve> curves, std::span<const EffectCells> cells,
                        const PowerOptions& options, const std::string& missing) {
  auto text = fmt::format(
      "## Sample size\n\n{} teams per cell. Power at a significance level of {:g} was estimated by drawing {} studies "
      "of each size from simulated teams (`kith power`{}):\n\n"
      "| effect | size | power with {} teams per cell [95 % interval] | teams per cell for power {:g} |\n"
      "|---|---|---|---|\n",
      spec.replicates, options.alpha, options.draws, options.paired ? ", `--paired`" : "", spec.replicates,
      options.target);
  for (const auto& curve : curves) text += size_row(curve, spec.replicates);
  if (!missing.empty()) text += "\nNote: " + missing + ".\n";
  text += cells_text(curves, cells);
  text += fmt::format(
      "\n## Stopping rule\n\nData collection ends when every cell has {} teams. No test is made before that, and no "
      "team is added after a test. A team that has not learned everything after {} periods is stopped.\n\n",
      spec.replicates, spec.teaching.max_periods);
  return text;
}

std::string analysis_text(const PlannedAnalysis& one, std::size_t number) {
  auto text = fmt::format("\n### {}. {}\n\n{}\n\n* Model: `{}`\n", number, one.title, one.question, one.model);
  for (const auto& contrast : one.contrasts) {
    text += fmt::format("* Planned contrast {}{}: {}\n",
                        contrast.primary ? fmt::format("of `{}`, ", contrast.response) : std::string{}, contrast.name,
                        weights_text(contrast));
  }
  for (const auto& method : one.methods) text += "* " + method.text + "\n";
  return text;
}

std::string analyses_text(const std::vector<PlannedAnalysis>& plan, double alpha) {
  auto text = fmt::format(
      "All tests are two-sided; p < {:g} counts as evidence for an effect, after the correction that an analysis "
      "names. Effect sizes are reported with intervals. A test that finds nothing is not taken as evidence that there "
      "is no effect.\n",
      alpha);
  std::size_t number = 0;
  for (const auto& analysis : plan) text += analysis_text(analysis, ++number);
  return text;
}

// The hypotheses: the primary contrasts, or without any the questions of all analyses.
std::string hypotheses_text(const std::vector<PlannedContrast>& primary, const std::vector<PlannedAnalysis>& plan) {
  std::size_t number = 0;
  std::string text = "## Hypotheses\n\n";
  if (primary.empty()) {
    text += "Each is tested against the hypothesis of no effect.\n\n";
    for (const auto& analysis : plan) text += fmt::format("{}. {} ({})\n", ++number, analysis.question, analysis.id);
    return text + "\n";
  }
  text += fmt::format(
      "{} tested against the hypothesis of no difference{}. The finding `primary` of kith analyze tests {}.\n\n",
      primary.size() == 1 ? "It is" : "Each is",
      primary.size() == 1 ? "" : fmt::format(", corrected for the number of {} by Holm's method", primary.size()),
      primary.size() == 1 ? "it" : "them");
  for (const auto& hypothesis : primary) {
    text += fmt::format("{}. `{}`: {}: the weighted sum of means {} is not 0.\n", ++number, hypothesis.response,
                        hypothesis.name, weights_text(hypothesis));
  }
  return text + "\n";
}

// Whether the study was run before, as far as that can be seen.
std::string run_text(const PlannedStudy& planned) {
  const auto digest = published_digest(planned.results);
  if (!digest) return fmt::format("no finished run was found in `{}`", planned.results);
  const auto when = published_fact(planned.results, "stopped").value_or("an unknown time");
  if (*digest == planned.inputs.digest())
    return fmt::format("**after the study was run**: `{}` holds a run of these inputs, finished on {}", planned.results,
                       when);
  if (published_fact(planned.results, "study") == planned.spec.id)
    return fmt::format("`{}` holds a run of this study with other inputs, finished on {}", planned.results, when);
  return fmt::format("no run of this study was found in `{}`", planned.results);
}

// What proves that this was planned, and not something else.
std::string identity_text(const PlannedStudy& planned) {
  const auto& weights = planned.domain.weights().raw;
  const auto& names = planned.domain.feature_names();
  std::string reward;
  for (std::size_t k = 0; k < names.size(); ++k)
    reward += fmt::format("{}{} {:g}", k == 0 ? "" : ", ", names[k], weights.at(k));
  auto text = fmt::format(
      "Study `{}`, written by kith {} on {}; {}.\n\n* Domain: {} (`{}`); weights: {}\n* Seed: "
      "{}\n\n| input | SHA-256 |\n|---|---|\n| study.toml | {} |\n| domain.toml | {} |\n",
      planned.spec.id, program_name(), planned.written, run_text(planned), planned.spec.domain, planned.domain.id(),
      reward, planned.spec.seed, sha256(planned.inputs.study), sha256(planned.inputs.domain));
  for (const auto& file : planned.inputs.files) text += fmt::format("| {} | {} |\n", file.name, file.sha256);
  return text + fmt::format(
                    "| all inputs | {} |\n\nkith study keeps these files in `inputs` and their digests in "
                    "`manifest.json`; that of all inputs is called `run` there.\n\n",
                    planned.inputs.digest());
}

}  // namespace

std::string preregistration_text(const PlannedStudy& planned, std::span<const PowerCurve> curves,
                                 std::span<const EffectCells> cells, const PowerOptions& options) {
  const auto& spec = planned.spec;
  const PlannedDesign design{.strategies = names_of(spec.strategies),
                             .compositions = spec.compositions,
                             .same_people = spec.pairing == Pairing::kReplicate,
                             .contrasts = contrasts_of(spec),
                             .has_exam = spec.exam != ExamLevel::kNone};
  AnalysisOptions analysis;
  analysis.alpha = options.alpha;
  const auto plan = planned_analyses(design, analysis);
  const auto primary = primary_hypotheses(design);
  const auto is_primary = [](const PlannedAnalysis& one) { return one.id == "primary"; };
  std::vector<PlannedAnalysis> confirmatory, exploratory;
  std::copy_if(plan.begin(), plan.end(), std::back_inserter(confirmatory),
               [&](const auto& one) { return primary.empty() || is_primary(one); });
  std::copy_if(plan.begin(), plan.end(), std::back_inserter(exploratory),
               [&](const auto& one) { return !primary.empty() && !is_primary(one); });
  auto text = fmt::format("# Preregistration: {}\n\n", spec.title.empty() ? spec.id : spec.title);
  text += identity_text(planned) + hypotheses_text(primary, plan) + design_text(spec) +
          sample_text(spec, curves, cells, options, planned.missing) +
          "## Exclusions and missing data\n\nNo team is excluded. Teams that are stopped before they have learned "
          "everything are analysed with the periods and the knowledge that they have reached, and their number is "
          "reported.\n\n## Analyses\n\n" +
          analyses_text(confirmatory, options.alpha) + "\n## Exploratory analyses\n\n";
  if (!exploratory.empty()) {
    text +=
        "These are reported as exploratory: their p-values are not corrected for the number of analyses, and none of "
        "them is taken as evidence for or against a hypothesis.\n";
    std::size_t number = 0;
    for (const auto& one : exploratory) text += analysis_text(one, ++number);
    text += "\n";
  }
  text += fmt::format(
      "Whatever is not listed above, such as the manipulation check and comparisons that the data suggest, is reported "
      "as exploratory.\n\n## Commands\n\n    kith study {0} -o RESULTS\n    kith analyze RESULTS{1}\n\n## The study "
      "file\n\nWith every key written out, learners and teacher included:\n\n```toml\n{2}```\n",
      planned.source, options.alpha == AnalysisOptions{}.alpha ? "" : fmt::format(" --alpha {:g}", options.alpha),
      planned.inputs.study);
  return text;
}

}  // namespace kith::cli
