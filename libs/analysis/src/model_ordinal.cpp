#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kith/stats/cumulative_logit.hpp"
#include "model_means.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

constexpr std::size_t kFewRatings = 5;  // in a cell: below it the tests' chi-squared distributions are rough

// The ratings in ascending order, as levels.
Factor ratings_of(const ModelData& data) {
  std::map<double, std::size_t> positions;
  for (const double value : data.values) positions.emplace(value, 0);
  Factor ratings{data.response, {}, {}};
  for (auto& [value, position] : positions) {
    position = ratings.levels.size();
    ratings.levels.push_back(fmt::format("{}", value));
  }
  for (const double value : data.values) ratings.codes.push_back(positions.at(value));
  return ratings;
}

// How often each rating was given, by cell.
std::optional<ResultTable> shares_table(const ModelData& data, const Factor& ratings) {
  constexpr std::size_t kMostCells = 30;
  Factor cells = data.factors.front();
  for (std::size_t f = 1; f < data.factors.size(); ++f) cells = interaction(cells, data.factors[f]);
  if (cells.levels.size() > kMostCells) return std::nullopt;
  ResultTable table{
      "How often each rating was given", {{cells.name, Kind::kText, cells.name}, {"n", Kind::kCount}}, {}};
  for (const auto& level : ratings.levels) table.columns.push_back({level, Kind::kCount, "rating_" + level});
  std::vector<std::vector<std::size_t>> counts(cells.levels.size(), std::vector<std::size_t>(ratings.levels.size()));
  for (std::size_t i = 0; i < cells.codes.size(); ++i) ++counts[cells.codes[i]][ratings.codes[i]];
  for (std::size_t c = 0; c < counts.size(); ++c) {
    std::size_t n = 0;
    for (const auto count : counts[c]) n += count;
    auto& row = table.rows.emplace_back();
    row = {text_cell(cells.levels[c]), count_cell(n)};
    for (const auto count : counts[c]) row.push_back(count_cell(count));
  }
  return table;
}

}  // namespace

Finding analyze_ordinal_model(const ModelData& data, const AnalysisOptions& options) {
  Finding finding{.id = data.response, .model = formula_text(data) + " (ordinal)"};
  finding.topic = finding.model;
  finding.question = "Does " + data.response + " depend on the factors of the model?";
  finding.sentence =
      fmt::format("Proportional odds model of {} ({} {}).", data.response, data.values.size(), data.observations);

  const auto ratings = ratings_of(data);
  const auto model = fit_cumulative_logit(ratings, data.factors, data.terms, 1.0 - options.alpha);
  if (!model) {
    finding.sentence += " It cannot be fitted, so nothing is tested: " + model.reason() + ".";
  } else {
    for (std::size_t t = 0; t < model->term_tests.size(); ++t) {
      finding.sentence +=
          " " + term_sentence(data, t, model->term_tests[t].test, Estimable<Interval>::impossible("of a linear model"),
                              nullptr, options.alpha);
    }

    if (!model->term_tests.empty()) {
      auto family = tests_of(model->term_tests, TestFamily::Residuals::kWhole);
      family.statistic = TestFamily::Statistic::kChiSquared;
      finding.tables.push_back(
          shown<TermResult>(kOrdinalCaption, family.tests,
                            {show(&TermResult::subject, "term", Kind::kText), show(&TermResult::df, "df", Kind::kCount),
                             show(&TermResult::statistic, "chi-squared"), show(&TermResult::p, "p-value", Kind::kP)}));
      finding.tests.push_back(std::move(family));
      finding.sentence += " An odds ratio above 1 stands for higher ratings.";
    }
    add_method(finding, {"proportional odds model with likelihood-ratio tests", "mccullagh1980"});

    const auto& counts = model->fixed.design.counts;
    std::size_t least = kFewRatings;
    for (const auto count : counts) least = count > 0 ? std::min(least, count) : least;
    if (!data.factors.empty() && least < kFewRatings) {
      finding.warnings.push_back(
          fmt::format("the smallest cell has {}, so p-values and intervals, which assume many, are rough",
                      number_and_noun(least, data.observations.substr(0, data.observations.size() - 1))));
    }
    if (model->proportional_odds && model->proportional_odds->p < options.alpha) {
      finding.warnings.push_back(
          fmt::format("odds ratios differ between steps of the scale (Brant's test: {}), so one odds ratio per level "
                      "is a summary only",
                      test_text(*model->proportional_odds)));
    }
    add_marginal_results(model->fixed, options, false, finding, finding.tables);
  }

  if (!data.factors.empty()) {
    if (auto shares = shares_table(data, ratings)) finding.tables.push_back(std::move(*shares));
  }
  return finding;
}

}  // namespace kith
