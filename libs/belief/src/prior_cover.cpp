#include "kith/belief/prior_cover.hpp"

#include <stdexcept>
#include <utility>

#include "kith/geometry/cover.hpp"

namespace kith {

PriorCover::PriorCover(Cone prior, std::size_t particles, std::span<const std::size_t> axes)
    : prior_{std::move(prior)} {
  if (particles == 0) throw std::invalid_argument("PriorCover: a belief needs at least one particle");
  const Eigen::MatrixXd points = cover(prior_, particles, axes);
  points_.reserve(static_cast<std::size_t>(points.size()));
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) points_.push_back(points(k, i));
  }
  for (const HalfSpace& facet : prior_.facets()) normals_.push_back(facet.unit());
}

}  // namespace kith
