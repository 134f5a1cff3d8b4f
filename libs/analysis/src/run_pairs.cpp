#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kith/stats/moments.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// The same people under every group strategy: one row of values per block.
struct Blocks {
  std::vector<std::string> strategies;
  std::vector<std::string> compositions;                   // per block
  std::vector<std::vector<std::optional<double>>> values;  // shape [blocks][strategies]
};

Blocks blocks_of(const RunTeams& teams, const std::vector<double>& values) {
  const auto rows = group_teams(teams);
  const auto strategy = selected(teams.strategy, rows);
  Blocks blocks{strategy.levels, {}, {}};
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = rows[i];
    const auto [entry, is_new] = known.emplace(teams.setting[row] + teams.seed_address[row], known.size());
    if (is_new) {
      blocks.values.emplace_back(strategy.levels.size());
      blocks.compositions.push_back(teams.composition.levels[teams.composition.codes[row]]);
    }
    blocks.values[entry->second][strategy.codes[i]] = values[row];
  }
  return blocks;
}

struct Pair {
  std::string name;
  std::size_t n = 0;
  Estimable<MeanDifference> difference;
  std::optional<double> d_z = {};  // mean over standard deviation of the differences
};

Pair compare(const Blocks& blocks, std::size_t a, std::size_t b, double confidence) {
  std::vector<double> first, second;
  for (const auto& block : blocks.values) {
    if (!block[a] || !block[b]) continue;
    first.push_back(*block[a]);
    second.push_back(*block[b]);
  }
  Pair pair{blocks.strategies[a] + " - " + blocks.strategies[b], first.size(),
            paired_t_test(first, second, confidence)};
  if (pair.difference) {
    const double spread = pair.difference->standard_error * std::sqrt(static_cast<double>(first.size()));
    pair.d_z = pair.difference->difference / spread;
  }
  return pair;
}

// Strategy and its interaction with composition, with differences between people taken out.
void add_blocked(const Blocks& blocks, Finding& finding) {
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
  const auto table = blocked_anova(values, make_factor("strategy", strategy), make_factor("composition", composition),
                                   make_factor("people", block));
  if (!table) {
    finding.warnings.push_back("analysis within people: not estimable, because " + table.reason());
    return;
  }
  ResultTable result{"Analysis of variance within people",
                     {{"term", Kind::kText},
                      {"df", Kind::kText},
                      {"F", Kind::kNumber},
                      {"p", Kind::kP},
                      {"partial eta squared", Kind::kFraction}},
                     {}};
  for (const auto& term : table->terms) {
    result.rows.push_back({text_cell(term.name), text_cell(fmt::format("{}, {}", term.df, table->residual_df)),
                           cell_of(term.test, &TestResult::statistic), cell_of(term.test, &TestResult::p),
                           cell_of(term.partial_eta_squared)});
    if (term.test) finding.sentence += fmt::format(" {}: {}.", term.name, test_text(*term.test));
  }
  finding.tables.push_back(std::move(result));
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
  Finding finding{.id = response + "-paired",
                  .title = "The same people under different strategies: " + response,
                  .question = "Which strategy is better for " + response + " of the same group of people?",
                  .model = response + " ~ strategy within people"};
  std::vector<Pair> pairs;
  std::vector<double> p_values;
  for (std::size_t a = 0; a < blocks.strategies.size(); ++a) {
    for (std::size_t b = a + 1; b < blocks.strategies.size(); ++b) {
      auto pair = compare(blocks, a, b, 1.0 - options.alpha);
      if (pair.difference) {
        p_values.push_back(pair.difference->test.p);
      } else {
        finding.warnings.push_back(pair.name + ": not estimable, because " + pair.difference.reason());
      }
      pairs.push_back(std::move(pair));
    }
  }
  const auto corrected = adjust(p_values, Correction::kHolm);
  ResultTable table{"Differences within groups of the same people (paired t, Holm)",
                    {{"pair", Kind::kText},
                     {"n", Kind::kCount},
                     {"difference", Kind::kNumber},
                     {"low", Kind::kNumber},
                     {"high", Kind::kNumber},
                     {"d", Kind::kFraction},
                     {"p", Kind::kP},
                     {"p, corrected", Kind::kP}},
                    {}};
  std::string found;
  std::size_t tested = 0;
  for (const auto& [name, n, difference, d_z] : pairs) {
    auto& row = table.rows.emplace_back(table.columns.size());
    row[0] = text_cell(name);
    row[1] = count_cell(n);
    if (!difference) continue;
    const double p = corrected[tested++];
    row[2] = difference->difference;
    row[3] = difference->low;
    row[4] = difference->high;
    row[5] = *d_z;
    row[6] = difference->test.p;
    row[7] = p;
    if (p < options.alpha)
      found += fmt::format("{}{} {} ({})", found.empty() ? "" : ", ", name,
                           formatted(difference->difference, Kind::kNumber), p_text(p));
  }
  finding.sentence = fmt::format(
      "Every strategy taught the same {} groups of simulated people, so differences are taken within "
      "groups: {}.",
      blocks.values.size(), found.empty() ? "no pair of strategies differs" : found);
  finding.tables.push_back(std::move(table));
  add_blocked(blocks, finding);
  return finding;
}

