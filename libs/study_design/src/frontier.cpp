#include "frontier.hpp"

#include <algorithm>
#include <cmath>

#include "minimize.hpp"
#include "misfit.hpp"

namespace kith {

std::optional<TradeOff> trade_off(std::span<const Target> targets) {
  std::vector<const Target*> means;
  for (const auto& target : targets) {
    if (target.statistic == Statistic::kMean) means.push_back(&target);
  }
  std::stable_sort(means.begin(), means.end(),
                   [](const Target* a, const Target* b) { return a->priority < b->priority; });
  for (const auto* target : means) {
    if (target->quantity != means.front()->quantity) return TradeOff{means.front()->quantity, target->quantity};
  }
  return std::nullopt;
}

double error_of(std::span<const Target> targets, std::span<const double> misses, Quantity quantity) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i].statistic != Statistic::kMean || targets[i].quantity != quantity) continue;
    sum += misses[i] * misses[i];
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(sum / n) : 0.0;
}

std::vector<Conflict> find_conflicts(std::span<const Target> targets, const Surfaces& surfaces,
                                     const RandomStream& random) {
  constexpr double kMet = 0.5;       // published standard errors: a target that can be met alone
  constexpr double kConflict = 1.0;  // and what is beyond the error of the published figures
  const auto dimension = surfaces.box().low.size();
  const auto closest = [&](std::size_t i, std::size_t j) {
    const Objective worse = [&](std::span<const double> unit) {
      const auto misses = surfaces.misses_at(unit);
      return std::max(std::abs(misses[i]), std::abs(misses[j]));
    };
    return worse(minimum(worse, surfaces.box(), Fixed(dimension), random));
  };
  std::vector<std::size_t> reachable;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (closest(i, i) < kMet) reachable.push_back(i);
  }
  std::vector<Conflict> conflicts;
  for (std::size_t a = 0; a < reachable.size(); ++a) {
    for (std::size_t b = a + 1; b < reachable.size(); ++b) {
      const Conflict conflict{reachable[a], reachable[b], closest(reachable[a], reachable[b])};
      if (conflict.closest > kConflict) conflicts.push_back(conflict);
    }
  }
  std::stable_sort(conflicts.begin(), conflicts.end(),
                   [](const Conflict& a, const Conflict& b) { return a.closest > b.closest; });
  return conflicts;
}

std::vector<std::vector<double>> frontier_settings(const TargetSet& set, const Surfaces& surfaces,
                                                   const TradeOff& quantities, std::size_t n,
                                                   const RandomStream& random) {
  const auto dimension = set.parameters.size();
  const Misfit misfit{surfaces, 0.0};  // decides between settings that are equal in both quantities
  std::vector<std::vector<double>> settings;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0.5;
    const Objective weighted = [&](std::span<const double> unit) {
      const auto misses = surfaces.misses_at(unit);
      return (1.0 - share) * error_of(set.targets, misses, quantities.first) +
             share * error_of(set.targets, misses, quantities.second) + 1e-4 * misfit.at(unit);
    };
    const auto best = minimum(weighted, surfaces.box(), Fixed(dimension), random);
    settings.push_back(to_values(set.parameters, best));
  }
  return settings;
}

std::vector<FrontierPoint> not_dominated(std::span<const Target> targets, std::vector<CalibrationPoint> points,
                                         const TradeOff& quantities) {
  std::vector<FrontierPoint> all;
  for (auto& point : points) {
    std::vector<double> figures;
    for (const auto& outcome : point.targets) figures.push_back(outcome.model);
    const auto misses = misses_of(targets, figures);
    const double first = error_of(targets, misses, quantities.first);
    const double second = error_of(targets, misses, quantities.second);
    all.push_back({std::move(point), first, second});
  }
  std::stable_sort(all.begin(), all.end(), [](const FrontierPoint& a, const FrontierPoint& b) {
    return a.first_error != b.first_error ? a.first_error < b.first_error : a.second_error < b.second_error;
  });
  std::vector<FrontierPoint> frontier;
  for (auto& one : all) {
    if (frontier.empty() || one.second_error < frontier.back().second_error) frontier.push_back(std::move(one));
  }
  return frontier;
}

}  // namespace kith
