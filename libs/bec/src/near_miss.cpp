#include "kith/bec/near_miss.hpp"

namespace kith {
namespace {

Direction unit_along(const IntegerVector& ray) {
  Direction result(static_cast<Eigen::Index>(ray.size()));
  for (std::size_t k = 0; k < ray.size(); ++k) result[static_cast<Eigen::Index>(k)] = static_cast<double>(ray[k]);
  return result.normalized();
}

}  // namespace

std::vector<Direction> near_misses(const Cone& region, std::span<const HalfSpace> facets, double miss) {
  const auto rays = region.generators();
  const auto dimension = static_cast<Eigen::Index>(region.dimension());
  Direction centre = Direction::Zero(dimension);
  for (const auto& ray : rays) centre += unit_along(ray);
  centre.normalize();
  std::vector<Direction> people;
  for (const HalfSpace& facet : facets) {
    Direction on_it = Direction::Zero(dimension);
    for (const auto& ray : rays) {
      if (sign_of_dot(facet.normal(), ray) == 0) on_it += unit_along(ray);
    }
    on_it.normalize();
    const Direction normal = facet.unit();
    people.push_back((on_it - miss * normal.dot(centre) * normal).normalized());
  }
  return people;
}

}  // namespace kith
