#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/analysis/team_difference.hpp"
#include "kith/files/column_names.hpp"
#include "run_findings.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// The same people under every group strategy: one row of values per block.
struct TeamBlocks {
  std::vector<std::string> strategies;
  std::vector<std::string> compositions;                   // per block
  std::vector<std::vector<std::optional<double>>> values;  // shape [blocks][strategies]
};

TeamBlocks blocks_of(const RunTeams& teams, const std::vector<double>& values) {
  const auto rows = group_teams(teams);
  const auto strategy = selected(teams.strategy, rows);
  TeamBlocks blocks{strategy.levels, {}, {}};
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = rows[i];
    const auto [entry, is_new] = known.emplace(teams.people(row), known.size());
    if (is_new) {
      blocks.values.emplace_back(strategy.levels.size());
      blocks.compositions.push_back(teams.composition.levels[teams.composition.codes[row]]);
    }
    blocks.values[entry->second][strategy.codes[i]] = values[row];
  }
  return blocks;
}

// Differences of pairs; standardised by their own standard deviation.
ComparisonResult paired_comparison(const std::string& name, std::size_t n, const Estimable<MeanDifference>& difference,
                                   double confidence) {
  ComparisonResult result{.name = name, .n = n};
  if (!difference) return result;
  const auto& test = difference->test;
  const auto d =
      standardized_interval(test.statistic, test.df.front(), 1.0 / std::sqrt(static_cast<double>(n)), confidence);
  result.estimate = difference->difference;
  result.low = difference->low;
  result.high = difference->high;
  result.d = d.estimate;
  result.d_low = d.low;
  result.d_high = d.high;
  result.t = test.statistic;
  result.df = test.df.front();
  result.p = test.p;
  return result;
}

// Everything up to the tests.
std::vector<ShownColumn<ComparisonResult>> paired_columns(const std::string& first) {
  return {show(&ComparisonResult::name, first, Kind::kText),
          show(&ComparisonResult::n, "n", Kind::kCount),
          show(&ComparisonResult::estimate, "difference"),
          show(&ComparisonResult::low, "lower limit"),
          show(&ComparisonResult::high, "upper limit"),
          show(&ComparisonResult::d, "d", Kind::kFraction),
          show(&ComparisonResult::d_low, "d, lower limit", Kind::kFraction),
          show(&ComparisonResult::d_high, "d, upper limit", Kind::kFraction)};
}

ComparisonResult compare(const TeamBlocks& blocks, std::size_t a, std::size_t b, double confidence, Finding& finding) {
  std::vector<double> first, second;
  for (const auto& block : blocks.values) {
    if (!block[a] || !block[b]) continue;
    first.push_back(*block[a]);
    second.push_back(*block[b]);
  }
  const auto name = blocks.strategies[a] + " - " + blocks.strategies[b];
  const auto difference = paired_t_test(first, second, confidence);
  if (!difference) finding.warnings.push_back(name + ": no test: " + difference.reason());
  return paired_comparison(name, first.size(), difference, confidence);
}

// The same tests with corrected degrees of freedom, and whether they need that.
void add_sphericity(const AnovaTable& table, const Sphericity& sphericity, double alpha, Finding& finding) {
  ResultTable corrected{"Corrections for sphericity",
                        {{"term", Kind::kText},
                         {"p-value, Greenhouse-Geisser", Kind::kP},
                         {"p-value, Huynh-Feldt", Kind::kP},
                         {"epsilon, Greenhouse-Geisser", Kind::kFraction},
                         {"epsilon, Huynh-Feldt", Kind::kFraction},
                         {"Mauchly's W", Kind::kFraction},
                         {"p-value, Mauchly", Kind::kP}},
                        {}};
  for (const auto& term : table.terms) {
    auto& row = corrected.rows.emplace_back();
    row.push_back(text_cell(term.name));
    for (const double epsilon : {sphericity.greenhouse_geisser, sphericity.huynh_feldt}) {
      auto& cell = row.emplace_back();
      if (term.test) cell = correct_for_sphericity(*term.test, epsilon).p;
    }
    row.insert(row.end(), {sphericity.greenhouse_geisser, sphericity.huynh_feldt, sphericity.mauchly_w,
                           cell_of(sphericity.mauchly, &TestResult::p)});
  }
  for (const auto& term : table.terms) {
    if (!term.test) continue;
    const double p = correct_for_sphericity(*term.test, sphericity.greenhouse_geisser).p;
    if ((p < alpha) != (term.test->p < alpha))
      finding.warnings.push_back(fmt::format(
          "{}: the test that does not assume sphericity disagrees (Greenhouse-Geisser {}, uncorrected {}); prefer it",
          term.name, p_text(p), p_text(term.test->p)));
  }
  finding.tables.push_back(std::move(corrected));
  add_method(finding, {"Greenhouse-Geisser and Huynh-Feldt corrections", "greenhouse1959"});
}

