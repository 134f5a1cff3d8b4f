#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/analysis/multiple.hpp"
#include "kith/core/error.hpp"
#include "model_means.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// A comparison of the marginal means.
struct Comparison {
  LinearEstimate estimate;
  std::string group;  // the level of the `by` factor; may be empty
};

constexpr std::size_t kMostLevelsInPairs = 12;  // every one is compared with every other
constexpr std::size_t kMostSimpleEffects = 12;  // levels of a factor at each of which others are compared

ResultTable comparison_table(const std::string& caption, const std::string& first, const ComparisonFamily& family,
                             bool is_corrected) {
  using Result = ComparisonResult;
  std::vector<ShownColumn<Result>> columns;
  const auto add = [&](auto part, const std::string& name, Kind kind, const std::string& field = "") {
    columns.push_back(show(part, name, kind, field));
  };
  if (!family.by.empty()) add(&Result::at, family.by, Kind::kText, family.by);
  add(&Result::name, first, Kind::kText);
  add(&Result::estimate, "difference", Kind::kNumber);
  add(&Result::low, "lower limit", Kind::kNumber);
  add(&Result::high, "upper limit", Kind::kNumber);
  add(&Result::d, "d", Kind::kFraction);
  add(&Result::d_low, "d, lower limit", Kind::kFraction);
  add(&Result::d_high, "d, upper limit", Kind::kFraction);
  add(&Result::p, family.is_adjusted ? "adjusted p-value" : "p-value", Kind::kP);
  if (is_corrected) add(&Result::corrected_p, "corrected p-value", Kind::kP);
  return shown(caption, family.comparisons, columns);
}

// An estimate that is as small beside its limits as rounding makes it is 0.
double without_rounding(double estimate, double low, double high) {
  constexpr double kRounding = 1e-12;
  return std::abs(estimate) <= kRounding * std::max(std::abs(low), std::abs(high)) ? 0.0 : estimate;
}

// A comparison as people read it; missing where it cannot be estimated.
ComparisonResult result_of(const Comparison& comparison, const FixedEffects& model) {
  const auto& [estimate, group] = comparison;
  ComparisonResult result{.name = estimate.name, .at = group};
  result.estimate = estimate.estimate;
  if (!estimate.inference) return result;

  const auto& inference = *estimate.inference;
  result.estimate = without_rounding(estimate.estimate, inference.low, inference.high);
  result.low = inference.low;
  result.high = inference.high;
  result.t = inference.statistic;
  if (std::isfinite(inference.df)) result.df = inference.df;
  result.p = inference.p;
  if (model.residual_sd) {
    const double sd = *model.residual_sd;
    result.d = *result.estimate / sd;
    result.d_low = inference.low / sd;
    result.d_high = inference.high / sd;
  }
  return result;
}

MeanFamily means_of_levels(const std::string& factor, const MarginalGroup& means) {
  MeanFamily family{factor, {}};
  for (const auto& mean : means.means) {
    auto& result = family.means.emplace_back(MeanResult{.level = mean.name, .n = mean.observations});
    result.mean = mean.estimate;
    result.low = known(mean.inference, &Inference::low);
    result.high = known(mean.inference, &Inference::high);
  }
  return family;
}

ResultTable means_table(const MeanFamily& family) {
  return shown<MeanResult>(kMeansCaption + family.factor, family.means,
                           {show(&MeanResult::level, family.factor, Kind::kText, family.factor),
                            show(&MeanResult::mean, "mean"), show(&MeanResult::low, "lower limit"),
                            show(&MeanResult::high, "upper limit"), show(&MeanResult::n, "n", Kind::kCount)});
}

std::optional<std::size_t> factor_named(std::span<const Factor> factors, const std::string& name) {
  const auto found = std::ranges::find(factors, name, &Factor::name);
  if (found == factors.end()) return std::nullopt;
  return static_cast<std::size_t>(found - factors.begin());
}

