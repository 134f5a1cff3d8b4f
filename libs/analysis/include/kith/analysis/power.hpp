#pragma once

#include <cstddef>

namespace kith {

/// Power of the F test of a term with `df` numerator degrees of freedom in a design of `observations` observations
/// and `cells` cells at level alpha, if the population's partial eta squared is `eta_squared`: non-central F with
/// non-centrality observations * eta^2 / (1 - eta^2) [cohen1988, section 8.3].
/// @throws std::invalid_argument unless 0 <= eta_squared < 1, 0 < alpha < 1, df >= 1, observations > cells.
[[nodiscard]] double f_test_power(double eta_squared, std::size_t df, std::size_t cells, std::size_t observations,
                                  double alpha);

/// Partial eta squared that belongs to a published F(df1, df2): F df1 / (F df1 + df2).
[[nodiscard]] double eta_squared_of_f(double f, double df1, double df2);

}  // namespace kith
