#include "kith/belief/prior_cover.hpp"

#include <stdexcept>
#include <utility>

#include "kith/geometry/cover.hpp"

namespace kith {

PriorCover::PriorCover(Cone prior, std::size_t particles, std::span<const std::size_t> axes, std::optional<Cone> known)
    : prior_{std::move(prior)}, known_{std::move(known)} {
  if (particles == 0) throw std::invalid_argument("PriorCover: a belief needs at least one particle");
  const std::size_t half = known_ ? particles / 2 : 0;
  Eigen::MatrixXd points(static_cast<Eigen::Index>(dimension()), static_cast<Eigen::Index>(particles));
  if (half > 0) {
    points.leftCols(static_cast<Eigen::Index>(half)) = cover(*known_, half, axes);
    const auto rest = static_cast<double>(particles - half);
    weights_.assign(half, 1.0);
    weights_.resize(particles, kBeyondKnown / (1.0 - kBeyondKnown) * static_cast<double>(half) / rest);
  }
  points.rightCols(static_cast<Eigen::Index>(particles - half)) = cover(prior_, particles - half, axes);
  points_.reserve(static_cast<std::size_t>(points.size()));
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) points_.push_back(points(k, i));
  }
  for (const HalfSpace& facet : prior_.facets()) normals_.push_back(facet.unit());
}

}  // namespace kith
