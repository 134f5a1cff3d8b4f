#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_means.hpp"
#include "outcomes.hpp"
#include "run_findings.hpp"

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

std::optional<Finding> primary(const RunTeams& teams, const std::vector<PlannedContrast>& contrasts,
                               const AnalysisOptions& options) {
  auto hypotheses = by_response(teams, contrasts);
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), [](const auto& one) { return !one.primary; }),
                   hypotheses.end());
  if (hypotheses.empty()) return std::nullopt;
  const auto rows = group_teams(teams);
  const bool is_family = hypotheses.size() > 1;
  const std::string how =
      is_family ? fmt::format(" (Holm correction for {} hypotheses)", hypotheses.size()) : std::string{};
  Finding finding{.id = "primary",
                  .title = hypotheses.size() == 1 ? "Primary hypothesis" : "Primary hypotheses",
                  .question = hypotheses.size() == 1 ? "Is there the difference that the study was planned to show?"
                                                     : "Are there the differences that the study was planned to show?"};
  ResultTable table{"Planned contrasts that are the hypotheses of the study" + how,
                    {{"contrast", ResultKind::kText},
                     {"difference"},
                     {"lower limit"},
                     {"upper limit"},
                     {"t"},
                     {"df"},
                     {"p-value", ResultKind::kP},
                     {"corrected p-value", ResultKind::kP}},
                    {}};
  std::vector<double> p_values;
  for (const auto& one : hypotheses) {
    const auto outcomes = outcomes_of(teams);
    const auto values = std::find_if(outcomes.begin(), outcomes.end(),
                                     [&](const auto& outcome) { return outcome.first == one.response; });
    const auto model = team_model(teams, rows, one.response, *values->second);
    const auto formula = formula_text(model);
    if (finding.model.find(formula) == std::string::npos)
      finding.model += (finding.model.empty() ? "" : "; ") + formula;
    auto& row = table.rows.emplace_back(table.columns.size());
    row[0] = text_cell(one.response + ": " + one.name);
    const auto fit = effects_of(model, options.alpha);
    if (!fit) {
      finding.warnings.push_back(fmt::format("{}: {} cannot be tested: {}", one.response, one.name, fit.reason()));
      continue;
    }
    if (!model.groups.empty())
      add_method(finding, {"linear mixed model (REML) with Satterthwaite's degrees of freedom", "kuznetsova2017"});
    const auto estimate = contrast_estimate(*fit, one, 1.0 - options.alpha);
    row[1] = cell_of(estimate.estimate);
    if (!estimate.inference) {
      finding.warnings.push_back(
          fmt::format("{}: {} cannot be tested: {}", one.response, one.name, estimate.inference.reason()));
      continue;
    }
    const auto& inference = *estimate.inference;
    row[2] = inference.low;
    row[3] = inference.high;
    row[4] = inference.statistic;
    if (std::isfinite(inference.df)) row[5] = inference.df;
    row[6] = inference.p;
    p_values.push_back(inference.p);
  }
  const auto corrected = adjust(p_values, Correction::kHolm);
  std::string found;
  std::size_t next = 0, shown = 0;
  for (auto& row : table.rows) {
    const auto& name = std::get<std::string>(row[0]);
    if (std::holds_alternative<std::monostate>(row[6])) {
      found += fmt::format(" {}: cannot be tested.", name);
      continue;
    }
    const double p = corrected[next++];
    row[7] = p;
    shown += p < options.alpha ? 1 : 0;
    found += fmt::format(" {}: {} [{}, {}], {}{}: {}.", name, formatted(row[1], ResultKind::kNumber),
                         formatted(row[2], ResultKind::kNumber), formatted(row[3], ResultKind::kNumber),
                         is_family ? "corrected " : "", p_text(p),
                         p < options.alpha ? "there is a difference" : "no difference was found");
  }
  finding.sentence =
      fmt::format("{} of {} planned as {} of the study ({} teams) {} found{}.{}", shown,
                  number_and_noun(hypotheses.size(), "difference"), is_family ? "hypotheses" : "the hypothesis",
                  rows.size(), shown == 1 ? "was" : "were", how, found);
  add_method(finding, {"planned contrasts of estimated marginal means" + how});
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
