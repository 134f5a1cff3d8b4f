#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/tests.hpp"
#include "kith/study/outcomes.hpp"
#include "model.hpp"

namespace kith {
namespace {

constexpr double kManyAtBound = 0.25;  // of all values
constexpr double kNearBound = 0.1;     // of the range, within which all values lie

// A bound of an outcome's range that most say little beside, if there is one.
struct Bound {
  double value = 0.0;
  bool is_high = false;
  std::size_t there = 0;  // values that are exactly this
};

std::optional<Bound> bound_of(const ModelData& data, const StudyOutcome& range) {
  const auto [least, most] = std::minmax_element(data.values.begin(), data.values.end());
  const double near = kNearBound * (range.high - range.low);  // infinite without an upper bound
  for (const bool is_high : {false, true}) {
    const double value = is_high ? range.high : range.low;
    if (std::isinf(value)) continue;
    const auto there = static_cast<std::size_t>(std::count(data.values.begin(), data.values.end(), value));
    const bool are_near = std::isfinite(near) && (is_high ? *least >= value - near : *most <= value + near);
    if (are_near || static_cast<double>(there) >= kManyAtBound * static_cast<double>(data.values.size()))
      return Bound{value, is_high, there};
  }
  return std::nullopt;
}

ResultTable shares_table(const ModelData& data, const Bound& bound, double confidence) {
  ResultTable table{fmt::format("{} with exactly {:g}", data.observations, bound.value),
                    {{"level", ResultKind::kText},
                     {"n", ResultKind::kCount},
                     {"there", ResultKind::kCount},
                     {"share", ResultKind::kFraction},
                     {"lower limit", ResultKind::kFraction},
                     {"upper limit", ResultKind::kFraction}},
                    {}};
  table.caption[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(table.caption[0])));
  for (const auto& factor : data.factors) {
    const auto groups = split_by(data.values, factor);
    for (std::size_t level = 0; level < groups.size(); ++level) {
      if (groups[level].empty()) continue;
      const auto there = static_cast<std::size_t>(std::count(groups[level].begin(), groups[level].end(), bound.value));
      const auto share = wilson_interval(there, groups[level].size(), confidence);
      table.rows.push_back({text_cell(factor.name + " " + factor.levels[level]), count_cell(groups[level].size()),
                            count_cell(there), share.estimate, share.low, share.high});
    }
  }
  return table;
}

// The same mixed model of the values' ranks, whose distances do not count.
std::optional<ResultTable> rank_table(const ModelData& data, const AnalysisOptions& options) {
  const auto model =
      fit_nested_model(mid_ranks(data.values), data.factors, data.terms, data.groups, 1.0 - options.alpha);
  if (!model) return std::nullopt;
  ResultTable table{"Tests of the fixed effects on ranks (type II, Satterthwaite)",
                    {{"term", ResultKind::kText}, {"F on ranks"}, {"p-value", ResultKind::kP}},
                    {}};
  for (const auto& term : model->tests)
    table.rows.push_back(
        {text_cell(term.name), cell_of(term.test, &TestResult::statistic), cell_of(term.test, &TestResult::p)});
  return table;
}

}  // namespace

void add_bound_results(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  const auto* const range = find_outcome(data.response);
  if (range == nullptr || data.values.empty() || data.factors.empty()) return;
  const auto bound = bound_of(data, *range);
  if (!bound) return;
  const auto [least, most] = std::minmax_element(data.values.begin(), data.values.end());
  const auto ranks = data.groups.empty() ? std::nullopt : rank_table(data, options);
  finding.warnings.push_back(fmt::format(
      "values of {} are at the {}: {} of {} {} have exactly {:g}, the {} that is possible, and all lie between {} "
      "and {}. Differences can hardly show there, and intervals of means take no account of the bound{}; the table of "
      "shares counts who is at the bound",
      data.response, bound->is_high ? "ceiling" : "floor", bound->there, data.values.size(), data.observations,
      bound->value, bound->is_high ? "most" : "least", formatted(*least, ResultKind::kNumber),
      formatted(*most, ResultKind::kNumber), ranks ? "; the tests on ranks do not depend on distances" : ""));
  finding.tables.push_back(shares_table(data, *bound, 1.0 - options.alpha));
  if (!ranks) return;
  finding.tables.push_back(*ranks);
  add_method(finding, {"the same mixed model of ranks"});
}

}  // namespace kith