// Strategy and its interaction with composition, with differences between people taken out.
void add_blocked(const TeamBlocks& blocks, double alpha, Finding& finding) {
  std::vector<double> values;
  std::vector<std::string> strategy, composition, block;
  for (std::size_t b = 0; b < blocks.values.size(); ++b) {
    for (std::size_t s = 0; s < blocks.strategies.size(); ++s) {
      if (!blocks.values[b][s]) continue;
      values.push_back(*blocks.values[b][s]);
      strategy.push_back(blocks.strategies[s]);
      composition.push_back(blocks.compositions[b]);
      block.push_back(std::to_string(b));
    }
  }
  const auto within = make_factor(columns::kStrategy, strategy),
             between = make_factor(columns::kComposition, composition), people = make_factor("people", block);
  const auto table = blocked_anova(values, within, between, people);
  if (!table) {
    finding.warnings.push_back("no analysis of variance within people: " + table.reason());
    return;
  }
  TestFamily family;
  for (const auto& term : table->terms) {
    auto& test = family.tests.emplace_back(
        with_effect(term_result(term.name, term.df, term.test), eta_squared_of(term.test, alpha)));
    test.residual_df = static_cast<double>(table->residual_df);
    test.effect = known(term.partial_eta_squared);
  }
  const auto degrees = [residuals = family.residuals](const TermResult& test) {
    return text_cell(degrees_text(test, residuals));
  };
  add_method(finding, {"analysis of variance within people"});
  add_method(finding, eta_squared_method(alpha));
  finding.tables.push_back(shown("Analysis of variance within people", family.tests,
                                 with_effect_columns({show(&TermResult::subject, "term", Kind::kText),
                                                      {{"df", Kind::kText}, degrees},
                                                      show(&TermResult::statistic, "F"),
                                                      show(&TermResult::p, "p-value", Kind::kP)})));
  finding.tests.push_back(std::move(family));
  if (const auto sphericity = check_sphericity(values, within, between, people); sphericity && within.levels.size() > 2)
    add_sphericity(*table, *sphericity, alpha, finding);
}

}  // namespace

std::optional<Finding> paired(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                              const AnalysisOptions& options) {
  const auto blocks = blocks_of(teams, values);
  if (blocks.strategies.size() < 2) return std::nullopt;
  const bool shared = std::any_of(blocks.values.begin(), blocks.values.end(), [](const auto& block) {
    return std::count_if(block.begin(), block.end(), [](const auto& value) { return value.has_value(); }) > 1;
  });
  if (!shared) return std::nullopt;
  const auto label = outcome_named(response).name;
  Finding finding{.id = response + "-paired",
                  .topic = "Same people, different strategies",
                  .response = std::string{label},
                  .question = fmt::format("Do strategies differ in {} when they teach the same people?", label),
                  .model = response + " ~ strategy within people"};
  ComparisonFamily family{.kind = ComparisonFamily::Kind::kSamePeople, .factor = columns::kStrategy};
  std::vector<double> p_values;
  for (std::size_t a = 0; a < blocks.strategies.size(); ++a) {
    for (std::size_t b = a + 1; b < blocks.strategies.size(); ++b) {
      const auto& pair = family.comparisons.emplace_back(compare(blocks, a, b, 1.0 - options.alpha, finding));
      if (pair.p) p_values.push_back(*pair.p);
    }
  }

  const auto corrected = adjust(p_values, Correction::kHolm);
  std::string found;
  std::size_t tested = 0;
  for (auto& pair : family.comparisons) {
    if (!pair.p) continue;
    pair.corrected_p = corrected[tested++];
    if (*pair.corrected_p < options.alpha)
      found += fmt::format("{}{} {} ({})", found.empty() ? "" : ", ", pair.name,
                           formatted(*pair.estimate, Kind::kNumber), p_text(*pair.corrected_p));
  }
  finding.sentence = fmt::format(
      "Every strategy taught the same {} of simulated people, so strategies are compared within groups: {}.",
      counted(blocks.values.size(), "group"),
      found.empty() ? "no difference between two strategies was found" : "these differ: " + found);
  if (tested > 0)
    add_method(finding, {fmt::format("paired t tests with Holm correction for {}", counted(tested, "pair"))});
  auto columns = paired_columns("pair");
  columns.push_back(show(&ComparisonResult::p, "p-value", Kind::kP));
  columns.push_back(show(&ComparisonResult::corrected_p, "corrected p-value", Kind::kP));
  finding.tables.push_back(shown("Differences within groups of the same people (paired t tests, Holm correction)",
                                 family.comparisons, columns));
  finding.comparisons.push_back(std::move(family));
  add_blocked(blocks, options.alpha, finding);
  return finding;
}

