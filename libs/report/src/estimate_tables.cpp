#include "sections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kith/analysis/effect_size.hpp"
#include "team_tables.hpp"

namespace kith::detail {
namespace {

// Pearson's; not a number if one of both does not vary.
double correlation_of(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  constexpr double kRounding = 1e-20;
  if (xx < kRounding || yy < kRounding) return std::numeric_limits<double>::quiet_NaN();
  return xy / std::sqrt(xx * yy);
}

}  // namespace

std::optional<Json> mastery_calibration_table(const RunData& data) {
  constexpr double kNormal = 1.959963984540054;  // 97.5 % quantile
  JsonTable table{{"predicted", "actual", "actual_low", "actual_high", "n"}};
  bool any = false;
  for (const auto& bin : data.mastery) {
    if (bin.n == 0) continue;
    any = true;
    const auto n = static_cast<double>(bin.n);
    const double mean = bin.actual / n;
    const double variance = bin.n > 1 ? std::max(0.0, bin.actual_squares - n * mean * mean) / (n - 1.0) : 0.0;
    const double half = kNormal * std::sqrt(variance / n);
    table.add(Json::array({number(bin.predicted / n), number(mean), number(std::max(0.0, mean - half)),
                           number(std::min(1.0, mean + half)), bin.n}));
  }
  if (!any) return std::nullopt;
  return std::move(table).take();
}

Json ability_estimates_table(const ReportDesign& design, const RunData& data) {
  constexpr std::size_t kFewest = 10;
  JsonTable table{
      {"strategy", "period", "n", "correlation", "within", "within_low", "within_high", "told", "told_correctly"}};
  for (const auto& [key, estimates] : data.ability_estimates) {
    const auto n = estimates.actual.size();
    if (n < kFewest) continue;
    const auto within = wilson_interval(estimates.within, n);
    auto row = Json::array({design.series[key.first].code, key.second, n});
    row.push_back(number(correlation_of(estimates.actual, estimates.estimated)));
    for (const double value : {within.estimate, within.low, within.high}) row.push_back(number(value));
    row.push_back(number(static_cast<double>(estimates.told) / static_cast<double>(n)));
    const auto told = static_cast<double>(estimates.told);
    row.push_back(estimates.told == 0 ? Json{} : number(static_cast<double>(estimates.told_correctly) / told));
    table.add(std::move(row));
  }
  return std::move(table).take();
}

}  // namespace kith::detail
