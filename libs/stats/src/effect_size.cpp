#include "kith/stats/effect_size.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/random/distributions.hpp"
#include "kith/stats/distributions.hpp"

namespace kith {
namespace {

// Values of several cells, one cell after the other, as differences from their cell's mean: what is resampled.
struct CellValues {
  std::vector<double> differences;
  std::vector<std::size_t> begin;  // [cells + 1]
  std::vector<double> means;       // [cells]
};

CellValues by_cell(std::span<const double> values, std::span<const std::size_t> cell_of, std::size_t num_cells) {
  CellValues cells{std::vector<double>(values.size()), std::vector<std::size_t>(num_cells + 1, 0),
                   std::vector<double>(num_cells, 0.0)};
  for (const auto cell : cell_of) ++cells.begin[cell + 1];
  std::partial_sum(cells.begin.begin(), cells.begin.end(), cells.begin.begin());
  auto next = cells.begin;
  for (std::size_t i = 0; i < values.size(); ++i) cells.differences[next[cell_of[i]]++] = values[i];
  for (std::size_t c = 0; c < num_cells; ++c) {
    const std::span<double> cell{cells.differences.data() + cells.begin[c], cells.begin[c + 1] - cells.begin[c]};
    if (cell.empty()) continue;
    const double origin = cell.front();  // Equal values differ from their mean by exactly 0.
    double sum = 0.0;
    for (const double value : cell) sum += value - origin;
    cells.means[c] = origin + sum / static_cast<double>(cell.size());
    for (auto& value : cell) value -= cells.means[c];
  }
  return cells;
}

// Sums of one resample of a cell, of differences from the cell's own mean.
struct Resampled {
  double sum = 0.0;
  double squares = 0.0;
};

Resampled resample(std::span<const double> cell, RandomStream& random) {
  Resampled sums;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const double value = cell[uniform_index(cell.size(), random)];
    sums.sum += value;
    sums.squares += value * value;
  }
  return sums;
}

std::span<const double> cell_of(const CellValues& cells, std::size_t c) {
  return {cells.differences.data() + cells.begin[c], cells.begin[c + 1] - cells.begin[c]};
}

// Sum of squares around the resample's mean.
double spread(const Resampled& sums, std::size_t n) {
  return std::max(0.0, sums.squares - sums.sum * sums.sum / static_cast<double>(n));
}

// Linear between order statistics, so that 0 is the smallest and 1 the largest (Hyndman and Fan's type 7, R's).
double quantile(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), sorted.size() - 1);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// The percentile interval, unless more than one resample in a hundred had nothing to estimate.
Estimable<Interval> percentile_interval(double estimate, std::vector<double> resampled,
                                        const BootstrapOptions& options) {
  if (resampled.empty() || resampled.size() * 100 < options.resamples * 99)
    return Estimable<Interval>::impossible("too few different values: resamples of them have no spread");
  std::sort(resampled.begin(), resampled.end());
  const double tail = (1.0 - options.confidence) / 2.0;
  return Interval{estimate, quantile(resampled, tail), quantile(resampled, 1.0 - tail)};
}

void require_options(const BootstrapOptions& options, const char* function) {
  require_confidence(options.confidence, function);
  if (options.resamples == 0) throw std::invalid_argument{std::string{function} + ": resamples must be > 0"};
}

// Two samples in one standardised scale: cells 0 and 1.
struct TwoSamples {
  CellValues cells;
  std::size_t n_first = 0;
  std::size_t n_second = 0;
  double negligible = 0.0;
  std::string reason;
};

TwoSamples two_samples(std::span<const double> a, std::span<const double> b, const char* function) {
  require_finite(a, function);
  require_finite(b, function);
  TwoSamples samples;
  samples.n_first = a.size();
  samples.n_second = b.size();
  if (a.empty() || b.empty()) {
    samples.reason = "a group without values";
    return samples;
  }
  if (a.size() + b.size() < 3) {
    samples.reason = "one value in each group leaves no residual degrees of freedom";
    return samples;
  }
  std::vector<double> both{a.begin(), a.end()};
  both.insert(both.end(), b.begin(), b.end());
  std::vector<std::size_t> group(a.size(), 0);
  group.resize(both.size(), 1);
  const auto standardized = standardize(both);
  samples.cells = by_cell(standardized.values, group, 2);
  samples.negligible = negligible_sum_of_squares(standardized.rounding, both.size());
  double within = 0.0;
  for (const double value : samples.cells.differences) within += value * value;
  if (within <= samples.negligible) samples.reason = "no spread within the groups";
  return samples;
}

