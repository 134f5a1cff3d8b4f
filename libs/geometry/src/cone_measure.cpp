// Areas, and the area-preserving map from the unit square onto a cone.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "exact.hpp"
#include "kith/core/math.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

constexpr double kLongCosine = -0.5;  // of 120 degrees

Eigen::Vector3d in_space(const IntegerVector& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

// The angle between the two boundary arcs. Numerator and denominator of the
// tangent are exact integers before they are rounded, so thin lunes keep their digits.
double lune_angle(const HalfSpace& first, const HalfSpace& second) {
  const Eigen::Vector3d edge = in_space(detail::cross_of_normals(first, second));
  return math::atan2(edge.norm(), -static_cast<double>(dot(first.normal(), second.normal())));
}

// A triangle of the fan around the first ray of a polygon: corners at unit length, and its area.
struct FanTriangle {
  Eigen::Vector3d apex, from, to;
  double area;

  // Between nearly antipodal corners the arc is badly determined by the corners, though not by the facets.
  [[nodiscard]] bool is_long() const { return std::min({apex.dot(from), from.dot(to), to.dot(apex)}) < kLongCosine; }
};

// Girard: the sum of the interior angles less (n - 2) pi. Its error does not
// depend on the corners, but is absolute: only for areas that are not tiny.
double area_by_angles(std::span<const HalfSpace> facets) {
  const std::size_t n = facets.size();
  double excess = (2.0 - static_cast<double>(n)) * std::numbers::pi;
  for (std::size_t i = 0; i < n; ++i) excess += lune_angle(facets[i], facets[(i + 1) % n]);
  return excess;
}

// With r_i = f_i x f_(i+1), the triple product needs no numbers beyond 128 bits:
//   det(r_0, r_i, r_(i+1)) = (f_(i+1) . r_0) (f_i . r_(i+1)).
double triple_product(std::span<const HalfSpace> facets, std::span<const IntegerVector> rays, std::size_t i) {
  return static_cast<double>(detail::product(facets[i + 1], rays[0])) *
         static_cast<double>(detail::product(facets[i], rays[i + 1]));
}

FanTriangle fan_triangle(std::span<const HalfSpace> facets, std::span<const IntegerVector> rays, std::size_t i) {
  const Eigen::Vector3d a = in_space(rays[0]);
  const Eigen::Vector3d b = in_space(rays[i]);
  const Eigen::Vector3d c = in_space(rays[i + 1]);
  const double lengths = a.norm() * b.norm() * c.norm();
  FanTriangle triangle{a.normalized(), b.normalized(), c.normalized(), 0.0};
  const double numerator = triple_product(facets, rays, i) / lengths;
  const double denominator =
      1.0 + triangle.apex.dot(triangle.from) + triangle.from.dot(triangle.to) + triangle.to.dot(triangle.apex);
  triangle.area = 2.0 * math::atan2(numerator, denominator);
  return triangle;
}

// The point of height z on the axis, turned by `angle` from `zero` towards `quarter`; all three orthonormal.
Eigen::Vector3d turned(const Eigen::Vector3d& axis, const Eigen::Vector3d& zero, const Eigen::Vector3d& quarter,
                       double z, double angle) {
  const double radius = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
  return radius * (math::cos(angle) * zero + math::sin(angle) * quarter) + z * axis;
}

// Where the arc from -> to must be met by an arc through the apex that cuts off
// the area `part` next to `from`. Written with the tangent of half the distance
// along the arc, which has a closed form without cancellation: with d the
// direction of the arc at `from` and K = tan(part / 2), Van Oosterom and
// Strackee's formula for the corner x = from + tan(distance) d gives
//   tan(distance / 2) = K (1 + apex . from) / (det(apex, from, d) - K apex . d).
Eigen::Vector3d cut_off(const FanTriangle& t, double part) {
  const Eigen::Vector3d chord = t.to - t.from;
  const Eigen::Vector3d d = (chord - t.from * t.from.dot(chord)).normalized();
  const double sine = math::sin(part / 2.0);
  const double cosine = math::cos(part / 2.0);
  const double determinant = t.apex.dot(t.from.cross(d));
  const double y = sine * (1.0 + t.apex.dot(t.from));
  const double x = cosine * determinant - sine * t.apex.dot(d);
  const double square = x * x + y * y;
  if (!(square > 0.0)) return t.from;
  return (((x - y) * (x + y)) * t.from + (2.0 * x * y) * d) / square;
}

// The point that splits the arc from the apex to `end` so that the cap inside has the share v of the whole.
Eigen::Vector3d along(const Eigen::Vector3d& apex, const Eigen::Vector3d& end, double v) {
  const Eigen::Vector3d chord = end - apex;
  const double depth = v * chord.squaredNorm() / 2.0;  // 1 - cosine
  const Eigen::Vector3d tangent = chord - apex * apex.dot(chord);
  const double length = tangent.norm();
  if (!(length > 0.0)) return apex;
  return ((1.0 - depth) * apex + (std::sqrt(depth * (2.0 - depth)) / length) * tangent).normalized();
}

}  // namespace

double Cone::solid_angle() const {
  if (dimension_ != 3) return measure().value;
  if (facets_.empty()) return 4.0 * std::numbers::pi;
  if (facets_.size() == 1) return 2.0 * std::numbers::pi;
  if (facets_.size() == 2) return 2.0 * lune_angle(facets_[0], facets_[1]);
  double area = 0.0;
  for (std::size_t i = 1; i + 1 < rays_.size(); ++i) {
    const FanTriangle triangle = fan_triangle(facets_, rays_, i);
    if (triangle.is_long()) return area_by_angles(facets_);
    area += triangle.area;
  }
  return area;
}

Eigen::Vector3d Cone::equal_area_point(double u, double v) const {
  if (dimension_ != 3) throw std::invalid_argument{"Cone::equal_area_point: the cone must have three dimensions"};
  if (facets_.empty()) {
    return turned(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 1.0 - 2.0 * v,
                  2.0 * std::numbers::pi * u);
  }
  if (facets_.size() == 1) {
    const Eigen::Vector3d& normal = facets_.front().unit_normal();
    const Eigen::Vector3d zero = normal.unitOrthogonal();
    return turned(normal, zero, normal.cross(zero), 1.0 - v, 2.0 * std::numbers::pi * u);
  }
  if (facets_.size() == 2) {
    const Eigen::Vector3d edge = in_space(detail::cross_of_normals(facets_[0], facets_[1])).normalized();
    const Eigen::Vector3d& inward = facets_[0].unit_normal();
    return turned(edge, edge.cross(inward), inward, 1.0 - 2.0 * v, u * lune_angle(facets_[0], facets_[1]));
  }
  double left = u * solid_angle();
  FanTriangle triangle = fan_triangle(facets_, rays_, 1);
  for (std::size_t i = 2; i + 1 < rays_.size() && left >= triangle.area; ++i) {
    left -= triangle.area;
    triangle = fan_triangle(facets_, rays_, i);
  }
  return along(triangle.apex, cut_off(triangle, std::clamp(left, 0.0, triangle.area)), v);
}

Eigen::Vector3d Cone::sample(RandomStream& random) const {
  const double u = uniform01(random);
  return equal_area_point(u, uniform01(random));
}

}  // namespace kith
