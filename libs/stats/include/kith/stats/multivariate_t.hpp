#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kith {

/// The distribution of max_i |T_i| of k statistics T_i = Z_i / S: Z is jointly normal with means 0, variances 1 and the
/// given correlations, and df S^2 an independent chi-squared with df degrees of freedom, which may be infinite.
///
/// Of comparisons with a control in a one-way design it is Dunnett's [dunnett1955]. Where the correlations are
/// products, r_ij = l_i l_j, as there, tails are the double integral that defines them, within 1e-9 relative. For any
/// other correlations, including singular ones, the integral over directions is a mean over 2^17 fixed points, within
/// 1e-4 relative for up to 10 statistics.
class LargestT {
 public:
  /// @param correlations  [k, k], row-major, k >= 1.
  /// @throws std::invalid_argument unless it is a symmetric positive semidefinite matrix with diagonal 1.
  explicit LargestT(std::span<const double> correlations);

  /// P(max |T_i| > t). @throws std::invalid_argument unless t >= 0 and df > 0.
  [[nodiscard]] double upper(double t, double df) const;
  /// The t with upper(t, df) = p, for p in (0, 1).
  [[nodiscard]] double quantile(double p, double df) const;

 private:
  struct Direction {
    double squared_reach = 0.0;  // Mean of max_i (a_i . u)^-2 over directions u that are near each other in it.
    double share = 0.0;          // of all directions
  };

  std::size_t size_ = 0;
  std::size_t rank_ = 0;
  std::vector<double> loadings_;       // |l_i|, ascending, if correlations are products
  std::vector<Direction> directions_;  // otherwise
};

}  // namespace kith
