#include "naive_filter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kith/core/distributions.hpp"

namespace kith::rivals {

NaiveFilter::NaiveFilter(const ParticleBelief& start, std::span<const HalfSpace> prior, const RandomStream& random)
    : options_{start.options()},
      prior_{prior.begin(), prior.end()},
      random_{random},
      weights_{start.weights().begin(), start.weights().end()} {
  for (std::size_t i = 0; i < start.size(); ++i) {
    points_.push_back(start.point(i));
    log_weights_.push_back(std::log(weights_[i]));
  }
}

void NaiveFilter::observe(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (const HalfSpace& h : half_spaces) log_weights_[i] += likelihood.log_relative(h.margin(points_[i]));
    largest = std::max(largest, log_weights_[i]);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    log_weights_[i] -= largest;
    weights_[i] = std::exp(log_weights_[i]);
    sum += weights_[i];
  }
  double squares = 0.0;
  for (double& weight : weights_) {
    weight /= sum;
    squares += weight * weight;
  }
  if (1.0 / squares < options_.resample_below * static_cast<double>(points_.size())) resample();
}

void NaiveFilter::resample() {
  const auto n = static_cast<double>(points_.size());
  const double noise = options_.process_noise * spread() * std::pow(n, -1.0 / 6.0);
  std::vector<Eigen::Vector3d> next;
  const double offset = uniform01(random_);
  double reached = weights_[0];
  std::size_t from = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const double at = (static_cast<double>(k) + offset) / n;
    while (reached < at && from + 1 < points_.size()) reached += weights_[++from];
    next.push_back(moved(points_[from], noise));
  }
  points_.swap(next);
  std::fill(log_weights_.begin(), log_weights_.end(), 0.0);
  std::fill(weights_.begin(), weights_.end(), 1.0 / n);
}

Eigen::Vector3d NaiveFilter::moved(const Eigen::Vector3d& point, double noise) {
  constexpr int kTries = 20;
  const Eigen::Vector3d other = std::abs(point.z()) < 0.5 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d first = point.cross(other).normalized();
  const Eigen::Vector3d second = point.cross(first);
  for (int i = 0; i < kTries; ++i) {
    const double angle = noise * std::sqrt(-2.0 * std::log(1.0 - uniform01(random_)));
    const double turn = 2.0 * std::numbers::pi * uniform01(random_);
    const Eigen::Vector3d direction = std::cos(turn) * first + std::sin(turn) * second;
    const Eigen::Vector3d there = std::cos(angle) * point + std::sin(angle) * direction;
    if (is_inside(there)) return there;
  }
  return point;
}

bool NaiveFilter::is_inside(const Eigen::Vector3d& point) const {
  return std::all_of(prior_.begin(), prior_.end(), [&](const HalfSpace& h) { return h.contains(point); });
}

Eigen::Vector3d NaiveFilter::mean_direction() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points_.size(); ++i) sum += weights_[i] * points_[i];
  return sum.normalized();
}

double NaiveFilter::spread() const {
  const Eigen::Vector3d mean = mean_direction();
  double sum = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double angle = std::acos(std::clamp(mean.dot(points_[i]), -1.0, 1.0));
    sum += weights_[i] * angle * angle;
  }
  return std::sqrt(sum);
}

}  // namespace kith::rivals
