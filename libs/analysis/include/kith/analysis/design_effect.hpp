#pragma once

#include <cstddef>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"

namespace kith {

/// How much less rows say about a mean because rows of a group are alike.
struct DesignEffect {
  std::size_t observations = 0;
  std::size_t groups = 0;            ///< Levels with observations.
  double mean_group_size = 0.0;      ///< n / groups
  double weighted_group_size = 0.0;  ///< m = sum n_g^2 / n, the size of the group of a row, on average
  double intraclass_correlation = 0.0;
  /// 1 + (m - 1) * intraclass correlation: the variance of the mean of all rows over what it would be if they were
  /// independent, sum_g n_g (1 + (n_g - 1) icc) / n. Below 1 if rows of a group differ more than others.
  double design_effect = 1.0;
  double effective_observations = 0.0;  ///< n / design effect
};

/// The design effect of groups of any sizes [kish1965].
/// @param intraclass_correlation  in [-1, 1], such as a mixed model's.
/// @throws std::invalid_argument if it is not, or a code is no level.
/// Not estimable without observations, or if the correlation is so negative that no data have it.
[[nodiscard]] Estimable<DesignEffect> design_effect(const Factor& groups, double intraclass_correlation);

}  // namespace kith
