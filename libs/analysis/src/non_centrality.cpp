#include <cmath>
#include <stdexcept>

#include "kith/analysis/distributions.hpp"
#include "root.hpp"

namespace kith {
namespace {

constexpr unsigned kBits = 45;

void require_limit(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument{rule};
}

}  // namespace

double non_centrality_of_t(double t, double df, double p) {
  require_limit(std::isfinite(t), "non_centrality_of_t: t must be finite");
  require_limit(p > 0.0 && p < 1.0, "non_centrality_of_t: p must be in (0, 1)");
  require_limit(df > 0.0, "non_centrality_of_t: df must be > 0");
  const double z = normal_quantile(p);
  if (std::isinf(df)) return t - z;
  const auto excess = [&](double non_centrality) { return non_central_t_lower(t, df, non_centrality) - p; };
  double reach = 1.0 + (1.0 + std::abs(z)) * std::sqrt(1.0 + t * t / (2.0 * df));
  double low = t - reach;
  while (excess(low) < 0.0) low -= reach *= 2.0;
  double high = t + reach;
  while (excess(high) > 0.0) high += reach *= 2.0;
  return detail::root_between(low, high, kBits, excess);
}

double non_centrality_of_f(double f, double df1, double df2, double p) {
  require_limit(f >= 0.0 && std::isfinite(f), "non_centrality_of_f: f must be >= 0 and finite");
  require_limit(p > 0.0 && p < 1.0, "non_centrality_of_f: p must be in (0, 1)");
  const auto excess = [&](double non_centrality) { return p - non_central_f_upper(f, df1, df2, non_centrality); };
  if (excess(0.0) <= 0.0) return 0.0;
  double high = f * df1 + 1.0;
  while (excess(high) > 0.0) high *= 2.0;
  return detail::root_between(0.0, high, kBits, excess);
}

}  // namespace kith
