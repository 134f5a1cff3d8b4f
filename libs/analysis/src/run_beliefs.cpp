#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "kith/analysis/clustered_tests.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/analysis/nested_model.hpp"
#include "kith/files/column_names.hpp"
#include "model_means.hpp"
#include "run_findings.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// The paper's strategies by whose belief they choose demonstrations for [jayaraman2024, section IV].
constexpr std::array<const char*, 2> kTeamBeliefs{"common", "joint"};
constexpr std::array<const char*, 2> kIndividualBeliefs{"individual-low", "individual-high"};

template <std::size_t n>
std::vector<std::string> present(const Factor& strategy, const std::array<const char*, n>& names) {
  std::vector<std::string> found;
  for (const auto* name : names) {
    if (std::find(strategy.levels.begin(), strategy.levels.end(), name) != strategy.levels.end())
      found.emplace_back(name);
  }
  return found;
}

// The teams of strategies that are about beliefs, and whose beliefs.
struct BeliefTeams {
  std::vector<std::size_t> rows;  // in RunTeams
  Factor belief;                  // "team" and "individual"
  std::vector<std::string> team, individual;
};

std::optional<BeliefTeams> belief_teams(const RunTeams& teams) {
  BeliefTeams found;
  found.team = present(teams.strategy, kTeamBeliefs);
  found.individual = present(teams.strategy, kIndividualBeliefs);
  if (found.team.empty() || found.individual.empty()) return std::nullopt;
  found.belief = {"belief", {"team", "individual"}, {}};
  for (std::size_t i = 0; i < teams.size(); ++i) {
    const auto& name = teams.strategy.levels[teams.strategy.codes[i]];
    const bool is_team = std::find(found.team.begin(), found.team.end(), name) != found.team.end();
    const bool is_individual =
        std::find(found.individual.begin(), found.individual.end(), name) != found.individual.end();
    if (!is_team && !is_individual) continue;
    found.rows.push_back(i);
    found.belief.codes.push_back(is_team ? 0 : 1);
  }
  return found;
}

// What the same people differ by under team and individual beliefs (means over the strategies of either kind), and
// their composition.
struct PeopleDifferences {
  std::vector<double> values;
  Factor composition;
};

PeopleDifferences differences_of_people(const RunTeams& teams, const BeliefTeams& beliefs,
                                        const std::vector<double>& values) {
  std::map<std::pair<std::size_t, std::string>, std::array<std::vector<double>, 2>> people;  // and their composition
  for (std::size_t i = 0; i < beliefs.rows.size(); ++i) {
    const auto row = beliefs.rows[i];
    people[{teams.composition.codes[row], teams.people(row)}].at(beliefs.belief.codes[i]).push_back(values[row]);
  }
  PeopleDifferences differences{{}, {columns::kComposition, teams.composition.levels, {}}};
  for (const auto& [who, both] : people) {
    if (both[0].empty() || both[1].empty()) continue;
    differences.values.push_back(mean(both[0]) - mean(both[1]));
    differences.composition.codes.push_back(who.first);
  }
  differences.composition = drop_unused(differences.composition);
  return differences;
}

// Does the difference depend on who is in the team?
Estimable<TestResult> test_dependence(const BeliefTeams& beliefs, const Factor& composition,
                                      const std::vector<double>& values) {
  const std::vector<Factor> factors{beliefs.belief, composition};
  const std::vector<std::vector<std::size_t>> terms{{0}, {1}, {0, 1}};
  return anova(values, factors, terms).terms.back().test;
}

