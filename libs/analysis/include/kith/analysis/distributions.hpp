#pragma once

namespace kith {

// Upper tails P(X > x) and quantiles, by Boost.Math behind one small header (its own take long to compile).
// Each throws std::invalid_argument for NaN and for parameters that define no distribution. Degrees of freedom of t
// and F may be infinite. Relative accuracy is about 1e-13 unless the probability is below 1e-300.

[[nodiscard]] double normal_upper(double z);
[[nodiscard]] double normal_quantile(double p);                 ///< p in (0, 1), lower tail
[[nodiscard]] double student_t_two_sided(double t, double df);  ///< P(|T| > |t|)
[[nodiscard]] double student_t_quantile(double p, double df);   ///< lower tail
[[nodiscard]] double f_upper(double f, double df1, double df2);
[[nodiscard]] double f_quantile(double p, double df1, double df2);  ///< lower tail
[[nodiscard]] double chi_squared_upper(double x, double df);        ///< df finite
/// P(F > f) for the non-central F distribution, the power of an F test. df1 is finite. Above a non-centrality of 1e9
/// the spread of the numerator, less than 1e-4 of it, is left out.
[[nodiscard]] double non_central_f_upper(double f, double df1, double df2, double non_centrality);

/// P(T <= t) for the non-central t distribution, that of (Z + non_centrality) / S, within 1e-8. Beyond a non-centrality
/// of 1e4 the spread of Z, less than 1e-4 of it, counts only where df is infinite.
[[nodiscard]] double non_central_t_lower(double t, double df, double non_centrality);
/// The non-centrality with which P(T <= t) = p, p in (0, 1): a confidence limit [steiger2004].
[[nodiscard]] double non_centrality_of_t(double t, double df, double p);
/// The non-centrality >= 0 with which P(F > f) = p, p in (0, 1); 0 if P(F > f) is above p without any [steiger2004].
[[nodiscard]] double non_centrality_of_f(double f, double df1, double df2, double p);

/// Gamma(a) / Gamma(b) for a, b > 0, without overflow where the ratio itself has none.
[[nodiscard]] double gamma_ratio(double a, double b);

}  // namespace kith
