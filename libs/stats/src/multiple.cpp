#include "kith/stats/multiple.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "checks.hpp"

namespace kith {

std::string_view to_string(Correction correction) noexcept {
  switch (correction) {
    case Correction::kBonferroni:
      return "Bonferroni";
    case Correction::kHolm:
      return "Holm";
    case Correction::kFdr:
      return "Benjamini-Hochberg";
    case Correction::kNone:
      break;
  }
  return "none";
}

namespace {

// Holm: the smallest p counts n times, the next n - 1 times. `order` ascends.
void step_down(const std::vector<std::size_t>& order, std::vector<double>& p) {
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    largest = std::max(largest, p[order[rank]] * static_cast<double>(order.size() - rank));
    p[order[rank]] = std::min(1.0, largest);
  }
}

// Benjamini and Hochberg: the largest p counts once, the one before it n / (n - 1) times.
void step_up(const std::vector<std::size_t>& order, std::vector<double>& p) {
  double smallest = 1.0;
  for (auto rank = order.size(); rank-- > 0;) {
    smallest = std::min(smallest, p[order[rank]] * (static_cast<double>(order.size()) / static_cast<double>(rank + 1)));
    p[order[rank]] = smallest;
  }
}

}  // namespace

std::vector<double> adjust(std::span<const double> p_values, Correction correction) {
  for (const double p : p_values) {
    if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument{"adjust: p-values must be in [0, 1]"};
  }
  std::vector<double> adjusted{p_values.begin(), p_values.end()};
  const auto n = adjusted.size();
  if (correction == Correction::kBonferroni) {
    for (auto& p : adjusted) p = std::min(1.0, p * static_cast<double>(n));
  } else if (correction != Correction::kNone) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return p_values[i] < p_values[j]; });
    if (correction == Correction::kHolm) {
      step_down(order, adjusted);
    } else {
      step_up(order, adjusted);
    }
  }
  return adjusted;
}

Estimable<std::vector<PairwiseDifference>> tukey_hsd(std::span<const double> means, std::span<const std::size_t> counts,
                                                     double mean_square, double df, double confidence) {
  using Result = Estimable<std::vector<PairwiseDifference>>;
  require_confidence(confidence, "tukey_hsd");
  require_finite(means, "tukey_hsd");
  if (means.size() != counts.size()) throw std::invalid_argument{"tukey_hsd: one count per mean is needed"};
  if (!(mean_square >= 0.0) || !(df >= 0.0)) throw std::invalid_argument{"tukey_hsd: mean_square and df must be >= 0"};
  if (means.size() < 2) return Result::impossible("fewer than two groups");
  if (std::find(counts.begin(), counts.end(), std::size_t{0}) != counts.end())
    return Result::impossible("a group without observations");
  if (df < 2.0) return Result::impossible("fewer than two residual degrees of freedom");
  if (mean_square == 0.0) return Result::impossible("no residual spread");
  if (std::isinf(mean_square)) return Result::impossible("the residual spread is beyond the range of numbers");
  const auto groups = means.size();
  const double critical = studentized_range_quantile(1.0 - confidence, groups, df);
  std::vector<PairwiseDifference> pairs;
  for (std::size_t first = 0; first < groups; ++first) {
    for (std::size_t second = first + 1; second < groups; ++second) {
      const double weight = 1.0 / static_cast<double>(counts[first]) + 1.0 / static_cast<double>(counts[second]);
      const double standard_error = std::sqrt(mean_square) * std::sqrt(weight / 2.0);
      const double difference = means[second] - means[first];
      const double reach = critical * standard_error;
      pairs.push_back({first, second, difference, difference - reach, difference + reach,
                       studentized_range_upper(std::abs(difference) / standard_error, groups, df)});
    }
  }
  return pairs;
}

}  // namespace kith