void add_dependence(const Estimable<TestResult>& test, const AnalysisOptions& options, Finding& finding) {
  TestFamily family;
  const auto df = test ? static_cast<std::size_t>(test->df.front()) : 0;
  family.tests.push_back(with_effect(term_result("belief:composition", df, test), eta_squared_of(test, options.alpha)));
  const auto degrees = [residuals = family.residuals](const TermResult& one) {
    return text_cell(one.statistic ? degrees_text(one, residuals) : "");
  };
  finding.tables.push_back(shown("Does the difference between beliefs depend on the composition?", family.tests,
                                 with_effect_columns({show(&TermResult::subject, "term", Kind::kText),
                                                      {{"df", Kind::kText}, degrees},
                                                      show(&TermResult::statistic, "F"),
                                                      show(&TermResult::p, "p-value", Kind::kP)})));
  finding.tests.push_back(std::move(family));
  if (!test) return;
  finding.sentence +=
      test->p < options.alpha
          ? fmt::format(" The difference depends on the composition ({}).", p_text(test->p))
          : fmt::format(" No dependence of the difference on the composition was found ({}).", p_text(test->p));
}

}  // namespace

Estimable<FixedEffects> effects_of(const ModelData& model, double alpha) {
  using Result = Estimable<FixedEffects>;
  if (model.groups.empty()) return anova(model.values, model.factors, model.terms).effects;
  const auto fit = fit_nested_model(model.values, model.factors, model.terms, model.groups, 1.0 - alpha);
  return fit ? Result{fit->fixed} : Result::impossible(fit.reason());
}

std::optional<Finding> beliefs(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                               const AnalysisOptions& options) {
  const auto found = belief_teams(teams);
  if (!found) return std::nullopt;
  const auto model = team_model(teams, found->rows, response, values);
  const auto fit = effects_of(model, options.alpha);
  const auto& outcome = outcome_named(response);
  Finding finding{.id = response + "-beliefs",
                  .topic = "Team beliefs against individual beliefs",
                  .response = std::string{outcome.name},
                  .question = fmt::format("Do demonstrations chosen for the team's belief ({}) lead to {} than those "
                                          "chosen for one member's belief ({})?",
                                          listed(found->team), outcome.better, listed(found->individual)),
                  .model = formula_text(model)};
  finding.sentence =
      fmt::format("Planned contrast of {} ({} teams{}).", outcome.name, model.values.size(),
                  model.groups.empty() ? std::string{}
                                       : " of " + counted(model.groups.front().levels.size(), "group") + " of people");
  if (!fit) {
    finding.sentence += " It cannot be estimated: " + fit.reason() + ".";
    return finding;
  }
  auto planned = options;
  planned.contrasts = {difference_of_means("team beliefs - individual beliefs", found->team, found->individual)};
  planned.contrasts.front().factor = columns::kStrategy;
  planned.by.clear();
  const auto composition = selected(teams.composition, found->rows);
  if (composition.levels.size() > 1) planned.by = {columns::kComposition};
  add_contrast_results(*fit, planned, finding, finding.tables);
  if (!model.groups.empty())
    add_method(finding, {"linear mixed model (REML) with Satterthwaite's degrees of freedom", "kuznetsova2017"});
  if (composition.levels.size() < 2) return finding;
  if (model.groups.empty()) {
    add_dependence(test_dependence(*found, composition, model.values), options, finding);
  } else {
    const auto differences = differences_of_people(teams, *found, values);
    if (differences.values.empty()) return finding;
    add_dependence(one_way_anova(differences.values, differences.composition), options, finding);
    add_method(finding, {"analysis of variance of differences within people between compositions"});
  }
  return finding;
}

