#include "kith/belief/prior_cover.hpp"

#include <algorithm>
#include <cmath>
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
  // What is known of all features but one, with the share of that one which it has in a point of the prior.
  for (std::size_t j = 0; half > 0 && j < particles - half; ++j) {
    const auto k = static_cast<Eigen::Index>(j % (dimension() + 1));
    if (k == points.rows()) continue;
    auto point = points.col(static_cast<Eigen::Index>(half + j));
    Direction like = points.col(static_cast<Eigen::Index>(j % half));
    like[k] = 0.0;
    like *= std::sqrt(1.0 - std::min(1.0, point[k] * point[k])) / std::max(like.norm(), 1e-9);
    like[k] = point[k];
    if (prior_.contains(like)) point = like.normalized();
  }
  points_.reserve(static_cast<std::size_t>(points.size()));
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) points_.push_back(points(k, i));
  }
  for (const HalfSpace& facet : prior_.facets()) normals_.push_back(facet.unit());
}

}  // namespace kith
