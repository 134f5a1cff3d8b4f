#pragma once

#include <vector>

#include "kith/fit/population_fit.hpp"

namespace kith::detail {

// log of the sum of the exponentials.
[[nodiscard]] double log_sum(const std::vector<double>& logs);

// fit_mixture() with a weight per person, in no order of the types.
[[nodiscard]] MixtureFit fit_weighted_mixture(const LikelihoodSurface& surface, std::size_t num_types,
                                              const PopulationLimits& limits, const std::vector<double>& weights);

}  // namespace kith::detail
