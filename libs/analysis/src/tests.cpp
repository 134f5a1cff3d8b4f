#include "kith/analysis/tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/analysis/distributions.hpp"
#include "samples.hpp"

namespace kith {
namespace {

using detail::no_spread;

struct Group : detail::Sample {
  std::string level;
};

// The groups that have observations, of standardised values.
struct Groups {
  std::vector<Group> all;
  double n = 0.0;
  double rounding = 0.0;
  std::string reason;  // Why they cannot be compared; empty if they can.
};

Groups describe_groups(std::span<const double> values, const Factor& factor, const char* function) {
  require_finite(values, function);
  require_codes(factor, values.size(), function);
  const auto standardized = standardize(values);
  Groups groups;
  groups.n = static_cast<double>(values.size());
  groups.rounding = standardized.rounding;
  const auto by_level = split_by(standardized.values, factor);
  for (std::size_t level = 0; level < by_level.size(); ++level) {
    if (!by_level[level].empty()) groups.all.push_back({detail::describe(by_level[level]), factor.levels[level]});
  }
  if (groups.all.size() < 2) groups.reason = "fewer than two groups have observations";
  return groups;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto half = values.size() / 2;
  // The halves are added, so that huge values do not overflow.
  return values.size() % 2 == 1 ? values[half] : values[half - 1] / 2.0 + values[half] / 2.0;
}

// What both t tests have in common: a mean and its standard error in standardised units.
MeanDifference t_difference(double difference, double standard_error, double df, double confidence, int exponent) {
  const double t = difference / standard_error;
  const double reach = student_t_quantile(0.5 + confidence / 2.0, df) * standard_error;
  return {std::ldexp(difference, exponent),
          std::ldexp(standard_error, exponent),
          std::ldexp(difference - reach, exponent),
          std::ldexp(difference + reach, exponent),
          {"t", t, {df}, student_t_two_sided(t, df)}};
}

}  // namespace

Estimable<TestResult> one_way_anova(std::span<const double> values, const Factor& groups) {
  using Result = Estimable<TestResult>;
  const auto described = describe_groups(values, groups, "one_way_anova");
  if (!described.reason.empty()) return Result::impossible(described.reason);
  const auto k = static_cast<double>(described.all.size());
  if (described.n <= k) return Result::impossible("no residual degrees of freedom: one observation per group");
  double mean = 0.0;
  double within = 0.0;
  for (const auto& group : described.all) {
    mean += group.n * group.mean / described.n;
    within += group.sum_of_squares;
  }
  if (no_spread(within, described.n, described.rounding)) return Result::impossible("no spread within the groups");
  double between = 0.0;
  for (const auto& group : described.all) between += group.n * (group.mean - mean) * (group.mean - mean);
  return f_test(between, k - 1.0, within, described.n - k);
}

Estimable<TestResult> welch_anova(std::span<const double> values, const Factor& groups) {
  using Result = Estimable<TestResult>;
  const auto described = describe_groups(values, groups, "welch_anova");
  if (!described.reason.empty()) return Result::impossible(described.reason);
  double total_weight = 0.0;
  double mean = 0.0;
  for (const auto& group : described.all) {
    if (group.n < 2.0) return Result::impossible("group '" + group.level + "' has one observation only");
    if (no_spread(group.sum_of_squares, group.n, described.rounding))
      return Result::impossible("no spread within group '" + group.level + "'");
    const double weight = group.n / group.variance();
    total_weight += weight;
    mean += weight * group.mean;
  }
  mean /= total_weight;
  const auto k = static_cast<double>(described.all.size());
  double imbalance = 0.0;
  double between = 0.0;
  for (const auto& group : described.all) {
    const double weight = group.n / group.variance();
    const double rest = 1.0 - weight / total_weight;
    imbalance += rest * rest / (group.n - 1.0) / (k * k - 1.0);
    between += weight * (group.mean - mean) * (group.mean - mean);
  }
  const double f = between / ((k - 1.0) * (1.0 + 2.0 * (k - 2.0) * imbalance));
  const double df2 = 1.0 / (3.0 * imbalance);
  return TestResult{"F", f, {k - 1.0, df2}, f_upper(f, k - 1.0, df2)};
}

Estimable<TestResult> kruskal_wallis(std::span<const double> values, const Factor& groups) {
  using Result = Estimable<TestResult>;
  require_finite(values, "kruskal_wallis");
  require_codes(groups, values.size(), "kruskal_wallis");
  const auto ranks = mid_ranks(values);
  const auto n = static_cast<double>(values.size());
  const double middle = (n + 1.0) / 2.0;
  double between = 0.0;
  std::size_t k = 0;
  for (const auto& group : split_by(ranks, groups)) {
    if (group.empty()) continue;
    ++k;
    const auto size = static_cast<double>(group.size());
    const double sum = std::accumulate(group.begin(), group.end(), 0.0) - size * middle;
    between += sum * sum / size;
  }
  if (k < 2) return Result::impossible("fewer than two groups have observations");
  // The variance of the ranks is that of 1, ..., n less what ties take from it.
  double total = 0.0;
  for (const double rank : ranks) total += (rank - middle) * (rank - middle);
  if (total == 0.0) return Result::impossible("all values are equal");
  const double h = (n - 1.0) * between / total;
  const auto df = static_cast<double>(k - 1);
  return TestResult{"H", h, {df}, chi_squared_upper(h, df)};
}

Estimable<TestResult> brown_forsythe(std::span<const double> values, const Factor& groups) {
  using Result = Estimable<TestResult>;
  const auto described = describe_groups(values, groups, "brown_forsythe");
  if (!described.reason.empty()) return Result::impossible(described.reason);
  const auto standardized = standardize(values);
  std::vector<double> medians;
  for (auto& group : split_by(standardized.values, groups))
    medians.push_back(group.empty() ? 0.0 : median(std::move(group)));
  auto deviations = standardized.values;
  double largest = 0.0;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    deviations[i] = std::abs(deviations[i] - medians[groups.codes[i]]);
    largest = std::max(largest, deviations[i]);
  }
  if (largest <= 4.0 * standardized.rounding) return Result::impossible("no spread within the groups");
  auto result = one_way_anova(deviations, groups);
  if (!result && described.n > static_cast<double>(described.all.size()))
    return Result::impossible("within each group all values are equally far from the median");
  return result;
}

