#include "surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace kith {

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

}  // namespace kith
