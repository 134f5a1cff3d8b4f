#include <cmath>
#include <numbers>
#include <utility>

#include "checks.hpp"
#include "kith/stats/multiple.hpp"

namespace kith {

Estimable<std::vector<UnequalVariancePair>> games_howell(std::span<const double> values, const Factor& groups,
                                                         double confidence) {
  require_finite(values, "games_howell");
  require_codes(groups, values.size(), "games_howell");
  require_confidence(confidence, "games_howell");
  const auto by_level = split_by(values, groups);
  std::vector<std::size_t> used;
  for (std::size_t level = 0; level < by_level.size(); ++level) {
    if (!by_level[level].empty()) used.push_back(level);
  }
  if (used.size() < 2)
    return Estimable<std::vector<UnequalVariancePair>>::impossible("fewer than two groups have observations");
  std::vector<UnequalVariancePair> pairs;
  for (std::size_t i = 0; i < used.size(); ++i) {
    for (std::size_t j = i + 1; j < used.size(); ++j) {
      pairs.push_back({used[i], used[j], welch_t_test(by_level[used[j]], by_level[used[i]], confidence)});
      auto& result = pairs.back().difference;
      if (!result) continue;
      auto difference = *result;
      const double df = difference.test.df.at(0);
      if (df < 2.0) {
        result = Estimable<MeanDifference>::impossible("fewer than two degrees of freedom");
        continue;
      }
      const double reach = studentized_range_quantile(1.0 - confidence, used.size(), df) / std::numbers::sqrt2 *
                           difference.standard_error;
      difference.low = difference.difference - reach;
      difference.high = difference.difference + reach;
      difference.test.p =
          studentized_range_upper(std::numbers::sqrt2 * std::abs(difference.test.statistic), used.size(), df);
      result = std::move(difference);
    }
  }
  return pairs;
}

}  // namespace kith
