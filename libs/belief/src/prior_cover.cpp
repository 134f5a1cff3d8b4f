#include "kith/belief/prior_cover.hpp"

#include <stdexcept>
#include <utility>

#include "kith/geometry/cover.hpp"

namespace kith {

PriorCover::PriorCover(Cone prior, std::size_t particles) : prior_{std::move(prior)} {
  if (particles == 0) throw std::invalid_argument("PriorCover: a belief needs at least one particle");
  const Eigen::Matrix3Xd points = fibonacci_cover(prior_, particles);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    x_.push_back(points(0, i));
    y_.push_back(points(1, i));
    z_.push_back(points(2, i));
  }
  for (const HalfSpace& facet : prior_.facets()) normals_.push_back(facet.unit_normal());
}

}  // namespace kith
