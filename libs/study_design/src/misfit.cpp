#include "misfit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "kith/stats/distributions.hpp"

namespace kith {
namespace {

std::vector<std::size_t> free_coordinates(const Fixed& fixed) {
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    if (!fixed[k]) free.push_back(k);
  }
  return free;
}

}  // namespace

Misfit::Misfit(const Surfaces& surfaces, double discrepancy) : surfaces_{surfaces} {
  Eigen::MatrixXd variance = surfaces.covariance();
  variance.diagonal().array() += discrepancy * discrepancy;
  const Eigen::LLT<Eigen::MatrixXd> factor{variance};
  root_ = factor.matrixL().solve(Eigen::MatrixXd::Identity(variance.rows(), variance.cols()));
}

Eigen::VectorXd Misfit::whitened(std::span<const double> misses) const {
  const Eigen::Map<const Eigen::VectorXd> r{misses.data(), static_cast<Eigen::Index>(misses.size())};
  return root_ * r;
}

double Misfit::of(std::span<const double> misses) const { return whitened(misses).squaredNorm(); }

double Misfit::at(std::span<const double> unit) const { return of(surfaces_.misses_at(unit)); }

Eigen::MatrixXd Misfit::jacobian(std::span<const double> unit) const {
  constexpr double kStep = 1e-4;
  Eigen::MatrixXd result(root_.rows(), static_cast<Eigen::Index>(unit.size()));
  std::vector<double> point(unit.begin(), unit.end());
  for (std::size_t k = 0; k < unit.size(); ++k) {
    point[k] = unit[k] + kStep;
    const Eigen::VectorXd above = whitened(surfaces_.misses_at(point));
    point[k] = unit[k] - kStep;
    const Eigen::VectorXd below = whitened(surfaces_.misses_at(point));
    point[k] = unit[k];
    result.col(static_cast<Eigen::Index>(k)) = (above - below) / (2.0 * kStep);
  }
  return result;
}

std::vector<double> Misfit::improved(std::vector<double> unit, const Fixed& fixed) const {
  constexpr std::size_t kMostSteps = 60;
  constexpr double kSmallGain = 1e-9;
  const auto& box = surfaces_.box();
  const auto free = free_coordinates(fixed);
  if (free.empty()) return unit;
  double value = at(unit);
  double damping = 1e-3;
  for (std::size_t step = 0; step < kMostSteps && damping < 1e9; ++step) {
    const Eigen::MatrixXd slopes = jacobian(unit);
    const Eigen::VectorXd residuals = whitened(surfaces_.misses_at(unit));
    // Coordinates at an edge that would leave the box stay there.
    std::vector<std::size_t> active;
    for (const auto k : free) {
      const double gradient = slopes.col(static_cast<Eigen::Index>(k)).dot(residuals);
      const bool leaves = (unit[k] <= box.low[k] && gradient > 0.0) || (unit[k] >= box.high[k] && gradient < 0.0);
      if (!leaves) active.push_back(k);
    }
    if (active.empty()) return unit;
    Eigen::MatrixXd some(slopes.rows(), static_cast<Eigen::Index>(active.size()));
    for (std::size_t j = 0; j < active.size(); ++j)
      some.col(static_cast<Eigen::Index>(j)) = slopes.col(static_cast<Eigen::Index>(active[j]));
    Eigen::MatrixXd normal = some.transpose() * some;
    normal.diagonal().array() += damping * (1.0 + normal.diagonal().array());
    const Eigen::VectorXd move = normal.ldlt().solve(some.transpose() * residuals);
    auto next = unit;
    for (std::size_t j = 0; j < active.size(); ++j) {
      const auto k = active[j];
      next[k] = std::clamp(unit[k] - move[static_cast<Eigen::Index>(j)], box.low[k], box.high[k]);
    }
    const double there = at(next);
    if (there < value) {
      const double gain = value - there;
      unit = std::move(next);
      value = there;
      damping = std::max(damping / 5.0, 1e-9);
      if (gain < kSmallGain * (1.0 + value)) return unit;
    } else {
      damping *= 4.0;
    }
  }
  return unit;
}

std::vector<double> Misfit::minimum(const Fixed& fixed, const RandomStream& random) const {
  constexpr std::size_t kSample = 1024;
  constexpr std::size_t kImproved = 6;
  const Objective here = [&](std::span<const double> unit) { return at(unit); };
  const auto sample = ranked_sample(here, surfaces_.box(), fixed, kSample, random);
  std::vector<double> best;
  double least = 0.0;
  for (std::size_t i = 0; i < kImproved; ++i) {
    auto point = improved(sample[i].unit, fixed);
    const double value = at(point);
    if (!best.empty() && value >= least) continue;
    least = value;
    best = std::move(point);
  }
  return best;
}

