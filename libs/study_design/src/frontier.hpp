#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "surfaces.hpp"

namespace kith {

struct TradeOff {
  Quantity first, second;
};

// The quantities of the two most important means that are of different quantities; nothing if there are no two.
[[nodiscard]] std::optional<TradeOff> trade_off(std::span<const Target> targets);

// Root mean square of the misses of a quantity's means.
[[nodiscard]] double error_of(std::span<const Target> targets, std::span<const double> misses, Quantity quantity);

// Pairs of targets that can be met one by one but not so well together, worst first.
[[nodiscard]] std::vector<Conflict> find_conflicts(std::span<const Target> targets, const Surfaces& surfaces,
                                                   const RandomStream& random);

// Settings along the trade-off: minima of weighted sums of both errors, from all weight on the first to all on the
// second.
[[nodiscard]] std::vector<std::vector<double>> frontier_settings(const TargetSet& set, const Surfaces& surfaces,
                                                                 const TradeOff& quantities, std::size_t n,
                                                                 const RandomStream& random);

[[nodiscard]] std::vector<FrontierPoint> not_dominated(std::span<const Target> targets,
                                                       std::vector<CalibrationPoint> points,
                                                       const TradeOff& quantities);

}  // namespace kith
