#include "kith/geometry/cover.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "kith/geometry/cone_sampler.hpp"

namespace kith {
namespace {

constexpr double kInverseGoldenRatio = 1.0 / std::numbers::phi;

// Weiszfeld's iteration stops here, or once the centre moves by less than this (radian).
constexpr int kMedianSteps = 100;
constexpr double kMedianMove = 1e-12;
// Keeps the weight of a point finite where the centre meets it.
constexpr double kMedianSoftening = 1e-10;

double fraction(double x) { return x - std::floor(x); }

Eigen::Vector3d on_sphere(double z, double azimuth) {
  const double radius = std::sqrt((1.0 - z) * (1.0 + z));
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

void check_weights(Eigen::Index num_points, std::span<const double> weights) {
  if (static_cast<std::size_t>(num_points) != weights.size()) {
    throw std::invalid_argument{"geodesic_median: there must be one weight for each point"};
  }
  double sum = 0.0;
  for (const double weight : weights) {
    if (!(weight >= 0.0)) throw std::invalid_argument{"geodesic_median: every weight must be at least 0"};
    sum += weight;
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    throw std::invalid_argument{"geodesic_median: the weights must have a positive, finite sum"};
  }
}

std::size_t heaviest(std::span<const double> weights) {
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

template <typename Points>
std::vector<std::size_t> greedy_centres(const Points& points, std::size_t k, std::size_t first) {
  const auto n = static_cast<std::size_t>(points.cols());
  if (k > n || first >= n) {
    throw std::invalid_argument{"k_centres: k = " + std::to_string(k) + " and first = " + std::to_string(first) +
                                " must lie within the " + std::to_string(n) + " points"};
  }
  std::vector<std::size_t> centres;
  // closest[i]: cosine of the angle from point i to the nearest centre; a chosen point is never the farthest again.
  Eigen::VectorXd closest = Eigen::VectorXd::Constant(points.cols(), -2.0);
  for (std::size_t next = first; centres.size() < k;) {
    centres.push_back(next);
    closest = closest.cwiseMax(points.transpose() * points.col(static_cast<Eigen::Index>(next)));
    closest[static_cast<Eigen::Index>(next)] = 3.0;
    Eigen::Index farthest = 0;
    for (Eigen::Index i = 1; i < closest.size(); ++i) {
      if (closest[i] < closest[farthest]) farthest = i;
    }
    next = static_cast<std::size_t>(farthest);
  }
  return centres;
}

template <typename Point, typename Points>
Point weiszfeld(const Points& points, std::span<const double> weights) {
  check_weights(points.cols(), weights);
  Point centre = Point::Zero(points.rows());
  for (int step = 0; step < kMedianSteps; ++step) {
    Point sum = Point::Zero(points.rows());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      // The sine of the angle: the gradient of an angle grows like 1 / sine per unit of chord.
      const double sine =
          std::sqrt((points.col(i) - centre * centre.dot(points.col(i))).squaredNorm() + kMedianSoftening);
      sum += weights[static_cast<std::size_t>(i)] / sine * points.col(i);
    }
    const double length = sum.norm();
    if (!(length > kMedianMove)) {
      if (step > 0) return centre;
      return points.col(static_cast<Eigen::Index>(heaviest(weights)));
    }
    const Point next = sum / length;
    const double move = (next - centre).norm();
    centre = next;
    if (move < kMedianMove) break;
  }
  return centre;
}

}  // namespace

Eigen::Matrix3Xd fibonacci_cover(std::size_t n) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto t = static_cast<double>(i);
    const double z = 1.0 - (2.0 * t + 1.0) / static_cast<double>(n);
    points.col(static_cast<Eigen::Index>(i)) = on_sphere(z, 2.0 * std::numbers::pi * fraction(t * kInverseGoldenRatio));
  }
  return points;
}

Eigen::Matrix3Xd fibonacci_cover(const Cone& region, std::size_t n) {
  if (n == 0) throw std::invalid_argument{"fibonacci_cover: a cover needs at least one point"};
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto t = static_cast<double>(i);
    points.col(static_cast<Eigen::Index>(i)) =
        region.equal_area_point(fraction(0.5 + t * kInverseGoldenRatio), (t + 0.5) / static_cast<double>(n));
  }
  return points;
}

Eigen::Matrix3Xd deserno_cover(std::size_t n) {
  if (n == 0) throw std::invalid_argument{"deserno_cover: a cover needs at least one point"};
  const double cell = 4.0 * std::numbers::pi / static_cast<double>(n);
  const auto num_rings = static_cast<int>(std::max(1.0, std::round(std::numbers::pi / std::sqrt(cell))));
  const double spacing = cell / (std::numbers::pi / num_rings);
  std::vector<Eigen::Vector3d> points;
  for (int ring = 0; ring < num_rings; ++ring) {
    const double polar = std::numbers::pi * (ring + 0.5) / num_rings;
    const auto in_ring = static_cast<int>(std::round(2.0 * std::numbers::pi * std::sin(polar) / spacing));
    for (int k = 0; k < in_ring; ++k) {
      points.push_back(on_sphere(std::cos(polar), 2.0 * std::numbers::pi * k / in_ring));
    }
  }
  Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

Eigen::MatrixXd cover(const Cone& region, std::size_t n) { return ConeSampler{region}.cover(n); }

std::vector<std::size_t> k_centres(const Eigen::Matrix3Xd& points, std::size_t k, std::size_t first) {
  return greedy_centres(points, k, first);
}

std::vector<std::size_t> k_centres(const Eigen::MatrixXd& points, std::size_t k, std::size_t first) {
  return greedy_centres(points, k, first);
}

Eigen::Vector3d geodesic_median(const Eigen::Matrix3Xd& points, std::span<const double> weights) {
  return weiszfeld<Eigen::Vector3d>(points, weights);
}

Direction geodesic_median(const Eigen::MatrixXd& points, std::span<const double> weights) {
  return weiszfeld<Direction>(points, weights);
}

}  // namespace kith
