#include "surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kith/planning/space_filling.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

constexpr double kSmallest = 1e-12;

double scaled(const Target& target, double figure) {
  return target.is_factor ? std::log(std::max(figure, kSmallest)) : figure;
}

// One step length per coordinate, halved when no step helps.
void improve(const Objective& objective, const Box& box, const Fixed& fixed, std::vector<double>& point,
             double& value) {
  double step = 0.1;
  while (step > 1e-3) {
    bool better = false;
    for (std::size_t k = 0; k < point.size(); ++k) {
      if (fixed[k]) continue;
      for (const double sign : {-1.0, 1.0}) {
        auto other = point;
        other[k] = std::clamp(point[k] + sign * step * (box.high[k] - box.low[k]), box.low[k], box.high[k]);
        const double there = objective(other);
        if (there < value) {
          value = there;
          point = std::move(other);
          better = true;
        }
      }
    }
    if (!better) step /= 2.0;
  }
}

}  // namespace

Surfaces::Surfaces(std::span<const Target> targets, Box box, std::span<const std::vector<double>> points,
                   std::span<const Evaluation> evaluations)
    : targets_{targets}, box_{std::move(box)}, num_points_{points.size()}, offsets_(targets.size(), 0.0) {
  std::vector<std::vector<double>> local;
  for (const auto& point : points) local.push_back(box_.local(point));
  std::vector<double> values(points.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = scaled(targets[t], evaluations[i].figures[t]);
    surfaces_.emplace_back(local, values);
  }
}

void Surfaces::correct(std::span<const double> unit, const Evaluation& exact) {
  const auto local = box_.local(unit);
  for (std::size_t t = 0; t < targets_.size(); ++t)
    offsets_[t] = scaled(targets_[t], exact.figures[t]) - surfaces_[t].at(local);
}

std::vector<double> Surfaces::misses_at(std::span<const double> unit) const {
  const auto local = box_.local(unit);
  std::vector<double> misses;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const double value = surfaces_[t].at(local) + offsets_[t];
    misses.push_back(miss(targets_[t], targets_[t].is_factor ? std::exp(value) : value));
  }
  return misses;
}

// The prediction's variance is the residual one times the leverage, whose mean is terms over points.
double Surfaces::miss_error(std::size_t target) const {
  const auto d = static_cast<double>(box_.low.size());
  const double terms = 1.0 + 2.0 * d + d * (d - 1.0) / 2.0;
  const double leverage = std::min(1.0, terms / static_cast<double>(num_points_));
  const auto& one = targets_[target];
  const double tolerance = one.is_factor ? std::log(one.tolerance) : one.tolerance;
  return std::sqrt(leverage) * surfaces_[target].error() / tolerance;
}

double Surfaces::discrepancy_at(std::span<const double> unit) const {
  // The middles of ten slices of equal probability of a standard normal, for the mean over one target's error; the
  // discrepancy is a sum over targets.
  constexpr std::array<double, 5> kSlices{0.1257, 0.3853, 0.6745, 1.0364, 1.6449};
  const auto misses = misses_at(unit);
  double sum = 0.0;
  for (std::size_t t = 0; t < misses.size(); ++t) {
    const double error = miss_error(t);
    for (const double slice : kSlices) {
      for (const double sign : {-1.0, 1.0}) {
        const double miss = misses[t] + sign * slice * error;
        sum += 0.1 * discrepancy(targets_.subspan(t, 1), std::span{&miss, 1});
      }
    }
  }
  return sum;
}

double Surfaces::error_of(std::size_t target) const {
  return surfaces_[target].error() * (targets_[target].is_factor ? targets_[target].value : 1.0);
}

double Surfaces::noise_at(std::span<const double> unit, RandomStream random) const {
  constexpr std::size_t kDraws = 400;
  const auto misses = misses_at(unit);
  const double here = discrepancy(targets_, misses);
  double sum = 0.0;
  for (std::size_t i = 0; i < kDraws; ++i) {
    auto moved = misses;
    for (std::size_t t = 0; t < moved.size(); ++t) {
      moved[t] += miss_error(t) * standard_normal(random);
    }
    const double change = discrepancy(targets_, moved) - here;
    sum += change * change;
  }
  return std::sqrt(sum / static_cast<double>(kDraws));
}

std::vector<double> minimum(const Objective& objective, const Box& box, const Fixed& fixed,
                            const RandomStream& random) {
  constexpr std::size_t kSample = 2048;
  constexpr std::size_t kImproved = 5;
  auto points = latin_hypercube(kSample, fixed.size(), 1, random);
  std::vector<double> values;
  for (auto& point : points) {
    point = box.place(point);
    for (std::size_t k = 0; k < fixed.size(); ++k) {
      if (fixed[k]) point[k] = *fixed[k];
    }
    values.push_back(objective(point));
  }
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::size_t best = order.front();
  for (std::size_t i = 0; i < kImproved; ++i) {
    improve(objective, box, fixed, points[order[i]], values[order[i]]);
    if (values[order[i]] < values[best]) best = order[i];
  }
  return points[best];
}

}  // namespace kith
