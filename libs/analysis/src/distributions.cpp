#include "kith/analysis/distributions.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace kith {
namespace {

namespace bm = boost::math;

// Parameters are checked here, in our own words; what overflows is infinite, as it should be.
using Quiet = bm::policies::policy<bm::policies::overflow_error<bm::policies::ignore_error>,
                                   bm::policies::evaluation_error<bm::policies::ignore_error>>;

void require(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument{std::string{rule}};
}

void require_df(double df, const char* rule) { require(df > 0.0, rule); }  // false for NaN

void require_probability(double p, const char* rule) { require(p > 0.0 && p < 1.0, rule); }

}  // namespace

double normal_upper(double z) {
  require(!std::isnan(z), "normal_upper: z must be a number");
  return 0.5 * bm::erfc(z / std::numbers::sqrt2, Quiet{});
}

double normal_quantile(double p) {
  require_probability(p, "normal_quantile: p must be in (0, 1)");
  return -std::numbers::sqrt2 * bm::erfc_inv(2.0 * p, Quiet{});
}

double student_t_two_sided(double t, double df) {
  require(!std::isnan(t), "student_t_two_sided: t must be a number");
  require_df(df, "student_t_two_sided: df must be > 0");
  const double size = std::abs(t);
  if (std::isinf(size)) return 0.0;
  if (std::isinf(df)) return 2.0 * normal_upper(size);
  // The square of t would overflow: the first term of the tail's series is then exact.
  if (size > 1e100 * std::sqrt(df))
    return std::pow(std::sqrt(df) / size, df) / (0.5 * df * bm::beta(0.5 * df, 0.5, Quiet{}));
  return 2.0 * bm::cdf(bm::complement(bm::students_t_distribution<double, Quiet>{df}, size));
}

double student_t_quantile(double p, double df) {
  require_probability(p, "student_t_quantile: p must be in (0, 1)");
  require_df(df, "student_t_quantile: df must be > 0");
  if (std::isinf(df)) return normal_quantile(p);
  return bm::quantile(bm::students_t_distribution<double, Quiet>{df}, p);
}

double f_upper(double f, double df1, double df2) {
  require(!std::isnan(f), "f_upper: f must be a number");
  require_df(df1, "f_upper: df1 must be > 0");
  require_df(df2, "f_upper: df2 must be > 0");
  if (f <= 0.0) return 1.0;
  if (std::isinf(f)) return 0.0;
  if (std::isinf(df1) && std::isinf(df2)) return f < 1.0 ? 1.0 : 0.0;
  if (std::isinf(df2)) return chi_squared_upper(f * df1, df1);
  if (std::isinf(df1)) return bm::cdf(bm::chi_squared_distribution<double, Quiet>{df2}, df2 / f);
  return bm::cdf(bm::complement(bm::fisher_f_distribution<double, Quiet>{df1, df2}, f));
}

double f_quantile(double p, double df1, double df2) {
  require_probability(p, "f_quantile: p must be in (0, 1)");
  require_df(df1, "f_quantile: df1 must be > 0");
  require_df(df2, "f_quantile: df2 must be > 0");
  if (std::isinf(df1) && std::isinf(df2)) return 1.0;
  if (std::isinf(df2)) return bm::quantile(bm::chi_squared_distribution<double, Quiet>{df1}, p) / df1;
  if (std::isinf(df1)) return df2 / bm::quantile(bm::complement(bm::chi_squared_distribution<double, Quiet>{df2}, p));
  return bm::quantile(bm::fisher_f_distribution<double, Quiet>{df1, df2}, p);
}

double chi_squared_upper(double x, double df) {
  require(!std::isnan(x), "chi_squared_upper: x must be a number");
  require(df > 0.0 && std::isfinite(df), "chi_squared_upper: df must be > 0 and finite");
  if (x <= 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
  return bm::cdf(bm::complement(bm::chi_squared_distribution<double, Quiet>{df}, x));
}

namespace {

// Where the non-centrality is so large that the series for it have too many terms: the numerator of F is then normal,
// or, beside a denominator of finite df, as good as constant (its spread is 2 / sqrt(non_centrality) of it).
double far_f_upper(double f, double df1, double df2, double non_centrality) {
  if (std::isinf(df2)) {
    return normal_upper((f * df1 - df1 - non_centrality) / std::sqrt(2.0 * (df1 + 2.0 * non_centrality)));
  }
  return bm::cdf(bm::chi_squared_distribution<double, Quiet>{df2}, df2 * (df1 + non_centrality) / (f * df1));
}

}  // namespace

double non_central_f_upper(double f, double df1, double df2, double non_centrality) {
  require(!std::isnan(f), "non_central_f_upper: f must be a number");
  require(df1 > 0.0 && std::isfinite(df1), "non_central_f_upper: df1 must be > 0 and finite");
  require_df(df2, "non_central_f_upper: df2 must be > 0");
  require(non_centrality >= 0.0 && std::isfinite(non_centrality),
          "non_central_f_upper: non_centrality must be >= 0 and finite");
  if (non_centrality == 0.0) return f_upper(f, df1, df2);
  if (f <= 0.0) return 1.0;
  if (std::isinf(f)) return 0.0;
  constexpr double kFar = 1e9;
  if (non_centrality > kFar) return far_f_upper(f, df1, df2, non_centrality);
  if (std::isinf(df2))
    return bm::cdf(
        bm::complement(bm::non_central_chi_squared_distribution<double, Quiet>{df1, non_centrality}, f * df1));
  return bm::cdf(bm::complement(bm::non_central_f_distribution<double, Quiet>{df1, df2, non_centrality}, f));
}

double non_central_t_lower(double t, double df, double non_centrality) {
  require(!std::isnan(t), "non_central_t_lower: t must be a number");
  require_df(df, "non_central_t_lower: df must be > 0");
  require(std::isfinite(non_centrality), "non_central_t_lower: non_centrality must be finite");
  if (std::isinf(t)) return t > 0.0 ? 1.0 : 0.0;
  if (std::isinf(df)) return normal_upper(non_centrality - t);
  constexpr double kFar = 1e4;
  if (std::abs(non_centrality) <= kFar)
    return bm::cdf(bm::non_central_t_distribution<double, Quiet>{df, non_centrality}, t);
  // non_centrality / S <= t
  if ((t > 0.0) != (non_centrality > 0.0)) return t > 0.0 ? 1.0 : 0.0;
  const double squared = df * (non_centrality / t) * (non_centrality / t);
  const auto chi_squared = bm::chi_squared_distribution<double, Quiet>{df};
  return t > 0.0 ? bm::cdf(bm::complement(chi_squared, squared)) : bm::cdf(chi_squared, squared);
}

double gamma_ratio(double a, double b) {
  require(a > 0.0 && b > 0.0 && std::isfinite(a) && std::isfinite(b), "gamma_ratio: a and b must be > 0 and finite");
  return bm::tgamma_ratio(a, b, Quiet{});
}

}  // namespace kith
