#include "general_kernels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kith/core/distributions.hpp"
#include "kith/core/math.hpp"
#include "scratch.hpp"

namespace kith::detail {
namespace {

constexpr int kRetries = 20;

// out[i] = u . point i.
void margins(const AxisPoints& points, const Direction& u, std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t k = 0; k < points.dimension; ++k) {
    const double factor = u[static_cast<Eigen::Index>(k)];
    if (factor == 0.0) continue;
    const double* const axis = points.axis(k).data();
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += factor * axis[i];
  }
}

Direction point_at(std::span<const double> values, std::size_t dimension, std::size_t i) {
  const std::size_t n = values.size() / dimension;
  Direction point(static_cast<Eigen::Index>(dimension));
  for (std::size_t k = 0; k < dimension; ++k) point[static_cast<Eigen::Index>(k)] = values[k * n + i];
  return point;
}

// Where the exponential map at p takes a tangent vector, which is given in the d - 1 coordinates that the reflection of
// the last axis to p (or to -p, whichever is further from it) leaves.
Direction moved(const Direction& p, std::span<const double> tangent) {
  const Eigen::Index last = p.size() - 1;
  double square = 0.0;
  Direction step = Direction::Zero(p.size());
  for (Eigen::Index k = 0; k < last; ++k) {
    step[k] = tangent[static_cast<std::size_t>(k)];
    square += step[k] * step[k];
  }
  if (square == 0.0) return p;
  Direction mirror = p;
  mirror[last] += p[last] >= 0.0 ? 1.0 : -1.0;
  step -= (2.0 * mirror.dot(step) / mirror.squaredNorm()) * mirror;
  const double angle = std::sqrt(square);
  return (math::cos(angle) * p + (math::sin(angle) / angle) * step).normalized();
}

Direction moved_inside(const Direction& p, double angle, std::span<const Direction> normals, RandomStream& random) {
  std::array<double, IntegerVector::kMaxDimension> normal{};
  const std::span<double> tangent{normal.data(), static_cast<std::size_t>(p.size()) - 1};
  for (int attempt = 0; attempt <= kRetries; ++attempt) {
    fill_standard_normal(tangent, random);
    for (double& x : tangent) x *= angle;
    const Direction to = moved(p, tangent);
    if (std::all_of(normals.begin(), normals.end(), [&](const Direction& u) { return u.dot(to) >= 0.0; })) return to;
  }
  return p;
}

}  // namespace

void log_relative_products(const AxisPoints& points, std::span<const HalfSpace> half_spaces,
                           const HalfSpaceLikelihood& likelihood, std::span<double> out) {
  std::vector<HalfSpace> sorted{half_spaces.begin(), half_spaces.end()};
  std::sort(sorted.begin(), sorted.end());
  std::fill(out.begin(), out.end(), 0.0);
  ParticleScratch<double> scratch{points.size()};
  const std::span<double> t = scratch.values();
  for (const HalfSpace& half_space : sorted) {
    margins(points, half_space.unit(), t);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += likelihood.log_relative(t[i]);
  }
}

void gather(const AxisPoints& points, std::span<const std::uint32_t> index, std::span<double> out) {
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < points.dimension; ++k) {
    const std::span<const double> axis = points.axis(k);
    for (std::size_t i = 0; i < n; ++i) out[k * n + i] = axis[index[i]];
  }
}

Direction weighted_sum(const AxisPoints& points, std::span<const double> weights) {
  Direction sum = Direction::Zero(static_cast<Eigen::Index>(points.dimension));
  for (std::size_t k = 0; k < points.dimension; ++k) {
    const std::span<const double> axis = points.axis(k);
    for (std::size_t i = 0; i < weights.size(); ++i) sum[static_cast<Eigen::Index>(k)] += weights[i] * axis[i];
  }
  return sum;
}

double weighted_square_angles(const AxisPoints& points, std::span<const double> weights, const Direction& centre) {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    // By the chord, which is accurate for small angles too.
    const double chord = (point_at(points.values, points.dimension, i) - centre).norm();
    const double angle = 2.0 * math::asin(std::min(1.0, 0.5 * chord));
    sum += weights[i] * angle * angle;
  }
  return sum;
}

double weight_inside(const AxisPoints& points, std::span<const double> weights,
                     std::span<const HalfSpace> half_spaces) {
  std::vector<bool> inside(points.size(), true);
  ParticleScratch<double> scratch{points.size()};
  const std::span<double> t = scratch.values();
  for (const HalfSpace& half_space : half_spaces) {
    margins(points, half_space.unit(), t);
    for (std::size_t i = 0; i < t.size(); ++i) inside[i] = inside[i] && t[i] >= 0.0;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += inside[i] ? weights[i] : 0.0;
  return sum;
}

void move_points(std::span<double> values, std::size_t dimension, double angle, std::span<const Direction> normals,
                 RandomStream& random) {
  const std::size_t n = values.size() / dimension;
  for (std::size_t i = 0; i < n; ++i) {
    const Direction to = moved_inside(point_at(values, dimension, i), angle, normals, random);
    for (std::size_t k = 0; k < dimension; ++k) values[k * n + i] = to[static_cast<Eigen::Index>(k)];
  }
}

}  // namespace kith::detail
