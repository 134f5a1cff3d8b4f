#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kith/stats/fixed_effects.hpp"

namespace kith::detail {

struct RepeatedCount {
  double count = 0.0;
  double times = 0.0;
};

// The observations that share the levels of all factors: all that a log-linear model needs of them.
struct CountCell {
  double observed = 0.0;                // number of counts that are not censored
  double sum = 0.0;                     // of these
  double squares = 0.0;                 // of their deviations from their mean
  std::vector<RepeatedCount> censored;  // bounds
};

struct CountData {
  Eigen::MatrixXd columns;            // [cells, kept columns]
  std::vector<CountCell> cells;       // those with observations, in the order of the design's grid
  std::vector<RepeatedCount> counts;  // observed ones of all cells, ascending
  double log_factorials = 0.0;        // of the observed counts
  double mean = 0.0;                  // of all counts
};

// @param observed  which counts are not censored; none: all.
[[nodiscard]] CountData count_data(std::span<const double> counts, const std::vector<bool>& observed,
                                   const FactorDesign& design);

// Whether a direction of the coefficients only lowers cells of zeros and raises cells of nothing but censored counts,
// and leaves all others alone: then the likelihood has no maximum.
[[nodiscard]] bool is_separated(const CountData& data);

// A log-linear model with variance mu + mu^2 / theta; Poisson's has infinite theta.
struct CountFit {
  double theta = std::numeric_limits<double>::infinity();
  Eigen::VectorXd coefficients;
  double log_likelihood = 0.0;
};

// The fits of largest likelihood, of infinite theta and of any; nothing if the search does not end.
// The data are not separated.
[[nodiscard]] std::optional<CountFit> fit_poisson(const CountData& data);
[[nodiscard]] std::optional<CountFit> fit_negative_binomial(const CountData& data);

// The inverse of the expected information of the coefficients; where counts are censored, of the observed information
// of coefficients and log(theta), which is left out of what is returned.
[[nodiscard]] Eigen::MatrixXd covariance_of(const CountData& data, const CountFit& fit);

}  // namespace kith::detail
