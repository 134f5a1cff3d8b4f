#pragma once

namespace kith {

// Upper tails P(X > x) and quantiles, by Boost.Math behind one small header (its own take long to compile).
// Each throws std::invalid_argument for parameters that define no distribution; degrees of freedom may be infinite.

[[nodiscard]] double normal_upper(double z);
[[nodiscard]] double normal_quantile(double p);                 ///< p in (0, 1), lower tail
[[nodiscard]] double student_t_two_sided(double t, double df);  ///< P(|T| > |t|)
[[nodiscard]] double student_t_quantile(double p, double df);   ///< lower tail
[[nodiscard]] double f_upper(double f, double df1, double df2);
[[nodiscard]] double f_quantile(double p, double df1, double df2);  ///< lower tail
[[nodiscard]] double chi_squared_upper(double x, double df);
/// P(F > f) for the non-central F distribution: the power of an F test.
[[nodiscard]] double non_central_f_upper(double f, double df1, double df2, double non_centrality);

}  // namespace kith
