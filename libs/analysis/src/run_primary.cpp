#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_means.hpp"
#include "run_findings.hpp"
#include "shown.hpp"

namespace kith {

std::vector<PlannedContrast> by_response(const RunTeams& teams, const std::vector<PlannedContrast>& contrasts) {
  std::vector<PlannedContrast> result;
  for (const auto& contrast : contrasts) {
    for (const auto& [name, values] : outcomes_of(teams)) {
      if (!contrast.response.empty() && contrast.response != name) continue;
      result.push_back(contrast);
      result.back().response = name;
    }
  }
  return result;
}

std::optional<Finding> primary(const RunTeams& teams, const Outcomes& outcomes,
                               const std::vector<PlannedContrast>& contrasts, const AnalysisOptions& options) {
  auto hypotheses = by_response(teams, contrasts);
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), [](const auto& one) { return !one.primary; }),
                   hypotheses.end());
  if (hypotheses.empty()) return std::nullopt;
  const auto rows = group_teams(teams);
  const bool is_family = hypotheses.size() > 1;
  const std::string how =
      is_family ? fmt::format(" (Holm correction for {} hypotheses)", hypotheses.size()) : std::string{};
  Finding finding{.id = "primary",
                  .topic = hypotheses.size() == 1 ? "Primary hypothesis" : "Primary hypotheses",
                  .question = hypotheses.size() == 1 ? "Is there the difference that the study was planned to show?"
                                                     : "Are there the differences that the study was planned to show?"};
  ComparisonFamily family{.kind = ComparisonFamily::Kind::kPrimary};
  std::vector<double> p_values;
  for (const auto& hypothesis : hypotheses) {
    const auto values = std::find_if(outcomes.begin(), outcomes.end(),
                                     [&](const auto& outcome) { return outcome.first == hypothesis.response; });
    const auto model = team_model(teams, rows, hypothesis.response, values->second);
    const auto formula = formula_text(model);
    if (finding.model.find(formula) == std::string::npos)
      finding.model += (finding.model.empty() ? "" : "; ") + formula;
    auto& result = family.comparisons.emplace_back(
        ComparisonResult{.name = std::string{outcome_named(hypothesis.response).name} + ": " + hypothesis.name,
                         .response = hypothesis.response});
    const auto fit = effects_of(model, options.alpha);
    if (!fit) {
      finding.warnings.push_back(
          fmt::format("{}: {} cannot be tested: {}", hypothesis.response, hypothesis.name, fit.reason()));
      continue;
    }
    if (!model.groups.empty())
      add_method(finding, {"linear mixed model (REML) with Satterthwaite's degrees of freedom", "kuznetsova2017"});
    const auto estimate = contrast_estimate(*fit, hypothesis, 1.0 - options.alpha);
    result.estimate = estimate.estimate;
    if (!estimate.inference) {
      finding.warnings.push_back(fmt::format("{}: {} cannot be tested: {}", hypothesis.response, hypothesis.name,
                                             estimate.inference.reason()));
      continue;
    }
    const auto& inference = *estimate.inference;
    result.low = inference.low;
    result.high = inference.high;
    result.t = inference.statistic;
    if (std::isfinite(inference.df)) result.df = inference.df;
    result.p = inference.p;
    p_values.push_back(inference.p);
  }
  constexpr auto kNumber = ResultKind::kNumber;
  const auto corrected = adjust(p_values, Correction::kHolm);
  std::string found;
  std::size_t next = 0, shown_to_differ = 0;
  for (auto& comparison : family.comparisons) {
    if (!comparison.p) {
      found += fmt::format(" {}: cannot be tested.", comparison.name);
      continue;
    }
    const double p = corrected[next++];
    comparison.corrected_p = p;
    shown_to_differ += p < options.alpha ? 1 : 0;
    found += fmt::format(" {}: {} [{}, {}], {}{}: {}.", comparison.name, formatted(*comparison.estimate, kNumber),
                         formatted(*comparison.low, kNumber), formatted(*comparison.high, kNumber),
                         is_family ? "corrected " : "", p_text(p),
                         p < options.alpha ? "there is a difference" : "no difference was found");
  }
  finding.sentence = fmt::format("{} of {} planned as {} of the study ({} teams) {} found{}.{}", shown_to_differ,
                                 counted(hypotheses.size(), "difference"), is_family ? "hypotheses" : "the hypothesis",
                                 rows.size(), shown_to_differ == 1 ? "was" : "were", how, found);
  add_method(finding, {"planned contrasts of estimated marginal means" + how});
  finding.tables.push_back(shown<ComparisonResult>(
      "Planned contrasts that are the hypotheses of the study" + how, family.comparisons,
      {show(&ComparisonResult::name, "contrast", ResultKind::kText), show(&ComparisonResult::estimate, "difference"),
       show(&ComparisonResult::low, "lower limit"), show(&ComparisonResult::high, "upper limit"),
       show(&ComparisonResult::t, "t"), show(&ComparisonResult::df, "df"),
       show(&ComparisonResult::p, "p-value", ResultKind::kP),
       show(&ComparisonResult::corrected_p, "corrected p-value", ResultKind::kP)}));
  finding.comparisons.push_back(std::move(family));
  return finding;
}

}  // namespace kith
