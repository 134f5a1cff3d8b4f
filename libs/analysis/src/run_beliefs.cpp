#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "kith/stats/moments.hpp"
#include "kith/stats/tests.hpp"
#include "model_means.hpp"
#include "run_findings.hpp"

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

// Mean over the strategies of either kind that taught the same people.
std::pair<std::vector<double>, std::vector<double>> same_people(const RunTeams& teams, const BeliefTeams& beliefs,
                                                                const std::vector<double>& values) {
  struct Sums {
    std::array<double, 2> sum{};
    std::array<std::size_t, 2> n{};
  };
  std::map<std::string, Sums> people;
  for (std::size_t i = 0; i < beliefs.rows.size(); ++i) {
    const auto row = beliefs.rows[i];
    auto& sums = people[teams.setting[row] + teams.seed_address[row]];
    sums.sum.at(beliefs.belief.codes[i]) += values[row];
    ++sums.n.at(beliefs.belief.codes[i]);
  }
  std::pair<std::vector<double>, std::vector<double>> pairs;
  for (const auto& [address, sums] : people) {
    if (sums.n[0] == 0 || sums.n[1] == 0) continue;
    pairs.first.push_back(sums.sum[0] / static_cast<double>(sums.n[0]));
    pairs.second.push_back(sums.sum[1] / static_cast<double>(sums.n[1]));
  }
  return pairs;
}

void add_same_people_beliefs(const RunTeams& teams, const BeliefTeams& beliefs, const std::vector<double>& values,
                             const AnalysisOptions& options, Finding& finding) {
  const auto [team, individual] = same_people(teams, beliefs, values);
  const auto test = paired_t_test(team, individual, 1.0 - options.alpha);
  if (!test) return;
  finding.tables.push_back({"The same people under team and individual beliefs (paired t test)",
                            {{"comparison", Kind::kText},
                             {"n", Kind::kCount},
                             {"difference"},
                             {"lower limit"},
                             {"upper limit"},
                             {"t"},
                             {"p-value", Kind::kP}},
                            {{text_cell("team - individual"), count_cell(team.size()), test->difference, test->low,
                              test->high, test->test.statistic, test->test.p}}});
  finding.sentence +=
      fmt::format(" Within {} of the same people the difference is {} [{}, {}], {}.",
                  number_and_noun(team.size(), "group"), formatted(test->difference, Kind::kNumber),
                  formatted(test->low, Kind::kNumber), formatted(test->high, Kind::kNumber), p_text(test->test.p));
  add_method(finding, {"a paired t test of the same people"});
}

// Does the difference depend on who is in the team?
void add_dependence(const BeliefTeams& beliefs, const Factor& composition, const std::vector<double>& values,
                    const AnalysisOptions& options, Finding& finding) {
  if (composition.levels.size() < 2) return;
  const std::vector<Factor> factors{beliefs.belief, composition};
  const std::vector<std::vector<std::size_t>> terms{{0}, {1}, {0, 1}};
  const auto table = anova(values, factors, terms, SumsOfSquares::kTypeII);
  const auto& test = table.terms.back().test;
  const auto eta_squared = eta_squared_of(test, options.alpha);
  finding.tables.push_back(
      {"Does the difference between beliefs depend on the composition?",
       {{"term", Kind::kText},
        {"df", Kind::kText},
        {"F"},
        {"p-value", Kind::kP},
        {"partial eta squared", Kind::kFraction},
        {"lower limit", Kind::kFraction},
        {"upper limit", Kind::kFraction}},
       {{text_cell("belief:composition"), text_cell(fmt::format("{}, {}", table.terms.back().df, table.residual_df)),
         cell_of(test, &TestResult::statistic), cell_of(test, &TestResult::p),
         cell_of(eta_squared, &Interval::estimate), cell_of(eta_squared, &Interval::low),
         cell_of(eta_squared, &Interval::high)}}});
  if (!test) return;
  finding.sentence +=
      test->p < options.alpha
          ? fmt::format(" The difference depends on the composition ({}).", p_text(test->p))
          : fmt::format(" No dependence of the difference on the composition was found ({}).", p_text(test->p));
}

}  // namespace