double Misfit::effective_parameters(std::span<const double> unit) const {
  const Eigen::MatrixXd slopes = jacobian(unit);
  const Eigen::MatrixXd information = slopes.transpose() * slopes;
  Eigen::MatrixXd with_prior = information;
  for (Eigen::Index k = 0; k < information.cols(); ++k) {
    const auto place = static_cast<std::size_t>(k);
    const double width = surfaces_.box().high[place] - surfaces_.box().low[place];
    with_prior(k, k) += 12.0 / (width * width);  // the variance of a uniform distribution is width^2 / 12
  }
  return with_prior.ldlt().solve(information).trace();
}

DiscrepancyEstimate estimate_discrepancy(const Surfaces& surfaces, const RandomStream& random) {
  constexpr double kFewestDegrees = 0.5;
  constexpr std::size_t kSteps = 30;
  const Fixed none(surfaces.box().low.size());
  const auto num_targets = static_cast<double>(surfaces.covariance().rows());
  DiscrepancyEstimate result;
  const Misfit exact{surfaces, 0.0};
  result.unit = exact.minimum(none, random);
  result.misfit = exact.at(result.unit);
  result.degrees_of_freedom = num_targets - exact.effective_parameters(result.unit);
  if (result.degrees_of_freedom < kFewestDegrees || result.misfit <= result.degrees_of_freedom) return result;
  // What is left over beyond chance; falls as the discrepancy grows.
  const auto excess = [&](double discrepancy) {
    const Misfit misfit{surfaces, discrepancy};
    result.unit = misfit.improved(result.unit, none);  // moves little as the discrepancy does
    return misfit.at(result.unit) - (num_targets - misfit.effective_parameters(result.unit));
  };
  double low = 0.0, high = 1.0;
  while (excess(high) > 0.0 && high < 1e6) {
    low = high;
    high *= 2.0;
  }
  for (std::size_t i = 0; i < kSteps && high - low > 1e-3 * high; ++i) {
    const double middle = (low + high) / 2.0;
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  result.discrepancy = (low + high) / 2.0;
  const Misfit misfit{surfaces, result.discrepancy};
  result.unit = misfit.minimum(none, random);
  return result;
}

double significant_loss(const DiscrepancyEstimate& estimate) {
  constexpr double kTail = 0.975;
  const bool is_estimated = estimate.discrepancy > 0.0;
  const double quantile =
      is_estimated ? student_t_quantile(kTail, estimate.degrees_of_freedom) : normal_quantile(kTail);
  return quantile * quantile;
}

ProfileInterval profile_interval(const Misfit& misfit, const Box& box, std::span<const double> best, std::size_t k,
                                 double limit) {
  constexpr std::size_t kSteps = 24;
  constexpr std::size_t kHalvings = 12;
  Fixed fixed(best.size());
  // The least misfit with coordinate k at a value, beginning at a setting nearby.
  const auto profiled = [&](std::vector<double>& near, double value) {
    fixed[k] = value;
    near[k] = value;
    near = misfit.improved(std::move(near), fixed);
    return misfit.at(near);
  };
  // Steps to the edge; the last step inside is the farthest, in case the profile has a hump.
  const auto end = [&](double edge, bool& reaches) {
    std::vector<double> near(best.begin(), best.end());
    double inside = best[k], outside = edge;
    auto last = near;
    bool is_outside = false;
    for (std::size_t i = 1; i <= kSteps; ++i) {
      const double value = best[k] + (edge - best[k]) * static_cast<double>(i) / static_cast<double>(kSteps);
      if (profiled(near, value) <= limit) {
        inside = value;
        last = near;
        is_outside = false;
      } else if (!is_outside) {
        outside = value;
        is_outside = true;
      }
    }
    reaches = !is_outside;
    if (reaches) return edge;
    for (std::size_t i = 0; i < kHalvings; ++i) {
      const double middle = (inside + outside) / 2.0;
      auto there = last;
      if (profiled(there, middle) <= limit) {
        inside = middle;
        last = there;
      } else {
        outside = middle;
      }
    }
    return inside;
  };
  ProfileInterval interval;
  interval.low = end(box.low[k], interval.reaches_low);
  interval.high = end(box.high[k], interval.reaches_high);
  return interval;
}

}  // namespace kith