namespace {

// The interval of Hedges' g that belongs to Welch's test: it excludes 0 exactly if the test rejects.
std::optional<Interval> hedges_interval(const MeanDifference& difference, double g, double confidence) {
  const auto& test = difference.test;
  if (test.statistic == 0.0 || !std::isfinite(test.statistic)) return std::nullopt;
  return standardized_interval(test.statistic, test.df.front(), g / test.statistic, confidence);
}

// What the same people gain by being taught together.
void add_same_people(const TeamDifference& difference, const AnalysisOptions& options, Finding& finding) {
  const auto& test = difference.test;
  ComparisonFamily family{.kind = ComparisonFamily::Kind::kAlone};
  family.comparisons.push_back(paired_comparison("together - alone", difference.n, test, 1.0 - options.alpha));
  if (test) {
    finding.sentence += fmt::format(". Within {} of the same people {} ({}).", counted(difference.n, "group"),
                                    test->test.p < options.alpha
                                        ? "the mean difference is " + formatted(test->difference, Kind::kNumber)
                                        : "no difference was found",
                                    p_text(test->test.p));
    add_method(finding, {"a paired t test of the same people"});
  } else {
    finding.sentence += ".";
    finding.warnings.push_back("no paired test of the same people: " + test.reason());
  }

  auto columns = paired_columns("comparison");
  columns.push_back(show(&ComparisonResult::t, "t"));
  columns.push_back(show(&ComparisonResult::p, "p-value", Kind::kP));
  finding.tables.push_back(
      shown("The same people, taught together and alone (paired t test)", family.comparisons, columns));
  finding.comparisons.push_back(std::move(family));
}

void add_other_people(const std::vector<double>& group, const std::vector<double>& alone,
                      const AnalysisOptions& options, Finding& finding) {
  const auto test = welch_t_test(group, alone, 1.0 - options.alpha);
  ComparisonFamily family{.kind = ComparisonFamily::Kind::kAlone};
  auto& result = family.comparisons.emplace_back(ComparisonResult{.name = "together - alone"});
  if (test) {
    result.estimate = test->difference;
    result.low = test->low;
    result.high = test->high;
    result.t = test->test.statistic;
    result.df = test->test.df.front();
    result.p = test->test.p;
    finding.sentence += fmt::format(
        "; {} ({}).",
        test->test.p < options.alpha ? "the difference is statistically significant" : "no difference was found",
        p_text(test->test.p));
    add_method(finding, {"Welch's t test"});
  } else {
    finding.warnings.push_back("no Welch's t test: " + test.reason());
    finding.sentence += ".";
  }

  const auto size = hedges_g(group, alone);
  const auto interval = test && size ? hedges_interval(*test, *size, 1.0 - options.alpha) : std::nullopt;
  result.d = known(size);
  if (interval) {
    result.d_low = interval->low;
    result.d_high = interval->high;
  }
  finding.tables.push_back(shown<ComparisonResult>(
      "Group strategies and the baseline (Welch's t test)", family.comparisons,
      {show(&ComparisonResult::name, "comparison", Kind::kText), show(&ComparisonResult::estimate, "difference"),
       show(&ComparisonResult::low, "lower limit"), show(&ComparisonResult::high, "upper limit"),
       show(&ComparisonResult::t, "t"), show(&ComparisonResult::df, "df"),
       show(&ComparisonResult::p, "p-value", Kind::kP)}));
  if (size) {
    add_method(finding, {interval ? "Hedges' g with an interval from the non-central t distribution" : "Hedges' g",
                         "hedges1981"});
    finding.tables.push_back(shown<ComparisonResult>(
        "Effect size (Hedges' g)", family.comparisons,
        {show(&ComparisonResult::name, "comparison", Kind::kText), show(&ComparisonResult::d, "Hedges' g"),
         show(&ComparisonResult::d_low, "lower limit"), show(&ComparisonResult::d_high, "upper limit")}));
  }
  finding.comparisons.push_back(std::move(family));
}

}  // namespace

std::optional<Finding> against_baseline(const RunTeams& teams, const std::string& response,
                                        const std::vector<double>& values, const AnalysisOptions& options) {
  std::vector<double> group, alone;
  TeamValues together, apart;  // of the same people
  for (std::size_t i = 0; i < teams.size(); ++i) {
    (teams.is_baseline(i) ? alone : group).push_back(values[i]);
    (teams.is_baseline(i) ? apart : together)[{teams.people(i), 0}].push_back(values[i]);
  }
  if (group.empty() || alone.empty()) return std::nullopt;
  const auto& outcome = outcome_named(response);
  Finding finding{.id = response + "-baseline",
                  .topic = "Taught together or alone",
                  .response = std::string{outcome.name},
                  .question = response == columns::kPeriods
                                  ? "Does teaching together change how many periods are needed?"
                                  : fmt::format("Does teaching together change final {}?", outcome.name),
                  .model = response + " ~ taught together or alone"};
  finding.sentence = fmt::format(
      "Mean {} {} {} in {} taught together and {} in {} whose members were taught one after the other", outcome.name,
      outcome.is_plural ? "were" : "was", formatted(mean(group), Kind::kNumber), counted(group.size(), "group"),
      formatted(mean(alone), Kind::kNumber), counted(alone.size(), "group"));
  if (const auto same = difference_of_teams(together, apart, true, 1.0 - options.alpha); same.n > 0) {
    add_same_people(same, options, finding);
  } else {
    add_other_people(group, alone, options, finding);
  }
  return finding;
}

}  // namespace kith
