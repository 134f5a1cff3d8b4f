// Areas on spheres of any dimension.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "exact.hpp"
#include "guide_table.hpp"
#include "kith/core/math.hpp"
#include "kith/geometry/cone_sampler.hpp"
#include "nearest_point.hpp"
#include "simplex_points.hpp"

namespace kith {
namespace {

// The angle between two boundaries, inside. The components of a ^ b, whose length is the sine, are exact integers
// before they are rounded, so thin cones keep their digits.
double angle_between(const HalfSpace& first, const HalfSpace& second) {
  const IntegerVector& a = first.normal();
  const IntegerVector& b = second.normal();
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = i + 1; j < a.size(); ++j) {
      const auto minor = static_cast<double>(a[i] * b[j] - a[j] * b[i]);
      square += minor * minor;
    }
  }
  return math::atan2(std::sqrt(square), -static_cast<double>(dot(a, b)));
}

// [vanoosterom1983]
double triangle_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, double content) {
  return 2.0 * math::atan2(content, 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
}

double factorial(std::size_t n) { return n < 2 ? 1.0 : static_cast<double>(n) * factorial(n - 1); }

}  // namespace

double sphere_area(std::size_t dimension) {
  if (dimension == 0) throw std::invalid_argument{"sphere_area: there is no sphere in zero dimensions"};
  if (dimension == 1) return 2.0;
  const double circle = 2.0 * std::numbers::pi;
  return dimension == 2 ? circle : circle / static_cast<double>(dimension - 2) * sphere_area(dimension - 2);
}

SolidAngle Cone::measure() const {
  if (dimension_ == 2) {
    if (facets_.size() < 2) return {facets_.empty() ? 2.0 * std::numbers::pi : std::numbers::pi, 0.0};
    return {angle_between(facets_[0], facets_[1]), 0.0};
  }
  if (dimension_ == 3) return {solid_angle(), 0.0};
  return ConeSampler{*this}.solid_angle();
}

// Of the sphere of the dimensions beside the lines; that of the whole sphere is the same.
double ConeSampler::closed_form_share() const {
  if (rank_ == 0) return 1.0;
  if (rank_ == 1) return 0.5;
  if (rank_ == 2) return angle_between(cone_.facets()[0], cone_.facets()[1]) / (2.0 * std::numbers::pi);
  double area = 0.0;
  for (const Part& part : parts_) {
    const auto chosen = detail::chosen_columns(rays_, part.rays, 3);
    area += triangle_area(chosen.col(0), chosen.col(1), chosen.col(2), part.content);
  }
  return area / (4.0 * std::numbers::pi);
}

// Parts are chosen half in proportion to their likely areas, half to bounds of them, so that no weight is large.
std::vector<double> ConeSampler::shares(std::size_t points) const {
  double all_likely = 0.0;
  double all_most = 0.0;
  const auto likely = [&](const Part& part) { return part.content * detail::half_power(part.typical, rank_); };
  const auto most = [&](const Part& part) { return part.content * detail::half_power(part.peak, rank_); };
  for (const Part& part : parts_) {
    all_likely += likely(part);
    all_most += most(part);
  }
  std::vector<double> cumulative;
  double sum = 0.0;
  for (const Part& part : parts_) cumulative.push_back(sum += likely(part) / all_likely + most(part) / all_most);

  const detail::GuideTable guide{cumulative};
  const auto contribution = [&](double which, std::span<const double> lambda) {
    const std::size_t i = guide.find(which);
    const Part& part = parts_[i];
    Direction x = Direction::Zero(static_cast<Eigen::Index>(rank_));
    for (std::size_t k = 0; k < rank_; ++k) x += lambda[k] * rays_.col(static_cast<Eigen::Index>(part.rays[k]));
    const double chance = (cumulative[i] - (i == 0 ? 0.0 : cumulative[i - 1])) / sum;
    return part.content / (detail::half_power(x.squaredNorm(), rank_) * chance);
  };
  std::optional<detail::SimplexPoints> own;
  if (points > detail::kAreaPoints) own.emplace(rank_, detail::area_shifts(), points);
  const auto& list = own ? *own : detail::area_points(rank_);
  const std::size_t stride = list.size() / detail::kAreaEstimates;
  std::vector<double> estimates;
  for (std::size_t e = 0; e < detail::kAreaEstimates; ++e) {
    double estimate = 0.0;
    for (std::size_t n = e * stride; n < e * stride + points; ++n)
      estimate += contribution(list.which(n), list.lambda(n));
    estimates.push_back(estimate / static_cast<double>(points) / factorial(rank_ - 1) / sphere_area(rank_));
  }
  return estimates;
}

SolidAngle ConeSampler::solid_angle(std::size_t points) const {
  if (points == 0) throw std::invalid_argument{"ConeSampler: an estimate needs at least one point"};
  if (dimension() <= 3) return cone_.measure();
  const double whole = sphere_area(dimension());
  if (rank_ <= 3) return {whole * closed_form_share(), 0.0};
  const std::vector<double> estimates = shares(points);
  double mean = 0.0;
  for (const double x : estimates) mean += x / static_cast<double>(detail::kAreaEstimates);
  double squares = 0.0;
  for (const double x : estimates) squares += (x - mean) * (x - mean);
  return {whole * mean,
          whole * std::sqrt(squares / static_cast<double>(detail::kAreaEstimates * (detail::kAreaEstimates - 1)))};
}

}  // namespace kith
