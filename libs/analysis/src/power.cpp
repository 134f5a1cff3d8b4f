#include "kith/analysis/power.hpp"

#include <cmath>
#include <stdexcept>

#include "kith/analysis/distributions.hpp"

namespace kith {

double f_test_power(double eta_squared, std::size_t df, std::size_t cells, std::size_t observations, double alpha) {
  if (!(eta_squared >= 0.0 && eta_squared < 1.0))
    throw std::invalid_argument{"f_test_power: eta_squared must be in [0, 1)"};
  if (!(alpha > 0.0 && alpha < 1.0)) throw std::invalid_argument{"f_test_power: alpha must be in (0, 1)"};
  if (df < 1 || observations <= cells)
    throw std::invalid_argument{"f_test_power: df must be >= 1, and observations more than cells"};
  const auto df1 = static_cast<double>(df);
  const auto df2 = static_cast<double>(observations - cells);
  const double non_centrality = static_cast<double>(observations) * eta_squared / (1.0 - eta_squared);
  return non_central_f_upper(f_quantile(1.0 - alpha, df1, df2), df1, df2, non_centrality);
}

double eta_squared_of_f(double f, double df1, double df2) {
  if (!(f >= 0.0 && df1 > 0.0 && df2 > 0.0) || std::isinf(f) || std::isinf(df1) || std::isinf(df2))
    throw std::invalid_argument{"eta_squared_of_f: f must be >= 0, degrees of freedom > 0, all finite"};
  return f * df1 / (f * df1 + df2);
}

}  // namespace kith
