#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "minimize.hpp"
#include "surfaces.hpp"

namespace kith {

// How badly a setting fits, by surfaces of its figures:
//   r' V^-1 r,  V = A + tau^2 I
// with r the misses in published standard errors, A their covariance by chance (published, simulated, of the surfaces)
// and tau the standard deviation of what the model cannot remove, one for all targets [kennedy2001]. Twice the negative
// log-likelihood of normal figures less a constant.
class Misfit {
 public:
  Misfit(const Surfaces& surfaces, double discrepancy);

  [[nodiscard]] double at(std::span<const double> unit) const;
  // Of given misses.
  [[nodiscard]] double of(std::span<const double> misses) const;
  // The least over the box with some coordinates fixed: the best of a sample, improved.
  [[nodiscard]] std::vector<double> minimum(const Fixed& fixed, const RandomStream& random) const;
  // The nearest minimum, by the method of Levenberg and Marquardt within the box.
  [[nodiscard]] std::vector<double> improved(std::vector<double> unit, const Fixed& fixed) const;
  // How many parameters the figures determine here: the trace of the hat matrix when the box is a prior of the same
  // variance. Between 0 and the number of parameters.
  [[nodiscard]] double effective_parameters(std::span<const double> unit) const;

 private:
  [[nodiscard]] Eigen::VectorXd whitened(std::span<const double> misses) const;
  [[nodiscard]] Eigen::MatrixXd jacobian(std::span<const double> unit) const;

  const Surfaces& surfaces_;
  Eigen::MatrixXd root_;  // V^-1 = root' root
};

// The discrepancy at which the least misfit is what chance leaves: as large as the number of targets less that of
// parameters that they determine [paule1982]; 0 if it is that small without one, or nothing is left to judge by.
struct DiscrepancyEstimate {
  double discrepancy = 0.0;         // tau, in published standard errors
  double misfit = 0.0;              // least one without discrepancy
  double degrees_of_freedom = 0.0;  // of it
  std::vector<double> unit;         // where the misfit with this discrepancy is least
};
[[nodiscard]] DiscrepancyEstimate estimate_discrepancy(const Surfaces& surfaces, const RandomStream& random);

// By how much the misfit has to exceed its least value for a setting of one parameter to be outside of its 95 %
// interval: the square of a normal quantile, or of a t quantile where the discrepancy, which is a scale, was estimated
// from the same misses [knapp2003].
[[nodiscard]] double significant_loss(const DiscrepancyEstimate& estimate);

// The values of parameter k at which, the others adjusted, the misfit is at most `limit`; ends at the box's edge where
// it does not exceed it before.
struct ProfileInterval {
  double low = 0.0, high = 0.0;
  bool reaches_low = false, reaches_high = false;
};
[[nodiscard]] ProfileInterval profile_interval(const Misfit& misfit, const Box& box, std::span<const double> best,
                                               std::size_t k, double limit);

}  // namespace kith
