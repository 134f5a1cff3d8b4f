#include "kith/geometry/outline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "kith/core/math.hpp"

namespace kith {
namespace {

constexpr std::size_t kCircleCorners = 48;

using Points = std::vector<Eigen::Vector3d>;

// Half a turn or a whole one from `begin`, counter-clockwise about the axis; the end is left out.
void add_arc(Points& points, const Eigen::Vector3d& begin, const Eigen::Vector3d& axis, double angle, std::size_t n) {
  const Eigen::Vector3d side = axis.cross(begin);
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = angle * static_cast<double>(i) / static_cast<double>(n);
    points.push_back(math::cos(turn) * begin + math::sin(turn) * side);
  }
}

Points hemisphere(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d begin = normal.unitOrthogonal();
  Points points;
  add_arc(points, begin, normal, 2.0 * std::numbers::pi, kCircleCorners);
  return points;
}

// Seen from inside a half-space its border runs counter-clockwise about its normal.
Points lune(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Vector3d corner = a.cross(b).normalized();
  // The half circle about `a` from the corner has its middle at a x corner, which must be inside b.
  if (a.cross(corner).dot(b) < 0.0) corner = -corner;
  Points points;
  add_arc(points, corner, a, std::numbers::pi, kCircleCorners / 2);
  add_arc(points, -corner, b, std::numbers::pi, kCircleCorners / 2);
  return points;
}

Points polygon(const Cone& cone) {
  Points points;
  for (const auto& ray : cone.generators()) {
    Eigen::Vector3d point;
    for (Eigen::Index k = 0; k < 3; ++k) point[k] = static_cast<double>(ray[static_cast<std::size_t>(k)]);
    points.push_back(point.normalized());
  }
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    turn += points[i].cross(points[(i + 1) % points.size()]);
    centre += points[i];
  }
  if (turn.dot(centre) < 0.0) std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace

Points outline(const Cone& cone) {
  const auto facets = cone.facets();
  if (facets.empty()) return {};
  if (facets.size() == 1) return hemisphere(facets[0].unit_normal());
  if (facets.size() == 2) return lune(facets[0].unit_normal(), facets[1].unit_normal());
  return polygon(cone);
}

}  // namespace kith
