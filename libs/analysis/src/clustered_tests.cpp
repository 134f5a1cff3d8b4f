#include "kith/analysis/clustered_tests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "checks.hpp"
#include "kith/analysis/distributions.hpp"
#include "kith/analysis/moments.hpp"

namespace kith {
namespace {

void require_two_samples(std::span<const double> values, const Factor& sample, const Factor& clusters,
                         const char* function) {
  require_finite(values, function);
  require_codes(sample, values.size(), function);
  require_codes(clusters, values.size(), function);
  if (sample.levels.size() != 2) throw std::invalid_argument{std::string{function} + ": there must be two samples"};
}

std::optional<double> log_ratio(const PowerSums& a, const PowerSums& b) {
  if (a.n < 2.0 || b.n < 2.0) return std::nullopt;
  const double first = a.variance(), second = b.variance();
  if (!(first > 0.0) || !(second > 0.0)) return std::nullopt;
  return std::log(first / second);
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

Estimable<TestResult> friedman(std::span<const double> values, const Factor& within, const Factor& blocks) {
  using Result = Estimable<TestResult>;
  require_finite(values, "friedman");
  require_codes(within, values.size(), "friedman");
  require_codes(blocks, values.size(), "friedman");
  const auto levels = drop_unused(within);
  const auto k = levels.levels.size();
  if (k < 2) return Result::impossible("fewer than two groups have observations");
  const auto rows = drop_unused(blocks);
  std::vector<std::vector<double>> table(rows.levels.size(), std::vector<double>(k));
  std::vector<std::vector<bool>> known(rows.levels.size(), std::vector<bool>(k, false));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (known[rows.codes[i]][levels.codes[i]]) return Result::impossible("a block has a level more than once");
    known[rows.codes[i]][levels.codes[i]] = true;
    table[rows.codes[i]][levels.codes[i]] = values[i];
  }
  if (values.size() != rows.levels.size() * k) return Result::impossible("not every block has every level");
  const double middle = (static_cast<double>(k) + 1.0) / 2.0;
  std::vector<double> sums(k, 0.0);
  double spread = 0.0;  // of the ranks within blocks, less what ties take from it
  for (const auto& block : table) {
    const auto ranks = mid_ranks(block);
    for (std::size_t j = 0; j < k; ++j) {
      sums[j] += ranks[j] - middle;
      spread += (ranks[j] - middle) * (ranks[j] - middle);
    }
  }
  if (spread == 0.0) return Result::impossible("all values of every block are equal");
  double between = 0.0;
  for (const double sum : sums) between += sum * sum;
  const auto df = static_cast<double>(k - 1);
  const double q = df * between / spread;
  return TestResult{"chi-squared", q, {df}, chi_squared_upper(q, df)};
}

Estimable<VarianceRatio> clustered_variance_ratio(std::span<const double> values, const Factor& sample,
                                                  const Factor& clusters, double confidence) {
  using Result = Estimable<VarianceRatio>;
  require_two_samples(values, sample, clusters, "clustered_variance_ratio");
  require_confidence(confidence, "clustered_variance_ratio");
  const auto used = drop_unused(clusters);
  const auto num_clusters = used.levels.size();
  if (num_clusters < 3) return Result::impossible("there are fewer than three clusters");
  const double origin = mean(values);
  std::array<PowerSums, 2> all;
  std::vector<PowerSums> first(num_clusters), second(num_clusters);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto code = sample.codes[i];
    all.at(code).add(values[i] - origin);
    (code == 0 ? first : second)[used.codes[i]].add(values[i] - origin);
  }
  const auto estimate = log_ratio(all[0], all[1]);
  if (!estimate) return Result::impossible("a sample has no spread");
  std::vector<double> left_out;
  for (std::size_t c = 0; c < num_clusters; ++c) {
    const auto one = log_ratio(all[0].without(first[c]), all[1].without(second[c]));
    if (!one) return Result::impossible("without one cluster, a sample has no spread");
    left_out.push_back(*one);
  }
  const auto n = static_cast<double>(num_clusters);
  const double error = jackknife_error(left_out);
  if (!(error > 0.0)) return Result::impossible("the clusters do not differ");
  const double t = *estimate / error;
  const double width = student_t_quantile(0.5 + confidence / 2.0, n - 1.0) * error;
  return VarianceRatio{{std::exp(*estimate), std::exp(*estimate - width), std::exp(*estimate + width)},
                       {"t", t, {n - 1.0}, student_t_two_sided(t, n - 1.0)}};
}

Estimable<TestResult> clustered_brown_forsythe(std::span<const double> values, const Factor& sample,
                                               const Factor& clusters) {
  using Result = Estimable<TestResult>;
  require_two_samples(values, sample, clusters, "clustered_brown_forsythe");
  const auto samples = split_by(values, sample);
  if (samples[0].empty() || samples[1].empty()) return Result::impossible("a sample has no observations");
  const std::array medians{median_of(samples[0]), median_of(samples[1])};
  const auto used = drop_unused(clusters);
  std::vector<PowerSums> first(used.levels.size()), second(used.levels.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto code = sample.codes[i];
    (code == 0 ? first : second)[used.codes[i]].add(std::abs(values[i] - medians.at(code)));
  }
  std::vector<double> a, b;
  for (std::size_t c = 0; c < used.levels.size(); ++c) {
    if (first[c].n == 0.0 || second[c].n == 0.0) continue;
    a.push_back(first[c].sum / first[c].n);
    b.push_back(second[c].sum / second[c].n);
  }
  const auto test = paired_t_test(a, b);
  if (!test) return Result::impossible(test.reason());
  return test->test;
}

}  // namespace kith
