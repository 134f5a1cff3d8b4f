#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kith/analysis/moments.hpp"
#include "model_means.hpp"
#include "shown.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostCells = 60;  // more make no table that people read

using Kind = ResultKind;

ResultTable cell_means(const ModelData& data, double confidence, bool with_limits) {
  ResultTable table{"Raw means", {}, {}};
  Factor cells = data.factors.front();
  for (std::size_t f = 1; f < data.factors.size(); ++f) cells = interaction(cells, data.factors[f]);
  for (const auto& factor : data.factors) table.columns.push_back({factor.name, Kind::kText, factor.name});
  table.columns.insert(table.columns.end(), {{"n", Kind::kCount}, {"mean"}, {"sd"}});
  if (with_limits) table.columns.insert(table.columns.end(), {{"lower limit"}, {"upper limit"}});

  const auto groups = split_by(data.values, cells);
  for (std::size_t cell = 0; cell < groups.size(); ++cell) {
    std::vector<TableCell> row;

    // A cell is a number whose digits are the levels, that of the last factor first.
    auto rest = cell;
    for (auto factor = data.factors.rbegin(); factor != data.factors.rend(); ++factor) {
      row.insert(row.begin(), text_cell(factor->levels[rest % factor->levels.size()]));
      rest /= factor->levels.size();
    }

    row.push_back(count_cell(groups[cell].size()));
    const auto interval = mean_interval(groups[cell], confidence);
    row.push_back(groups[cell].size() == 1 ? number_cell(groups[cell].front())
                                           : cell_of(interval, &Interval::estimate));
    row.push_back(cell_of(standard_deviation(groups[cell])));
    if (with_limits) row.insert(row.end(), {cell_of(interval, &Interval::low), cell_of(interval, &Interval::high)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

TestFamily type_two_tests(const ModelResult& result) {
  auto family = tests_of(result.table);
  for (std::size_t t = 0; t < family.tests.size(); ++t) {
    family.tests[t].effect = known(result.table.terms[t].partial_eta_squared);
    family.tests[t].low = known(result.eta_squared[t], &Interval::low);
    family.tests[t].high = known(result.eta_squared[t], &Interval::high);
  }
  return family;
}

ResultTable welch_table(const ModelData& data) {
  ResultTable table{kWelchCaption, {{"term", Kind::kText}, {"F", Kind::kNumber}, {"p-value", Kind::kP}}, {}};
  const auto test = welch_anova(data.values, data.factors.front());
  table.rows.push_back(
      {text_cell(data.factors.front().name), cell_of(test, &TestResult::statistic), cell_of(test, &TestResult::p)});
  return table;
}

std::string ways(std::size_t factors) {
  constexpr std::array kWords{"one", "two", "three", "four"};
  return factors <= kWords.size() ? std::string{kWords[factors - 1]} + "-way" : std::to_string(factors) + "-factor";
}

void name_methods(const ModelData& data, const ModelResult& result, const AnalysisOptions& options, Finding& finding) {
  const auto has_test = [](const AnovaTerm& term) { return static_cast<bool>(term.test); };
  if (std::none_of(result.table.terms.begin(), result.table.terms.end(), has_test)) return;
  const bool single = data.factors.size() == 1;
  add_method(finding, {fmt::format("{} analysis of variance{}", ways(data.factors.size()),
                                   single ? "" : " (type II sums of squares)")});
  const auto has_interval = [](const auto& interval) { return static_cast<bool>(interval); };
  if (std::any_of(result.eta_squared.begin(), result.eta_squared.end(), has_interval))
    add_method(finding, eta_squared_method(options.alpha));
  if (single && welch_anova(data.values, data.factors.front())) add_method(finding, {"Welch's analysis of variance"});
}

}  // namespace

std::optional<ResultTable> raw_means_table(const ModelData& data, double confidence, bool with_limits) {
  std::size_t cells = 1;
  for (const auto& factor : data.factors) cells *= factor.levels.size();
  if (data.factors.empty() || cells > kMostCells) return std::nullopt;
  return cell_means(data, confidence, with_limits);
}

void add_anova_results(const ModelData& data, const ModelResult& result, const AnalysisOptions& options,
                       Finding& finding, const std::string& about) {
  std::vector<ResultTable> tables;
  if (data.factors.empty()) return;
  finding.tests.push_back(type_two_tests(result));
  tables.push_back(anova_table(kAnovaCaption, finding.tests.back(), result.table));
  if (data.factors.size() == 1) tables.push_back(welch_table(data));
  name_methods(data, result, options, finding);
  if (auto means = raw_means_table(data, 1.0 - options.alpha, true)) tables.push_back(std::move(*means));
  if (result.table.effects)
    add_marginal_results(*result.table.effects, options, data.factors.size() > 1, finding, tables);
  for (auto& table : tables) {
    table.caption = about + table.caption;
    finding.tables.push_back(std::move(table));
  }
}

}  // namespace kith