// The factor that a contrast is about; nothing if it has none of these levels.
std::optional<std::size_t> factor_of(std::span<const Factor> factors, const PlannedContrast& contrast) {
  for (std::size_t f = 0; f < factors.size(); ++f) {
    const auto& levels = factors[f].levels;
    const bool has_levels = std::ranges::all_of(
        contrast.weights, [&](const auto& weight) { return std::ranges::find(levels, weight.level) != levels.end(); });
    if (has_levels && (contrast.factor.empty() || contrast.factor == factors[f].name)) return f;
  }
  return std::nullopt;
}

std::vector<double> weights_of(const Factor& factor, const PlannedContrast& contrast) {
  std::vector<double> weights(factor.levels.size(), 0.0);
  for (const auto& [level, weight] : contrast.weights)
    weights[static_cast<std::size_t>(std::ranges::find(factor.levels, level) - factor.levels.begin())] = weight;
  return weights;
}

class Writer {
 public:
  Writer(const FixedEffects& model, const AnalysisOptions& options, Finding& finding, std::vector<ResultTable>& tables)
      : model_{model}, options_{options}, finding_{finding}, tables_{tables} {}

  void add_means() {
    for (std::size_t f = 0; f < model_.design.factors.size(); ++f) {
      const auto& factor = model_.design.factors[f];
      if (factor.levels.size() < 2 || factor.levels.size() > kMostMeans) continue;
      finding_.means.push_back(means_of_levels(factor.name, means_of(f, {}).front()));
      tables_.push_back(means_table(finding_.means.back()));
    }
    if (!model_.design.factors.empty()) add_method(finding_, {"estimated marginal means", "searle1980"});
  }

  void add_pairs() {
    for (std::size_t f = 0; f < model_.design.factors.size(); ++f) add_pairs_of(f, std::nullopt);
  }

  void add_simple_effects() {
    for (const auto& name : options_.by) {
      const auto by = factor_named(model_.design.factors, name);
      if (!by || model_.design.factors[*by].levels.size() > kMostSimpleEffects) continue;
      for (std::size_t f = 0; f < model_.design.factors.size(); ++f) {
        if (f == *by) continue;
        if (interact(model_.design.terms, f, *by)) {
          add_pairs_of(f, by);
        } else {
          finding_.warnings.push_back(
              fmt::format("the model has no interaction of {0} and {1}, so differences between levels of {0} are the "
                          "same at every level of {1}; use {0}*{1} to estimate them",
                          model_.design.factors[f].name, name));
        }
      }
    }
  }

  void add_planned() {
    for (std::size_t f = 0; f < model_.design.factors.size(); ++f) {
      std::vector<MeanContrast> contrasts;
      for (const auto& contrast : options_.contrasts) {
        if (factor_of(model_.design.factors, contrast) == f)
          contrasts.push_back({contrast.name, weights_of(model_.design.factors[f], contrast)});
      }
      if (contrasts.empty()) continue;
      add_planned_of(f, std::nullopt, contrasts);
      for (const auto& name : options_.by) {
        const auto by = factor_named(model_.design.factors, name);
        if (by && *by != f && interact(model_.design.terms, f, *by)) add_planned_of(f, by, contrasts);
      }
    }
  }

 private:
  static constexpr std::size_t kMostMeans = 60;

  [[nodiscard]] std::vector<MarginalGroup> means_of(std::size_t factor, std::optional<std::size_t> by) const {
    return marginal_means(model_, factor, by, 1.0 - options_.alpha);
  }

  // The planned contrasts of a factor, at each level of `by` if there is one: a family per level.
  [[nodiscard]] std::vector<Comparison> planned(std::size_t factor, std::optional<std::size_t> by,
                                                const std::vector<MeanContrast>& contrasts) const {
    const auto correction = contrasts.size() > 1 && !by ? options_.correction : Correction::kNone;
    std::vector<Comparison> comparisons;
    for (const auto& group : means_of(factor, by)) {
      for (auto& estimate : estimate_contrasts(model_, group, contrasts, correction, 1.0 - options_.alpha))
        comparisons.push_back({std::move(estimate), group.name});
    }
    return comparisons;
  }

