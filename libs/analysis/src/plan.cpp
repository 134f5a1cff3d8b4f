#include "kith/analysis/plan.hpp"

#include <algorithm>
#include <stdexcept>

#include "kith/core/distributions.hpp"
#include "kith/files/column_names.hpp"
#include "model_means.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

constexpr std::size_t kReplicates = 12;  // enough for every analysis

RunTeams made_up_teams(const PlannedDesign& design) {
  RunTeams teams;
  teams.strategy = {columns::kStrategy, design.strategies, {}};
  teams.composition = {columns::kComposition, design.compositions, {}};
  RandomStream random{1};
  for (std::size_t s = 0; s < design.strategies.size(); ++s) {
    for (std::size_t c = 0; c < design.compositions.size(); ++c) {
      for (std::size_t r = 0; r < kReplicates; ++r) {
        const auto people = c * kReplicates + r, team = teams.size();
        teams.strategy.codes.push_back(s);
        teams.composition.codes.push_back(c);
        teams.setting.emplace_back();
        TeamRecord record;
        record.seed_address = std::to_string(design.same_people ? people : team);
        record.status = SessionStatus::kComplete;
        // Between 1 and 4, and so with less spread than Poisson's counts, as the periods of simulated teams have.
        record.periods = 1 + uniform_index(4, random);
        record.knowledge = uniform01(random);
        record.area_sr = uniform01(random);
        if (design.has_exam)
          record.exam = {
              .share_right = uniform01(random), .regret = uniform01(random), .worst_share_right = uniform01(random)};
        teams.records.push_back(std::move(record));
      }
    }
  }
  return teams;
}

}  // namespace

std::vector<PlannedContrast> primary_hypotheses(const PlannedDesign& design) {
  auto hypotheses = by_response(made_up_teams(design), design.contrasts);
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), [](const auto& one) { return !one.primary; }),
                   hypotheses.end());
  return hypotheses;
}

std::vector<PlannedAnalysis> planned_analyses(const PlannedDesign& design, const AnalysisOptions& options) {
  if (design.strategies.empty() || design.compositions.empty())
    throw std::invalid_argument{"planned_analyses: the design has no strategies or no compositions"};
  const auto teams = made_up_teams(design);
  const auto rows = group_teams(teams);

  std::vector<PlannedAnalysis> plan;
  const auto add = [&](const std::optional<Finding>& finding, const std::vector<PlannedContrast>& contrasts) {
    if (finding)
      plan.push_back({finding->id, finding->title(), finding->question, finding->model, finding->methods, contrasts});
  };

  const auto responses = outcomes_of(teams);
  if (!rows.empty()) {
    const auto factors = team_model(teams, rows, responses.front().first, responses.front().second).factors;
    std::vector<PlannedContrast> testable;
    for (const auto& contrast : design.contrasts) {
      if (is_testable(factors, contrast)) testable.push_back(contrast);
    }

    if (const auto finding = primary(teams, responses, testable, options)) add(finding, primary_hypotheses(design));
    for (const auto& [name, values] : responses) {
      auto planned = options;
      std::vector<PlannedContrast> contrasts;
      for (const auto& one : testable) {
        if (!one.primary && (one.response.empty() || one.response == name)) contrasts.push_back(one);
      }
      planned.contrasts.insert(planned.contrasts.end(), contrasts.begin(), contrasts.end());
      add(effects(teams, name, values, planned), contrasts);
    }

    for (const auto& [name, values] : responses) add(effects_within(teams, name, values, options), {});
    for (const auto& [name, values] : responses) add(beliefs(teams, name, values, options), {});
    for (const auto& [name, values] : responses) add(variation(teams, name, values, options), {});
    for (const auto& [name, values] : responses) add(paired(teams, name, values, options), {});
  }
  for (const auto& [name, values] : responses) add(against_baseline(teams, name, values, options), {});
  return plan;
}

}  // namespace kith