double standardized_difference(const TwoSamples& samples, double difference, double within) {
  return difference / std::sqrt(within / static_cast<double>(samples.n_first + samples.n_second - 2));
}

// df >= 2
double small_sample_correction(double df) {
  const double half = df / 2.0;
  return std::isinf(df) ? 1.0 : gamma_ratio(half, half - 0.5) / std::sqrt(half);
}

// Of a statistic t of df degrees of freedom that is d / unit.
StandardizedDifference non_central_interval(double t, double df, double unit, double confidence) {
  const double tail = (1.0 - confidence) / 2.0;
  const Interval d{t * unit, non_centrality_of_t(t, df, 1.0 - tail) * unit, non_centrality_of_t(t, df, tail) * unit};
  const double correction = small_sample_correction(df);
  return {d, {correction * d.estimate, correction * d.low, correction * d.high}};
}

double cohens_d_of(const TwoSamples& samples) {
  double within = 0.0;
  for (const double value : samples.cells.differences) within += value * value;
  return standardized_difference(samples, samples.cells.means[0] - samples.cells.means[1], within);
}

}  // namespace

Estimable<double> cohens_d(std::span<const double> a, std::span<const double> b) {
  const auto samples = two_samples(a, b, "cohens_d");
  if (!samples.reason.empty()) return Estimable<double>::impossible(samples.reason);
  return cohens_d_of(samples);
}

Estimable<double> hedges_g(std::span<const double> a, std::span<const double> b) {
  const auto samples = two_samples(a, b, "hedges_g");
  if (!samples.reason.empty()) return Estimable<double>::impossible(samples.reason);
  const auto df = a.size() + b.size() - 2;
  if (df < 2) return Estimable<double>::impossible("fewer than two residual degrees of freedom");
  return small_sample_correction(static_cast<double>(df)) * cohens_d_of(samples);
}

Estimable<StandardizedDifference> standardized_difference(std::span<const double> a, std::span<const double> b,
                                                          double confidence) {
  using Result = Estimable<StandardizedDifference>;
  require_confidence(confidence, "standardized_difference");
  const auto samples = two_samples(a, b, "standardized_difference");
  if (!samples.reason.empty()) return Result::impossible(samples.reason);
  const auto df = a.size() + b.size() - 2;
  if (df < 2) return Result::impossible("fewer than two residual degrees of freedom");
  const double unit = std::sqrt(1.0 / static_cast<double>(a.size()) + 1.0 / static_cast<double>(b.size()));
  return non_central_interval(cohens_d_of(samples) / unit, static_cast<double>(df), unit, confidence);
}

Estimable<StandardizedDifference> paired_standardized_difference(std::span<const double> a, std::span<const double> b,
                                                                 double confidence) {
  using Result = Estimable<StandardizedDifference>;
  const auto difference = paired_t_test(a, b, confidence);
  if (!difference) return Result::impossible(difference.reason());
  if (a.size() < 3) return Result::impossible("fewer than three pairs");
  const auto n = static_cast<double>(a.size());
  return non_central_interval(difference->test.statistic, n - 1.0, 1.0 / std::sqrt(n), confidence);
}

Estimable<StandardizedDifference> standardized_contrast(const FixedEffects& model, const LinearEstimate& contrast,
                                                        double confidence) {
  using Result = Estimable<StandardizedDifference>;
  require_confidence(confidence, "standardized_contrast");
  if (model.link != Link::kIdentity)
    return Result::impossible("the model is linear on another scale than that of the response");
  if (!contrast.inference) return Result::impossible(contrast.inference.reason());
  if (!model.residual_sd) return Result::impossible(model.residual_sd.reason());
  if (contrast.inference->df < 2.0) return Result::impossible("fewer than two degrees of freedom");
  return non_central_interval(contrast.inference->statistic, contrast.inference->df,
                              contrast.inference->standard_error / *model.residual_sd, confidence);
}