  void add_pairs_of(std::size_t f, std::optional<std::size_t> by) {
    const auto& factor = model_.design.factors[f];
    if (factor.levels.size() < 2 || factor.levels.size() > kMostLevelsInPairs) return;
    const bool is_family = factor.levels.size() > 2;

    std::vector<Comparison> comparisons;
    for (const auto& group : means_of(f, by)) {
      for (auto& pair : estimate_pairs(model_, group, 1.0 - options_.alpha))
        comparisons.push_back({std::move(pair), group.name});
    }

    const auto by_name = by ? model_.design.factors[*by].name : std::string{};
    ComparisonFamily family{
        .kind = ComparisonFamily::Kind::kPairs, .factor = factor.name, .by = by_name, .is_adjusted = is_family};
    add_family(pairs_caption(factor.name, by_name, is_family), "pair", std::move(family), comparisons);
    if (is_family && !comparisons.empty())
      add_method(finding_, {"Tukey-Kramer tests for pairs of estimated marginal means", "kramer1956"});
  }

  void add_planned_of(std::size_t f, std::optional<std::size_t> by, const std::vector<MeanContrast>& contrasts) {
    const auto comparisons = planned(f, by, contrasts);
    const auto by_name = by ? model_.design.factors[*by].name : std::string{};
    const bool is_family = !by && contrasts.size() > 1 && options_.correction != Correction::kNone;
    const auto how = is_family ? fmt::format(" ({} correction)", to_string(options_.correction)) : std::string{};
    ComparisonFamily family{.kind = ComparisonFamily::Kind::kPlanned,
                            .factor = model_.design.factors[f].name,
                            .by = by_name,
                            .is_adjusted = is_family};
    add_family(planned_caption(family.factor, by_name, is_family ? std::optional{options_.correction} : std::nullopt),
               "contrast", family, comparisons);
    add_method(finding_, {"planned contrasts of estimated marginal means" + how});
    // Simple effects are in their table; what is said of them is corrected there.
    if (!by) {
      for (const auto& comparison : comparisons) finding_.sentence += sentence_of_contrast(comparison);
    }
  }

  // Corrects the p-values for all contrasts at all levels, and says which remain.
  void correct_over_levels(ComparisonFamily& family) {
    std::vector<double> p_values;
    for (const auto& one : family.comparisons) {
      if (one.p) p_values.push_back(*one.p);
    }
    const auto corrected = adjust(p_values, options_.correction);
    std::size_t next = 0;
    std::string found;
    for (auto& one : family.comparisons) {
      if (!one.p) continue;
      one.corrected_p = corrected[next++];
      if (*one.corrected_p >= options_.alpha) continue;
      found += fmt::format("{}{} at {} ({})", found.empty() ? "" : ", ", one.name, one.at, p_text(*one.corrected_p));
    }
    finding_.sentence += found.empty()
                             ? fmt::format(" At single levels of {}, no contrast differs from 0 ({} correction).",
                                           family.by, to_string(options_.correction))
                             : fmt::format(" At single levels of {} ({} correction): {}.", family.by,
                                           to_string(options_.correction), found);
  }

  [[nodiscard]] std::string sentence_of_contrast(const Comparison& one) const {
    const auto& name = one.estimate.name;
    if (!one.estimate.inference) return fmt::format(" {} cannot be tested: {}.", name, one.estimate.inference.reason());
    return fmt::format(" {}: {} [{}, {}], {}.", name, formatted(one.estimate.estimate, Kind::kNumber),
                       formatted(one.estimate.inference->low, Kind::kNumber),
                       formatted(one.estimate.inference->high, Kind::kNumber), p_text(one.estimate.inference->p));
  }

