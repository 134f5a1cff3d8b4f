#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kith/stats/moments.hpp"
#include "model.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostCells = 60;          // more make no table that people read
constexpr std::size_t kMostLevelsInPairs = 12;  // every one is compared with every other

using Kind = ResultKind;

ResultTable means_table(const ModelData& data, double confidence) {
  ResultTable table{"Means", {}, {}};
  Factor cells = data.factors.front();
  for (std::size_t f = 1; f < data.factors.size(); ++f) cells = interaction(cells, data.factors[f]);
  for (const auto& factor : data.factors) table.columns.push_back({factor.name, Kind::kText, factor.name});
  for (const auto* name : {"mean", "sd", "lower limit", "upper limit"}) table.columns.push_back({name, Kind::kNumber});
  table.columns.insert(table.columns.end() - 4, {"n", Kind::kCount});
  const auto groups = split_by(data.values, cells);
  for (std::size_t cell = 0; cell < groups.size(); ++cell) {
    std::vector<TableCell> row;
    auto rest = cell;
    for (auto factor = data.factors.rbegin(); factor != data.factors.rend(); ++factor) {
      row.insert(row.begin(), text_cell(factor->levels[rest % factor->levels.size()]));
      rest /= factor->levels.size();
    }
    row.push_back(count_cell(groups[cell].size()));
    const auto interval = mean_interval(groups[cell], confidence);
    row.push_back(groups[cell].size() == 1 ? number_cell(groups[cell].front())
                                           : cell_of(interval, &Interval::estimate));
    const auto sd = standard_deviation(groups[cell]);
    row.push_back(sd ? number_cell(*sd) : cell_of(interval, &Interval::low));
    row.push_back(cell_of(interval, &Interval::low));
    row.push_back(cell_of(interval, &Interval::high));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<TableCell> test_cells(const AnovaTerm& term) {
  return {text_cell(term.name), count_cell(term.df), TableCell{term.sum_of_squares},
          cell_of(term.test, &TestResult::statistic), cell_of(term.test, &TestResult::p)};
}

const std::vector<ResultColumn> kTestColumns{{"term", Kind::kText},
                                             {"df", Kind::kCount},
                                             {"sum of squares", Kind::kNumber},
                                             {"F", Kind::kNumber},
                                             {"p-value", Kind::kP}};

ResultTable anova_table(const ModelResult& result) {
  ResultTable table{"Analysis of variance (type II)", kTestColumns, {}};
  table.columns.insert(
      table.columns.end(),
      {{"partial eta squared", Kind::kFraction}, {"lower limit", Kind::kFraction}, {"upper limit", Kind::kFraction}});
  for (std::size_t t = 0; t < result.table.terms.size(); ++t) {
    auto row = test_cells(result.table.terms[t]);
    row.push_back(cell_of(result.table.terms[t].partial_eta_squared));
    row.push_back(cell_of(result.eta_squared[t], &Interval::low));
    row.push_back(cell_of(result.eta_squared[t], &Interval::high));
    table.rows.push_back(std::move(row));
  }
  std::vector<TableCell> residuals(table.columns.size(), text_cell(""));
  residuals[0] = text_cell("residuals");
  residuals[1] = count_cell(result.table.residual_df);
  residuals[2] = result.table.residual_sum_of_squares;
  table.rows.push_back(std::move(residuals));
  return table;
}

// Tests that do not assume normal residuals.
ResultTable robust_table(const ModelData& data, const ModelResult& result) {
  const bool single = data.factors.size() == 1;
  ResultTable table{"Permutation and rank tests",
                    {{"term", Kind::kText},
                     {"p-value, permutation", Kind::kP},
                     {single ? "p-value, Kruskal-Wallis" : "p-value, aligned ranks", Kind::kP}},
                    {}};
  for (std::size_t t = 0; t < result.table.terms.size(); ++t) {
    table.rows.push_back(
        {text_cell(result.table.terms[t].name), cell_of(result.permutation_p[t]), cell_of(result.rank_p[t])});
  }
  return table;
}

ResultTable type_three_table(const ModelData& data) {
  ResultTable table{"Analysis of variance (type III)", kTestColumns, {}};
  for (const auto& term : anova(data.values, data.factors, data.terms, SumsOfSquares::kTypeIII).terms)
    table.rows.push_back(test_cells(term));
  return table;
}

void add_tukey(const ModelData& data, const ModelResult& result, double confidence, std::vector<ResultTable>& tables) {
  for (const auto& factor : data.factors) {
    if (factor.levels.size() < 2 || factor.levels.size() > kMostLevelsInPairs || result.table.residual_df == 0)
      continue;
    std::vector<double> means;
    std::vector<std::size_t> counts;
    for (const auto& group : split_by(data.values, factor)) {
      means.push_back(group.empty() ? 0.0 : mean(group));
      counts.push_back(group.size());
    }
    const auto df = static_cast<double>(result.table.residual_df);
    const auto pairs = tukey_hsd(means, counts, result.table.residual_sum_of_squares / df, df, confidence);
    if (!pairs) continue;
    ResultTable table{"Pairs of " + factor.name + " (Tukey)",
                      {{"pair", Kind::kText},
                       {"difference", Kind::kNumber},
                       {"lower limit", Kind::kNumber},
                       {"upper limit", Kind::kNumber},
                       {"adjusted p-value", Kind::kP}},
                      {}};
    for (const auto& pair : *pairs)
      table.rows.push_back({text_cell(factor.levels[pair.second] + " - " + factor.levels[pair.first]), pair.difference,
                            pair.low, pair.high, pair.p});
    tables.push_back(std::move(table));
  }
}

ResultTable welch_table(const ModelData& data) {
  ResultTable table{"Test that does not assume equal variances (Welch)",
                    {{"term", Kind::kText}, {"F", Kind::kNumber}, {"p-value", Kind::kP}},
                    {}};
  const auto test = welch_anova(data.values, data.factors.front());
  table.rows.push_back(
      {text_cell(data.factors.front().name), cell_of(test, &TestResult::statistic), cell_of(test, &TestResult::p)});
  return table;
}

std::string ways(std::size_t factors) {
  constexpr std::array kWords{"one", "two", "three", "four"};
  return factors <= kWords.size() ? std::string{kWords[factors - 1]} + "-way" : std::to_string(factors) + "-factor";
}

bool any_known(const std::vector<Estimable<double>>& values) {
  return std::any_of(values.begin(), values.end(), [](const auto& value) { return static_cast<bool>(value); });
}

void name_methods(const ModelData& data, const ModelResult& result, const AnalysisOptions& options, bool has_pairs,
                  Finding& finding) {
  const auto has_test = [](const AnovaTerm& term) { return static_cast<bool>(term.test); };
  if (std::none_of(result.table.terms.begin(), result.table.terms.end(), has_test)) return;
  const bool single = data.factors.size() == 1;
  const bool both_types = !result.table.balanced && !single;
  add_method(finding, {fmt::format("{} analysis of variance{}", ways(data.factors.size()),
                                   single       ? ""
                                   : both_types ? " (type II and type III sums of squares)"
                                                : " (type II sums of squares)")});
  const auto has_interval = [](const auto& interval) { return static_cast<bool>(interval); };
  if (std::any_of(result.eta_squared.begin(), result.eta_squared.end(), has_interval)) {
    add_method(finding, {fmt::format("bootstrap intervals of partial eta squared ({} resamples)", options.resamples)});
  }
  if (any_known(result.permutation_p)) {
    add_method(finding,
               {fmt::format("permutation tests of residuals ({} permutations)", options.permutations), "freedman1983"});
  }
  if (any_known(result.rank_p))
    add_method(finding, single ? Method{"the Kruskal-Wallis test"} : Method{"aligned rank tests", "wobbrock2011"});
  if (single && welch_anova(data.values, data.factors.front())) add_method(finding, {"Welch's analysis of variance"});
  if (has_pairs) add_method(finding, {"Tukey's test for pairs of levels"});
}

}  // namespace

void add_anova_results(const ModelData& data, const ModelResult& result, const AnalysisOptions& options,
                       Finding& finding, const std::string& about) {
  std::vector<ResultTable> tables;
  if (data.factors.empty()) return;
  std::size_t cells = 1;
  for (const auto& factor : data.factors) cells *= factor.levels.size();
  tables.push_back(anova_table(result));
  tables.push_back(robust_table(data, result));
  if (!result.table.balanced && data.factors.size() > 1) tables.push_back(type_three_table(data));
  if (data.factors.size() == 1) tables.push_back(welch_table(data));
  if (cells <= kMostCells) tables.push_back(means_table(data, 1.0 - options.alpha));
  const auto before = tables.size();
  add_tukey(data, result, 1.0 - options.alpha, tables);
  name_methods(data, result, options, tables.size() > before, finding);
  for (auto& table : tables) {
    table.caption = about + table.caption;
    finding.tables.push_back(std::move(table));
  }
}

}  // namespace kith
