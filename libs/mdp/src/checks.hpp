#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith::detail {

inline void require(bool condition, const char* function, const char* rule) {
  if (!condition) throw std::invalid_argument{std::string{function} + ": " + rule};
}

inline void require_exact(const Mdp& mdp, std::size_t num_weights, const char* function) {
  require(mdp.is_deterministic() && mdp.is_integral() && mdp.discount() == 1.0, function,
          "the process must be deterministic, integral and undiscounted");
  require(num_weights == mdp.num_features(), function, "there must be one weight per feature");
}

inline void require_weights(const Mdp& mdp, std::span<const double> weights, const char* function) {
  require(weights.size() == mdp.num_features(), function, "there must be one weight per feature");
  require(std::ranges::all_of(weights, [](double w) { return std::isfinite(w); }), function, "weights must be finite");
}

// w . phi of every feature row, summed from the first feature on.
inline std::vector<double> row_rewards(const Mdp& mdp, std::span<const double> weights) {
  std::vector<double> rewards(mdp.num_feature_rows(), 0.0);
  for (std::size_t row = 0; row < rewards.size(); ++row) {
    const auto phi = mdp.feature_row(row);
    for (std::size_t k = 0; k < weights.size(); ++k) rewards[row] += weights[k] * phi[k];
  }
  return rewards;
}

// The same exactly; so small that no value of a path overflows, even on the way into a positive cycle.
inline std::vector<std::int64_t> row_rewards(const Mdp& mdp, const IntegerVector& weights, const char* function) {
  const Int128 limit = (Int128{1} << 60) / static_cast<Int128>(mdp.num_states() + 1);
  std::vector<std::int64_t> rewards(mdp.num_feature_rows());
  for (std::size_t row = 0; row < rewards.size(); ++row) {
    const Int128 reward = dot(weights, mdp.integer_feature_row(row));
    require(-limit <= reward && reward <= limit, function, "the weights are too large for exact values");
    rewards[row] = static_cast<std::int64_t>(reward);
  }
  return rewards;
}

}  // namespace kith::detail
