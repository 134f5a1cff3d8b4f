#include "kith/geometry/cover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "kith/core/assert.hpp"
#include "kith/geometry/cone_sampler.hpp"

namespace kith {
namespace {

constexpr double kInverseGoldenRatio = 1.0 / std::numbers::phi;

double fraction(double x) { return x - std::floor(x); }

}  // namespace

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

Eigen::MatrixXd cover(const Cone& region, std::size_t n) { return ConeSampler{region}.cover(n); }

Eigen::MatrixXd cover(const Cone& region, std::size_t n, std::span<const std::size_t> axes) {
  if (std::is_sorted(axes.begin(), axes.end())) return cover(region, n);
  Cone reordered{region.dimension()};
  for (const HalfSpace& facet : region.facets()) {
    IntegerVector normal(axes.size());
    for (std::size_t place = 0; place < axes.size(); ++place) normal[place] = facet.normal()[axes[place]];
    const bool has_interior = reordered.clip(HalfSpace{normal});
    KITH_ASSERT(has_interior);  // as the region has
  }
  const Eigen::MatrixXd points = cover(reordered, n);
  Eigen::MatrixXd result(points.rows(), points.cols());
  for (std::size_t place = 0; place < axes.size(); ++place)
    result.row(static_cast<Eigen::Index>(axes[place])) = points.row(static_cast<Eigen::Index>(place));
  return result;
}

std::vector<std::size_t> k_centres(const Eigen::MatrixXd& points, std::size_t k, std::size_t first) {
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

}  // namespace kith
