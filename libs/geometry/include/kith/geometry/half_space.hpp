#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>

#include "kith/core/integer_vector.hpp"

namespace kith {

/// A closed half-space through the origin, { w : normal . w >= 0 }, with an
/// integer normal in canonical form: entries without a common divisor. Two
/// half-spaces are the same set iff they compare equal.
///
/// One comparison of trajectories yields one of these: the reward weights that
/// prefer feature counts mu_a to mu_b satisfy (mu_a - mu_b) . w >= 0
/// [brown2019machine]. On the unit sphere the set is a closed hemisphere.
///
/// Three dimensions (d = 3 reward features; a domain with fewer pads with
/// zeros); no units.
class HalfSpace {
 public:
  /// @throws std::invalid_argument if `normal` is zero, has not three entries, or
  /// if an entry of its canonical form is 2^31 or more in magnitude.
  explicit HalfSpace(const IntegerVector& normal);

  /// The canonical normal, shape [3].
  [[nodiscard]] const IntegerVector& normal() const noexcept { return normal_; }
  /// The normal at length 1, shape [3].
  [[nodiscard]] const Eigen::Vector3d& unit_normal() const noexcept { return unit_; }

  /// Signed sine of the angle from the boundary great circle; in [-1, 1] for a unit vector w.
  [[nodiscard]] double margin(const Eigen::Vector3d& w) const noexcept { return unit_.dot(w); }
  /// In double precision: margin(w) >= 0.
  [[nodiscard]] bool contains(const Eigen::Vector3d& w) const noexcept { return margin(w) >= 0.0; }
  /// Exactly, for an integer direction, shape [3].
  [[nodiscard]] bool contains(const IntegerVector& w) const { return sign_of_dot(normal_, w) >= 0; }

  /// The half-space on the other side of the same boundary.
  [[nodiscard]] HalfSpace opposite() const { return HalfSpace{-normal_}; }

  friend bool operator==(const HalfSpace& a, const HalfSpace& b) noexcept { return a.normal_ == b.normal_; }
  friend auto operator<=>(const HalfSpace& a, const HalfSpace& b) noexcept { return a.normal_ <=> b.normal_; }

 private:
  IntegerVector normal_;
  Eigen::Vector3d unit_;
};

}  // namespace kith

template <>
struct std::hash<kith::HalfSpace> {
  std::size_t operator()(const kith::HalfSpace& h) const noexcept {
    return std::hash<kith::IntegerVector>{}(h.normal());
  }
};
