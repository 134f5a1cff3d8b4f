#include <fmt/format.h>

#include <algorithm>

#include "kith/analysis/decimals.hpp"
#include "kith/analysis/nested_model.hpp"
#include "model_means.hpp"
#include "shown.hpp"

namespace kith {
namespace {

// By how far values are from the mean of their cell: what the groups have in common counts as chance.
void add_far_value_of_cells(const ModelData& data, const CellDesign& design, std::vector<std::string>& warnings) {
  std::vector<double> means(design.counts.size(), 0.0), leverages, residuals;
  for (const auto count : design.counts) leverages.push_back(1.0 / static_cast<double>(count));
  for (std::size_t i = 0; i < data.values.size(); ++i) means[design.cell_of[i]] += data.values[i];
  for (std::size_t cell = 0; cell < means.size(); ++cell) means[cell] *= leverages[cell];
  double squares = 0.0;
  for (std::size_t i = 0; i < data.values.size(); ++i) {
    residuals.push_back(data.values[i] - means[design.cell_of[i]]);
    squares += residuals.back() * residuals.back();
  }
  const auto df = static_cast<double>(residuals.size()) - static_cast<double>(means.size());
  warn_of_far_value(data.values, residuals, leverages, design.cell_of, df, squares, warnings);
}

using Kind = ResultKind;

constexpr std::size_t kFewGroups = 10;  // below it variances between groups are very uncertain

TestFamily tests_with_effects(const std::vector<TermTest>& tests, double alpha) {
  auto family = tests_of(tests, TestFamily::Residuals::kOneDecimal);
  for (std::size_t t = 0; t < tests.size(); ++t)
    family.tests[t] = with_effect(family.tests[t], eta_squared_of(tests[t].test, alpha));
  return family;
}

ResultTable tests_table(const std::string& caption, const TestFamily& family) {
  const auto residuals = [kind = family.residuals](const TermResult& test) {
    return text_cell(residuals_text(test, kind));
  };
  return shown(caption, family.tests,
               with_effect_columns({show(&TermResult::subject, "term", Kind::kText),
                                    show(&TermResult::df, "df", Kind::kCount),
                                    {{"residual df", Kind::kText}, residuals},
                                    show(&TermResult::statistic, "F"),
                                    show(&TermResult::p, "p-value", Kind::kP)}));
}

ResultTable variances_table(const NestedModel& model) {
  ResultTable table{kVariancesCaption,
                    {{"rows with the same", Kind::kText},
                     {"groups", Kind::kCount},
                     {"variance"},
                     {"intraclass correlation", Kind::kFraction},
                     {"lower limit", Kind::kFraction},
                     {"upper limit", Kind::kFraction},
                     {"p-value", Kind::kP},
                     {"design effect", Kind::kNumber}},
                    {}};
  for (const auto& one : model.groups) {
    table.rows.push_back({text_cell(one.name), count_cell(one.groups), one.variance, one.intraclass_correlation,
                          cell_of(one.intraclass_interval, &Interval::low),
                          cell_of(one.intraclass_interval, &Interval::high), cell_of(one.test, &TestResult::p),
                          number_cell(one.design_effect)});
  }
  std::vector<TableCell> residual(table.columns.size(), text_cell(""));
  residual[0] = text_cell("(residual)");
  residual[2] = model.residual_variance;
  table.rows.push_back(std::move(residual));
  return table;
}

std::string likeness_sentence(const NestedModel& model, const ModelData& data) {
  std::string text;
  for (const auto& one : model.groups) {
    text += fmt::format(" The intraclass correlation of {} with the same {} is {:.2f}", data.observations, one.name,
                        one.intraclass_correlation);
    if (one.intraclass_interval)
      text += " " + interval_text(one.intraclass_interval->low, one.intraclass_interval->high, 2);
    if (one.design_effect > 1.0) {
      text += fmt::format(
          " (design effect {:.2f}: for the overall mean, {} {} carry as much information as {:.0f} independent ones)",
          one.design_effect, data.values.size(), data.observations,
          static_cast<double>(data.values.size()) / one.design_effect);
    }
    text += ".";
  }
  return text;
}

void add_nested_warnings(const NestedModel& model, const ModelData& data, Finding& finding) {
  const auto is_zero = [](const GroupVariance& one) { return one.variance == 0.0; };
  const bool all_zero = std::all_of(model.groups.begin(), model.groups.end(), is_zero);
  for (const auto& component : model.groups) {
    if (is_zero(component)) {
      finding.warnings.push_back(fmt::format(
          "the variance of {0} is estimated as 0, so the tests treat {1} {2}{3}", component.name, data.observations,
          all_zero ? "as independent" : fmt::format("with the same {} as no more alike than others", component.name),
          component.intraclass_interval ? fmt::format("; the data allow an intraclass correlation of up to {:.2f}",
                                                      component.intraclass_interval->high)
                                        : ""));
    }
    if (component.groups < kFewGroups) {
      finding.warnings.push_back(fmt::format(
          "there are only {} different values of {}, so the variance and the intraclass correlation are very uncertain",
          component.groups, component.name));
    }
  }

  add_far_value_of_cells(data, model.fixed.design, finding.warnings);
}

}  // namespace

void add_nested_results(const ModelData& data, const NestedModel& model, const AnalysisOptions& options,
                        Finding& finding, const std::string& about) {
  std::vector<ResultTable> tables;
  if (!data.terms.empty()) {
    finding.tests.push_back(tests_with_effects(model.tests, options.alpha));
    tables.push_back(tests_table(kMixedCaption, finding.tests.back()));
    add_method(finding, {"linear mixed model (REML) with Satterthwaite's degrees of freedom", "kuznetsova2017"});
    add_method(finding, eta_squared_method(options.alpha));
  }
  tables.push_back(variances_table(model));
  if (auto means = raw_means_table(data, 1.0 - options.alpha, false)) tables.push_back(std::move(*means));
  add_marginal_results(model.fixed, options, true, finding, tables);
  for (auto& table : tables) {
    table.caption = about + table.caption;
    finding.tables.push_back(std::move(table));
  }
}

std::string add_nested_model(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  const auto model = fit_nested_model(data.values, data.factors, data.terms, data.groups, 1.0 - options.alpha);
  finding.sentence = fmt::format("Mixed model of {} ({} {} in {} groups).", data.response, data.values.size(),
                                 data.observations, data.groups.front().levels.size());
  if (!model) return model.reason();
  for (std::size_t t = 0; t < data.terms.size(); ++t) {
    const auto& test = model->tests[t].test;
    finding.sentence +=
        " " + term_sentence(data, t, test, eta_squared_of(test, options.alpha), model->fixed, options.alpha);
  }
  finding.sentence += likeness_sentence(*model, data);
  add_nested_warnings(*model, data, finding);
  add_nested_results(data, *model, options, finding);
  return "";
}

}  // namespace kith