std::optional<Finding> variation(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                                 const AnalysisOptions& options) {
  const auto found = belief_teams(teams);
  if (!found) return std::nullopt;
  const auto label = outcome_named(response).name;
  Finding finding{.id = response + "-variation",
                  .topic = fmt::format("Variation of {} under team and individual beliefs", label),
                  .question = response == columns::kPeriods
                                  ? "Does the number of periods vary less between teams if demonstrations are chosen "
                                    "for the team's belief?"
                                  : fmt::format("Does {} vary less between teams if demonstrations are chosen for "
                                                "one member's belief?",
                                                label),
                  .model = "variance of " + response + " ~ team or individual beliefs"};
  const auto composition = selected(teams.composition, found->rows);
  const auto part = selected(values, found->rows);
  const auto people = shared_people(teams, found->rows);
  const bool is_clustered = !people.empty();
  ResultTable table{"Variance under team beliefs over that under individual beliefs",
                    {{columns::kComposition, Kind::kText},
                     {"n, team", Kind::kCount},
                     {"sd, team"},
                     {"n, individual", Kind::kCount},
                     {"sd, individual"},
                     {"variance ratio", Kind::kFraction},
                     {"lower limit", Kind::kFraction},
                     {"upper limit", Kind::kFraction},
                     {is_clustered ? "p-value, jackknife" : "p-value, F", Kind::kP},
                     {"p-value, Brown-Forsythe", Kind::kP}},
                    {}};
  // Rows whose code is `level`; all of them for the number of levels.
  const auto add = [&](const std::string& name, std::size_t level) {
    std::vector<double> team, individual, both;
    Factor belief{"belief", found->belief.levels, {}};
    Factor cluster{"people", is_clustered ? people.front().levels : std::vector<std::string>{}, {}};
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (level < composition.levels.size() && composition.codes[i] != level) continue;
      (found->belief.codes[i] == 0 ? team : individual).push_back(part[i]);
      both.push_back(part[i]);
      belief.codes.push_back(found->belief.codes[i]);
      if (is_clustered) cluster.codes.push_back(people.front().codes[i]);
    }
    auto ratio = is_clustered ? clustered_variance_ratio(both, belief, cluster, 1.0 - options.alpha)
                              : variance_ratio(team, individual, 1.0 - options.alpha);
    const auto robust = is_clustered ? clustered_brown_forsythe(both, belief, cluster) : brown_forsythe(both, belief);
    const auto sd = [](const std::vector<double>& some) {
      TableCell cell;
      if (const auto value = standard_deviation(some)) cell = *value;
      return cell;
    };
    auto& row = table.rows.emplace_back();
    row = {text_cell(name), count_cell(team.size()), sd(team), count_cell(individual.size()), sd(individual)};
    if (ratio) {
      row.insert(row.end(), {ratio->ratio.estimate, ratio->ratio.low, ratio->ratio.high, ratio->test.p});
    } else {
      row.resize(row.size() + 4);
      finding.warnings.push_back(name + ": no variance ratio: " + ratio.reason());
    }
    row.push_back(cell_of(robust, &TestResult::p));
    return std::pair{ratio, robust};
  };
  const auto [overall, robust] = add("all", composition.levels.size());
  finding.sentence = fmt::format("Standard deviations of {} over {} teams of all compositions.", label, part.size());
  if (overall) {
    finding.sentence = fmt::format(
        "The variance of {} under team beliefs is {:.2f} [{:.2f}, {:.2f}] times that under individual beliefs ({} "
        "teams of all compositions): {}.",
        label, overall->ratio.estimate, overall->ratio.low, overall->ratio.high, part.size(),
        overall->test.p >= options.alpha ? "no difference was found (" + p_text(overall->test.p) + ")"
        : overall->ratio.estimate < 1.0  ? "they make it vary less (" + p_text(overall->test.p) + ")"
                                         : "they make it vary more (" + p_text(overall->test.p) + ")");
    if (robust && (robust->p < options.alpha) != (overall->test.p < options.alpha))
      finding.warnings.push_back(
          is_clustered ? fmt::format("the Brown-Forsythe test of spread disagrees with that of variances ({})",
                                     p_text(robust->p))
                       : fmt::format("the F test assumes normal values, and the Brown-Forsythe test, which does not, "
                                     "disagrees ({})",
                                     p_text(robust->p)));
  }
  if (composition.levels.size() > 1) {
    for (std::size_t level = 0; level < composition.levels.size(); ++level) (void)add(composition.levels[level], level);
  }
  add_method(finding, {is_clustered ? "variance ratios with jackknife intervals that keep the same people together"
                                    : "F tests of variance ratios"});
  add_method(finding, {is_clustered ? "Brown-Forsythe tests of equal variances within people"
                                    : "Brown-Forsythe tests of equal variances"});
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
