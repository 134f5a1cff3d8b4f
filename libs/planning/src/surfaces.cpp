#include "surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kith/planning/space_filling.hpp"

namespace kith {
namespace {

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
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = compared(targets[t], evaluations[i].figures[t]);
    surfaces_.emplace_back(local, values);
  }
  // Mean correlation over the settings, each by its own jackknife.
  const auto n = static_cast<Eigen::Index>(targets.size());
  correlation_ = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(n, n);
  for (const auto& evaluation : evaluations) {
    const auto covariance = covariance_of(targets, evaluation);
    mean += covariance / static_cast<double>(evaluations.size());
    const Eigen::VectorXd sd = covariance.diagonal().cwiseMax(1e-12).cwiseSqrt();
    correlation_ += sd.cwiseInverse().asDiagonal() * covariance * sd.cwiseInverse().asDiagonal();
  }
  // A little less than estimated, so that it can be inverted whatever the number of replicates.
  constexpr double kShare = 0.95;
  correlation_ *= kShare / static_cast<double>(evaluations.size());
  correlation_.diagonal().setOnes();
  set_covariance(mean);
}

void Surfaces::set_covariance(const Eigen::MatrixXd& simulation) {
  covariance_ = correlation_ + simulation;
  for (Eigen::Index t = 0; t < covariance_.rows(); ++t) {
    const double error = miss_error(static_cast<std::size_t>(t));
    covariance_(t, t) += error * error;
  }
}

void Surfaces::correct(std::span<const double> unit, const Evaluation& exact) {
  const auto local = box_.local(unit);
  for (std::size_t t = 0; t < targets_.size(); ++t)
    offsets_[t] = compared(targets_[t], exact.figures[t]) - surfaces_[t].at(local);
  set_covariance(covariance_of(targets_, exact));
}

std::vector<double> Surfaces::misses_at(std::span<const double> unit) const {
  const auto local = box_.local(unit);
  std::vector<double> misses;
  misses.reserve(targets_.size());
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const double value = surfaces_[t].at(local) + offsets_[t];
    misses.push_back((value - compared(targets_[t], targets_[t].value)) / published_error(targets_[t]));
  }
  return misses;
}

// The prediction's variance is the residual one times the leverage, whose mean is terms over points.
double Surfaces::miss_error(std::size_t target) const {
  const auto d = static_cast<double>(box_.low.size());
  const double terms = 1.0 + 2.0 * d + d * (d - 1.0) / 2.0;
  const double leverage = std::min(1.0, terms / static_cast<double>(num_points_));
  return std::sqrt(leverage) * surfaces_[target].error() / published_error(targets_[target]);
}

double Surfaces::error_of(std::size_t target) const {
  return surfaces_[target].error() * (targets_[target].is_factor ? targets_[target].value : 1.0);
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