Estimable<VarianceShare> variance_share(const AnovaTerm& term, std::size_t observations, double confidence) {
  require_confidence(confidence, "variance_share");
  if (observations == 0) throw std::invalid_argument{"variance_share: observations must be > 0"};
  if (!term.test) return Estimable<VarianceShare>::impossible(term.test.reason());
  const double f = term.test->statistic;
  const double df = term.test->df.at(0);
  const double residual_df = term.test->df.at(1);
  const double tail = (1.0 - confidence) / 2.0;
  const auto n = static_cast<double>(observations);
  const auto share = [&](double p) {
    const double non_centrality = non_centrality_of_f(f, df, residual_df, p);
    return non_centrality / (non_centrality + n);
  };
  const double excess = std::max(0.0, df * (f - 1.0));
  return VarianceShare{{f * df / (f * df + residual_df), share(tail), share(1.0 - tail)}, excess / (excess + n)};
}

Estimable<Interval> bootstrap_hedges_g(std::span<const double> a, std::span<const double> b,
                                       const BootstrapOptions& options, RandomStream random) {
  require_options(options, "bootstrap_hedges_g");
  const auto estimate = hedges_g(a, b);
  if (!estimate) return Estimable<Interval>::impossible(estimate.reason());
  const auto samples = two_samples(a, b, "bootstrap_hedges_g");
  const double correction = small_sample_correction(static_cast<double>(a.size() + b.size() - 2));
  std::vector<double> resampled;
  for (std::size_t r = 0; r < options.resamples; ++r) {
    auto stream = random.split(r);
    const auto first = resample(cell_of(samples.cells, 0), stream);
    const auto second = resample(cell_of(samples.cells, 1), stream);
    const double within = spread(first, a.size()) + spread(second, b.size());
    if (within <= samples.negligible) continue;
    const double difference = (samples.cells.means[0] + first.sum / static_cast<double>(a.size())) -
                              (samples.cells.means[1] + second.sum / static_cast<double>(b.size()));
    resampled.push_back(correction * standardized_difference(samples, difference, within));
  }
  return percentile_interval(*estimate, std::move(resampled), options);
}

Estimable<Interval> bootstrap_variance_ratio(std::span<const double> a, std::span<const double> b,
                                             const BootstrapOptions& options, RandomStream random) {
  require_options(options, "bootstrap_variance_ratio");
  const auto estimate = variance_ratio(a, b, options.confidence);
  if (!estimate) return Estimable<Interval>::impossible(estimate.reason());
  const auto samples = two_samples(a, b, "bootstrap_variance_ratio");
  const double df_ratio = static_cast<double>(b.size() - 1) / static_cast<double>(a.size() - 1);
  std::vector<double> resampled;
  for (std::size_t r = 0; r < options.resamples; ++r) {
    auto stream = random.split(r);
    const double first = spread(resample(cell_of(samples.cells, 0), stream), a.size());
    const double second = spread(resample(cell_of(samples.cells, 1), stream), b.size());
    if (first <= samples.negligible || second <= samples.negligible) continue;
    resampled.push_back(first / second * df_ratio);
  }
  return percentile_interval(estimate->ratio.estimate, std::move(resampled), options);
}

namespace {

// Resampling adds its own noise to the sum of squares of a term, so shares of variance come out too large by as much on
// average as they exceed the estimate; without this, intervals of small effects lie above the estimate.
void take_out_bias(double estimate, std::vector<double>& shares) {
  if (shares.empty()) return;
  double sum = 0.0;
  for (const double share : shares) sum += share;
  const double bias = sum / static_cast<double>(shares.size()) - estimate;
  for (double& share : shares) share = std::clamp(share - bias, 0.0, 1.0);
}

}  // namespace

