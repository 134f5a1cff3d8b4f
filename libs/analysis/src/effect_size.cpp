#include "kith/analysis/effect_size.hpp"

#include <cmath>
#include <stdexcept>

#include "checks.hpp"
#include "kith/analysis/distributions.hpp"
#include "samples.hpp"

namespace kith {

Estimable<double> hedges_g(std::span<const double> a, std::span<const double> b) {
  using Result = Estimable<double>;
  require_finite(a, "hedges_g");
  require_finite(b, "hedges_g");
  if (a.empty() || b.empty()) return Result::impossible("a group without values");
  if (a.size() + b.size() < 4) return Result::impossible("fewer than two residual degrees of freedom");
  const auto samples = detail::describe(a, b);
  if (detail::no_spread(samples.within(), samples.n(), samples.rounding))
    return Result::impossible("no spread within the groups");
  const double df = samples.n() - 2.0;
  const double correction = gamma_ratio(df / 2.0, df / 2.0 - 0.5) / std::sqrt(df / 2.0);
  return correction * (samples.first.mean - samples.second.mean) / std::sqrt(samples.within() / df);
}

Estimable<Interval> mean_interval(std::span<const double> values, double confidence) {
  require_confidence(confidence, "mean_interval");
  require_finite(values, "mean_interval");
  if (values.size() < 2) return Estimable<Interval>::impossible("fewer than two values");
  const auto standardized = standardize(values);
  const auto sample = detail::describe(standardized.values);
  const double reach =
      student_t_quantile(0.5 + confidence / 2.0, sample.n - 1.0) * std::sqrt(sample.variance() / sample.n);
  const auto place = [&](double value) { return standardized.centre + std::ldexp(value, standardized.exponent); };
  return Interval{place(sample.mean), place(sample.mean - reach), place(sample.mean + reach)};
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