Estimable<MeanDifference> welch_t_test(std::span<const double> a, std::span<const double> b, double confidence) {
  using Result = Estimable<MeanDifference>;
  require_finite(a, "welch_t_test");
  require_finite(b, "welch_t_test");
  require_confidence(confidence, "welch_t_test");
  if (a.size() < 2 || b.size() < 2) return Result::impossible("fewer than two values in a group");
  const auto samples = detail::describe(a, b);
  if (no_spread(samples.within(), samples.n(), samples.rounding))
    return Result::impossible("no spread within the groups");
  const auto& first = samples.first;
  const auto& second = samples.second;
  const double of_first = first.variance() / first.n;
  const double of_second = second.variance() / second.n;
  const double variance = of_first + of_second;
  const double df =
      variance * variance / (of_first * of_first / (first.n - 1.0) + of_second * of_second / (second.n - 1.0));
  return t_difference(first.mean - second.mean, std::sqrt(variance), df, confidence, samples.exponent);
}

Estimable<MeanDifference> paired_t_test(std::span<const double> a, std::span<const double> b, double confidence) {
  using Result = Estimable<MeanDifference>;
  if (a.size() != b.size()) throw std::invalid_argument{"paired_t_test: both samples need the same length"};
  require_finite(a, "paired_t_test");
  require_finite(b, "paired_t_test");
  require_confidence(confidence, "paired_t_test");
  if (a.size() < 2) return Result::impossible("fewer than two pairs");
  // Scaled first: a difference may be beyond the range of double.
  double largest = 0.0;
  for (const auto sample : {a, b})
    for (const double value : sample) largest = std::max(largest, std::abs(value));
  const int exponent = largest > 0.0 ? std::ilogb(largest) + 1 : 0;
  std::vector<double> differences(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences[i] = std::ldexp(a[i], -exponent) - std::ldexp(b[i], -exponent);
  const auto described = detail::describe(differences);
  if (no_spread(described.sum_of_squares, described.n, std::numeric_limits<double>::epsilon()))
    return Result::impossible("all differences are equal");
  return t_difference(described.mean, std::sqrt(described.variance() / described.n), described.n - 1.0, confidence,
                      exponent);
}

Estimable<VarianceRatio> variance_ratio(std::span<const double> a, std::span<const double> b, double confidence) {
  using Result = Estimable<VarianceRatio>;
  require_finite(a, "variance_ratio");
  require_finite(b, "variance_ratio");
  require_confidence(confidence, "variance_ratio");
  if (a.size() < 2 || b.size() < 2) return Result::impossible("fewer than two values in a group");
  const auto samples = detail::describe(a, b);
  const auto& first = samples.first;
  const auto& second = samples.second;
  for (const auto* sample : {&first, &second}) {
    if (no_spread(sample->sum_of_squares, sample->n, samples.rounding))
      return Result::impossible("no spread within a group");
  }
  const double ratio = first.variance() / second.variance();
  const double df1 = first.n - 1.0;
  const double df2 = second.n - 1.0;
  const double tail = (1.0 - confidence) / 2.0;
  const double upper = f_upper(ratio, df1, df2);
  const double lower = f_upper(1.0 / ratio, df2, df1);  // keeps the digits of a small lower tail
  return VarianceRatio{{ratio, ratio / f_quantile(1.0 - tail, df1, df2), ratio / f_quantile(tail, df1, df2)},
                       {"F", ratio, {df1, df2}, std::min(1.0, 2.0 * std::min(upper, lower))}};
}

std::vector<double> mid_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    auto last = first;
    while (last + 1 < order.size() && values[order[last + 1]] == values[order[first]]) ++last;
    const double rank = 1.0 + (static_cast<double>(first) + static_cast<double>(last)) / 2.0;
    for (auto i = first; i <= last; ++i) ranks[order[i]] = rank;
    first = last + 1;
  }
  return ranks;
}

}  // namespace kith