std::optional<Finding> against_baseline(const RunTeams& teams, const std::string& response,
                                        const std::vector<double>& values, const AnalysisOptions& options) {
  std::vector<double> group, alone;
  for (std::size_t i = 0; i < teams.size(); ++i) (teams.is_baseline(i) ? alone : group).push_back(values[i]);
  if (group.empty() || alone.empty()) return std::nullopt;
  Finding finding{.id = response + "-baseline",
                  .title = "Groups against teaching everybody alone: " + response,
                  .question = "Does teaching people together change " + response + "?",
                  .model = response + " ~ together or alone"};
  const auto test = welch_t_test(group, alone, 1.0 - options.alpha);
  const auto size = bootstrap_hedges_g(group, alone, {options.resamples, 1.0 - options.alpha},
                                       RandomStream{options.seed}.split(finding.id));
  ResultTable table{"Group strategies against the baseline (Welch)",
                    {{"comparison", Kind::kText},
                     {"difference", Kind::kNumber},
                     {"low", Kind::kNumber},
                     {"high", Kind::kNumber},
                     {"t", Kind::kNumber},
                     {"p", Kind::kP},
                     {"Hedges' g", Kind::kNumber},
                     {"g, low", Kind::kNumber},
                     {"g, high", Kind::kNumber}},
                    {}};
  std::vector<TableCell> row(table.columns.size());
  row[0] = text_cell("groups - alone");
  if (test) {
    row[1] = test->difference;
    row[2] = test->low;
    row[3] = test->high;
    row[4] = test->test.statistic;
    row[5] = test->test.p;
  } else {
    finding.warnings.push_back("not estimable, because " + test.reason());
  }
  if (size) {
    row[6] = size->estimate;
    row[7] = size->low;
    row[8] = size->high;
  }
  table.rows.push_back(std::move(row));
  const auto mean_text = [](const std::vector<double>& sample) { return formatted(mean(sample), Kind::kNumber); };
  finding.sentence = fmt::format(
      "{} groups that were taught together came to {} {} on average, {} groups whose members were taught one after "
      "the other to {}",
      group.size(), mean_text(group), response, alone.size(), mean_text(alone));
  if (test) {
    finding.sentence += fmt::format(
        "; {} ({}{}).", test->test.p < options.alpha ? "they differ" : "no difference was found", test_text(test->test),
        size ? fmt::format(", Hedges' g {:.2f} [{:.2f}, {:.2f}]", size->estimate, size->low, size->high) : "");
  } else {
    finding.sentence += ".";
  }
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
