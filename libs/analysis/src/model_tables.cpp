#include <algorithm>
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
  for (const auto* name : {"mean", "sd", "low", "high"}) table.columns.push_back({name, Kind::kNumber});
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
                                             {"p", Kind::kP}};

ResultTable anova_table(const ModelData& data, const ModelResult& result) {
  ResultTable table{"Analysis of variance (type II), with tests by permutation and by ranks", kTestColumns, {}};
  const bool single = data.factors.size() == 1;
  for (const auto& column : std::vector<ResultColumn>{{"partial eta squared", Kind::kFraction},
                                                      {"low", Kind::kFraction},
                                                      {"high", Kind::kFraction},
                                                      {"p, permutation", Kind::kP},
                                                      {single ? "p, Kruskal-Wallis" : "p, aligned ranks", Kind::kP}})
    table.columns.push_back(column);
  for (std::size_t t = 0; t < result.table.terms.size(); ++t) {
    auto row = test_cells(result.table.terms[t]);
    row.push_back(cell_of(result.table.terms[t].partial_eta_squared));
    row.push_back(cell_of(result.eta_squared[t], &Interval::low));
    row.push_back(cell_of(result.eta_squared[t], &Interval::high));
    row.push_back(cell_of(result.permutation_p[t]));
    row.push_back(cell_of(result.rank_p[t]));
    table.rows.push_back(std::move(row));
  }
  std::vector<TableCell> residuals(table.columns.size(), text_cell(""));
  residuals[0] = text_cell("residuals");
  residuals[1] = count_cell(result.table.residual_df);
  residuals[2] = result.table.residual_sum_of_squares;
  table.rows.push_back(std::move(residuals));
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
                       {"low", Kind::kNumber},
                       {"high", Kind::kNumber},
                       {"p, adjusted", Kind::kP}},
                      {}};
    for (const auto& pair : *pairs)
      table.rows.push_back({text_cell(factor.levels[pair.second] + " - " + factor.levels[pair.first]), pair.difference,
                            pair.low, pair.high, pair.p});
    tables.push_back(std::move(table));
  }
}

ResultTable welch_table(const ModelData& data) {
  ResultTable table{"Without equal spread", {{"test", Kind::kText}, {"statistic", Kind::kNumber}, {"p", Kind::kP}}, {}};
  const auto add = [&](const std::string& name, const Estimable<TestResult>& test) {
    table.rows.push_back({text_cell(name), cell_of(test, &TestResult::statistic), cell_of(test, &TestResult::p)});
  };
  add("Welch, F", welch_anova(data.values, data.factors.front()));
  add("Kruskal-Wallis, chi-squared", kruskal_wallis(data.values, data.factors.front()));
  return table;
}

}  // namespace

std::vector<ResultTable> anova_tables(const ModelData& data, const ModelResult& result,
                                      const AnalysisOptions& options) {
  std::vector<ResultTable> tables;
  if (data.factors.empty()) return tables;
  std::size_t cells = 1;
  for (const auto& factor : data.factors) cells *= factor.levels.size();
  tables.push_back(anova_table(data, result));
  if (!result.table.balanced && data.factors.size() > 1) tables.push_back(type_three_table(data));
  if (data.factors.size() == 1) tables.push_back(welch_table(data));
  if (cells <= kMostCells) tables.push_back(means_table(data, 1.0 - options.alpha));
  add_tukey(data, result, 1.0 - options.alpha, tables);
  return tables;
}

}  // namespace kith
