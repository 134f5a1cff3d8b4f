#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// How much of a belief that begins with what people know lies outside it: they may be wrong about what they know, or
/// have forgotten it.
inline constexpr double kBeyondKnown = 0.05;

/// Where particle beliefs over one prior begin: exactly M points of a regular
/// cover of the prior's part of the unit sphere, with the prior's facets. It
/// depends on (prior, M, axes) only and takes far longer to compute than to copy, so
/// whoever builds many beliefs makes one and passes it around.
class PriorCover {
 public:
  /// @param prior the hard prior; may be the whole sphere. @param particles M. @param axes the axes in the order that
  /// cover() is to take them; empty: as they are.
  /// @param known  a region in the prior that people know: half of the points cover it, with a mass of 1 -
  /// kBeyondKnown. Of the others one in d + 1 lies anywhere in the prior; the rest are known weights with another value
  /// of one feature, as most updates change one thing.
  /// @throws std::invalid_argument if particles is 0.
  PriorCover(Cone prior, std::size_t particles, std::span<const std::size_t> axes = {}, std::optional<Cone> known = {});

  [[nodiscard]] const Cone& prior() const noexcept { return prior_; }
  [[nodiscard]] const std::optional<Cone>& known() const noexcept { return known_; }
  /// M.
  [[nodiscard]] std::size_t size() const noexcept { return points_.size() / dimension(); }
  /// Of the points, relative to the largest; empty: all weigh the same. Shape [size()].
  [[nodiscard]] const std::vector<double>& weights() const noexcept { return weights_; }
  /// d.
  [[nodiscard]] std::size_t dimension() const noexcept { return prior_.dimension(); }
  /// Coordinates of the points, axis by axis, shape [d, size()].
  [[nodiscard]] const std::vector<double>& points() const noexcept { return points_; }
  /// Shape [d], of length 1. @pre i < size().
  [[nodiscard]] Direction point(std::size_t i) const {
    Direction point(static_cast<Eigen::Index>(dimension()));
    for (std::size_t k = 0; k < dimension(); ++k) point[static_cast<Eigen::Index>(k)] = points_[k * size() + i];
    return point;
  }
  /// Unit normals of the prior's facets.
  [[nodiscard]] const std::vector<Direction>& normals() const noexcept { return normals_; }

 private:
  Cone prior_;
  std::optional<Cone> known_;
  std::vector<double> points_;
  std::vector<double> weights_;
  std::vector<Direction> normals_;
};

}  // namespace kith