  void add_family(const std::string& caption, const std::string& first, ComparisonFamily family,
                  const std::vector<Comparison>& comparisons) {
    if (comparisons.empty()) return;
    for (const auto& one : comparisons) family.comparisons.push_back(result_of(one, model_));

    const bool is_corrected = family.kind == ComparisonFamily::Kind::kPlanned && !family.by.empty() &&
                              options_.correction != Correction::kNone;
    if (is_corrected) correct_over_levels(family);
    tables_.push_back(comparison_table(caption, first, family, is_corrected));
    finding_.comparisons.push_back(std::move(family));
  }

  const FixedEffects& model_;
  const AnalysisOptions& options_;
  Finding& finding_;
  std::vector<ResultTable>& tables_;
};

}  // namespace

void add_contrast_results(const FixedEffects& model, const AnalysisOptions& options, Finding& finding,
                          std::vector<ResultTable>& tables) {
  Writer{model, options, finding, tables}.add_planned();
}

LinearEstimate contrast_estimate(const FixedEffects& model, const PlannedContrast& contrast, double confidence) {
  const auto factor = factor_of(model.design.factors, contrast).value();
  const std::vector<MeanContrast> one{{contrast.name, weights_of(model.design.factors[factor], contrast)}};
  return estimate_contrasts(model, marginal_means(model, factor).front(), one, Correction::kNone, confidence).front();
}

std::string range_of_means(const FixedEffects& model, const std::string& factor) {
  const auto f = factor_named(model.design.factors, factor);
  if (!f) return "";
  const auto means = marginal_means(model, *f).front().means;
  const auto [low, high] = std::ranges::minmax_element(means, {}, &MarginalMean::estimate);
  const auto text = [](const MarginalMean& mean) {
    return fmt::format("{} ({})", formatted(mean.estimate, Kind::kNumber), mean.name);
  };
  return fmt::format("from {} to {}", text(*low), text(*high));
}

void add_marginal_results(const FixedEffects& model, const AnalysisOptions& options, bool with_means, Finding& finding,
                          std::vector<ResultTable>& tables) {
  Writer writer{model, options, finding, tables};
  if (with_means) writer.add_means();
  writer.add_pairs();
  writer.add_simple_effects();
  writer.add_planned();
}

bool interact(const std::vector<std::vector<std::size_t>>& terms, std::size_t a, std::size_t b) {
  const auto has = [](const std::vector<std::size_t>& term, std::size_t factor) {
    return std::find(term.begin(), term.end(), factor) != term.end();
  };
  return std::any_of(terms.begin(), terms.end(), [&](const auto& term) { return has(term, a) && has(term, b); });
}

bool is_testable(const std::vector<Factor>& factors, const PlannedContrast& contrast) {
  return factor_of(factors, contrast).has_value();
}

void check_comparisons(const std::vector<Factor>& factors, const AnalysisOptions& options) {
  const auto names = [&] {
    std::vector<std::string> all;
    for (const auto& factor : factors) all.push_back(factor.name);
    return all;
  }();
  for (const auto& by : options.by) {
    if (std::find(names.begin(), names.end(), by) != names.end()) continue;
    throw Error{ErrorKind::kUsage, fmt::format("--by {}: the model has no factor of this name, but {}", by,
                                               names.empty() ? "none" : listed(names))};
  }
  for (const auto& contrast : options.contrasts) {
    if (is_testable(factors, contrast)) continue;
    std::string levels;
    for (const auto& weight : contrast.weights) levels += (levels.empty() ? "'" : ", '") + weight.level + "'";
    throw Error{ErrorKind::kUsage,
                fmt::format("contrast '{}': no factor of the model has the levels {}{}", contrast.name, levels,
                            contrast.factor.empty() ? "" : " (it is to be '" + contrast.factor + "')")};
  }
}

}  // namespace kith