std::optional<Finding> beliefs(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                               const AnalysisOptions& options) {
  const auto found = belief_teams(teams);
  if (!found) return std::nullopt;
  const auto model = team_model(teams, found->rows, response, values);
  const auto fit = fit_linear_model(model.values, model.factors, model.terms);
  Finding finding{
      .id = response + "-beliefs",
      .title = "Team beliefs against individual beliefs: " + response,
      .question = fmt::format("Do demonstrations chosen for the team's belief ({}) lead to {} {} than those "
                              "chosen for one member's belief ({})?",
                              with_and(found->team), response == "periods" ? "fewer" : "more", response,
                              with_and(found->individual)),
      .model = formula_text(model)};
  finding.sentence = fmt::format("Planned contrast of {} ({} teams).", response, model.values.size());
  if (!fit) {
    finding.sentence += " It cannot be estimated: " + fit.reason() + ".";
    return finding;
  }
  auto planned = options;
  planned.contrasts = {difference_of_means("team beliefs - individual beliefs", found->team, found->individual)};
  planned.contrasts.front().factor = "strategy";
  planned.by.clear();
  const auto composition = selected(teams.composition, found->rows);
  if (composition.levels.size() > 1) planned.by = {"composition"};
  add_contrast_results(fit->effects, planned, finding, finding.tables);
  add_dependence(*found, composition, model.values, options, finding);
  add_same_people_beliefs(teams, *found, values, options, finding);
  return finding;
}

std::optional<Finding> variation(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                                 const AnalysisOptions& options) {
  const auto found = belief_teams(teams);
  if (!found || response != "periods") return std::nullopt;
  Finding finding{.id = response + "-variation",
                  .title = "Variation of " + response + " under team and individual beliefs",
                  .question =
                      "Does the number of periods vary less between teams if demonstrations are chosen for the "
                      "team's belief?",
                  .model = "variance of " + response + " ~ team or individual beliefs"};
  const auto composition = selected(teams.composition, found->rows);
  const auto part = selected(values, found->rows);
  ResultTable table{"Variance under team beliefs over that under individual beliefs",
                    {{"composition", Kind::kText},
                     {"n, team", Kind::kCount},
                     {"sd, team"},
                     {"n, individual", Kind::kCount},
                     {"sd, individual"},
                     {"variance ratio", Kind::kFraction},
                     {"lower limit", Kind::kFraction},
                     {"upper limit", Kind::kFraction},
                     {"p-value, F", Kind::kP},
                     {"p-value, Brown-Forsythe", Kind::kP}},
                    {}};
  // Rows whose code is `level`; all of them for the number of levels.
  const auto add = [&](const std::string& name, std::size_t level) -> Estimable<VarianceRatio> {
    std::vector<double> team, individual, both;
    Factor belief{"belief", found->belief.levels, {}};
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (level < composition.levels.size() && composition.codes[i] != level) continue;
      (found->belief.codes[i] == 0 ? team : individual).push_back(part[i]);
      both.push_back(part[i]);
      belief.codes.push_back(found->belief.codes[i]);
    }
    auto ratio = variance_ratio(team, individual, 1.0 - options.alpha);
    const auto robust = brown_forsythe(both, belief);
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
    return ratio;
  };
  const auto overall = add("all", composition.levels.size());
  const auto robust = std::get_if<double>(&table.rows.front().back());
  finding.sentence = fmt::format("Standard deviations of {} over {} teams of all compositions.", response, part.size());
  if (overall) {
    finding.sentence = fmt::format(
        "The variance of {} under team beliefs is {:.2f} [{:.2f}, {:.2f}] times that under individual beliefs ({} "
        "teams of "
        "all compositions): {}.",
        response, overall->ratio.estimate, overall->ratio.low, overall->ratio.high, part.size(),
        overall->test.p >= options.alpha ? "no difference was found (" + p_text(overall->test.p) + ")"
        : overall->ratio.estimate < 1.0  ? "they make it vary less (" + p_text(overall->test.p) + ")"
                                         : "they make it vary more (" + p_text(overall->test.p) + ")");
    if (robust != nullptr && (*robust < options.alpha) != (overall->test.p < options.alpha))
      finding.warnings.push_back(
          fmt::format("the F test assumes normal values, and the Brown-Forsythe test, which does not, disagrees ({})",
                      p_text(*robust)));
  }
  if (composition.levels.size() > 1) {
    for (std::size_t level = 0; level < composition.levels.size(); ++level) (void)add(composition.levels[level], level);
  }
  add_method(finding, {"F tests of variance ratios"});
  add_method(finding, {"Brown-Forsythe tests of equal variances"});
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