std::vector<Estimable<Interval>> bootstrap_partial_eta_squared(std::span<const double> response,
                                                               std::span<const Factor> factors,
                                                               std::span<const std::vector<std::size_t>> terms,
                                                               SumsOfSquares type, const BootstrapOptions& options,
                                                               RandomStream random) {
  require_options(options, "bootstrap_partial_eta_squared");
  require_finite(response, "bootstrap_partial_eta_squared");
  const CellModel model{response.size(), factors, terms, type};
  const auto table = anova(response, factors, terms, type);
  std::vector<std::vector<double>> resampled(table.terms.size());
  if (model.reason().empty()) {
    const auto standardized = standardize(response);
    const auto cells = by_cell(standardized.values, model.cell_of(), model.num_cells());
    const double negligible = negligible_sum_of_squares(standardized.rounding, response.size());
    std::vector<double> sums(model.num_cells());
    for (std::size_t r = 0; r < options.resamples; ++r) {
      auto stream = random.split(r);
      double within = 0.0;
      for (std::size_t c = 0; c < sums.size(); ++c) {
        const auto n = model.counts()[c];
        const auto drawn = resample(cell_of(cells, c), stream);
        within += spread(drawn, n);
        sums[c] = drawn.sum + static_cast<double>(n) * cells.means[c];
      }
      const auto z = model.weighted_means(sums);
      const double residual = within + model.lack_of_fit(z);
      if (residual <= negligible) continue;
      for (std::size_t t = 0; t < table.terms.size(); ++t) {
        const double sum_of_squares = model.term_sum_of_squares(t, z);
        resampled[t].push_back(sum_of_squares / (sum_of_squares + residual));
      }
    }
  }
  std::vector<Estimable<Interval>> intervals;
  for (std::size_t t = 0; t < table.terms.size(); ++t) {
    const auto& estimate = table.terms[t].partial_eta_squared;
    if (estimate) take_out_bias(*estimate, resampled[t]);
    intervals.push_back(estimate ? percentile_interval(*estimate, std::move(resampled[t]), options)
                                 : Estimable<Interval>::impossible(estimate.reason()));
  }
  return intervals;
}

Estimable<Interval> bootstrap_mean(std::span<const double> values, const BootstrapOptions& options,
                                   RandomStream random) {
  require_options(options, "bootstrap_mean");
  require_finite(values, "bootstrap_mean");
  if (values.empty()) return Estimable<Interval>::impossible("no values");
  const auto standardized = standardize(values);
  const auto cells = by_cell(standardized.values, std::vector<std::size_t>(values.size(), 0), 1);
  std::vector<double> resampled;
  for (std::size_t r = 0; r < options.resamples; ++r) {
    auto stream = random.split(r);
    const double sum = resample(cell_of(cells, 0), stream).sum;
    resampled.push_back(standardized.centre +
                        std::ldexp(cells.means[0] + sum / static_cast<double>(values.size()), standardized.exponent));
  }
  const double estimate = standardized.centre + std::ldexp(cells.means[0], standardized.exponent);
  return percentile_interval(estimate, std::move(resampled), options);
}

Estimable<Interval> mean_interval(std::span<const double> values, double confidence) {
  require_confidence(confidence, "mean_interval");
  require_finite(values, "mean_interval");
  if (values.size() < 2) return Estimable<Interval>::impossible("fewer than two values");
  const auto standardized = standardize(values);
  const auto cells = by_cell(standardized.values, std::vector<std::size_t>(values.size(), 0), 1);
  double squares = 0.0;
  for (const double value : cells.differences) squares += value * value;
  const auto n = static_cast<double>(values.size());
  const double reach = student_t_quantile(0.5 + confidence / 2.0, n - 1.0) * std::sqrt(squares / (n - 1.0) / n);
  const auto place = [&](double value) { return standardized.centre + std::ldexp(value, standardized.exponent); };
  return Interval{place(cells.means[0]), place(cells.means[0] - reach), place(cells.means[0] + reach)};
}

Interval wilson_interval(std::size_t successes, std::size_t trials, double confidence) {
  require_confidence(confidence, "wilson_interval");
  if (trials == 0 || successes > trials)
    throw std::invalid_argument{"wilson_interval: successes must be at most trials, trials > 0"};
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(successes) / n;
  const double z = normal_quantile(0.5 + confidence / 2.0);
  const double shrink = 1.0 + z * z / n;
  const double middle = (p + z * z / (2.0 * n)) / shrink;
  const double reach = z / shrink * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {p, successes == 0 ? 0.0 : middle - reach, successes == trials ? 1.0 : middle + reach};
}

}  // namespace kith
