#include "kith/analysis/effect_size.hpp"

#include <cmath>
#include <stdexcept>

#include "checks.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

void require_that(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument{rule};
}

}  // namespace

Interval partial_eta_squared_interval(double f, double df1, double df2, double confidence) {
  require_that(f >= 0.0 && std::isfinite(f), "partial_eta_squared_interval: f must be >= 0 and finite");
  require_that(df1 > 0.0 && std::isfinite(df1) && df2 > 0.0 && std::isfinite(df2),
               "partial_eta_squared_interval: degrees of freedom must be > 0 and finite");
  require_confidence(confidence, "partial_eta_squared_interval");
  const double tail = 0.5 * (1.0 - confidence);
  const auto limit = [&](double p) {
    const double lambda = non_centrality_of_f(f, df1, df2, p);
    return lambda / (lambda + df1 + df2 + 1.0);
  };
  return {f * df1 / (f * df1 + df2), limit(tail), limit(1.0 - tail)};
}

Interval standardized_interval(double t, double df, double unit, double confidence) {
  require_that(std::isfinite(t), "standardized_interval: t must be finite");
  require_that(df > 0.0, "standardized_interval: df must be > 0");
  require_that(unit > 0.0 && std::isfinite(unit), "standardized_interval: unit must be > 0 and finite");
  require_confidence(confidence, "standardized_interval");
  const double tail = 0.5 * (1.0 - confidence);
  return {t * unit, non_centrality_of_t(t, df, 1.0 - tail) * unit, non_centrality_of_t(t, df, tail) * unit};
}

}  // namespace kith
