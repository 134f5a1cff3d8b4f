#pragma once

#include <cstddef>
#include <functional>

#include "kith/core/integer_vector.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// A vector of d = 2 to 8 numbers, stored in place: reward weights, mostly of length 1; shape [d].
using Direction = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;

/// A closed half-space through the origin, { w : normal . w >= 0 }, with an
/// integer normal in canonical form: entries without a common divisor. Two
/// half-spaces are the same set iff they compare equal.
///
/// One comparison of trajectories yields one of these: the reward weights that
/// prefer feature counts mu_a to mu_b satisfy (mu_a - mu_b) . w >= 0
/// [brown2019machine]. On the unit sphere the set is a closed hemisphere.
///
/// d = 2 to 8 dimensions, one for each reward feature; no units.
class HalfSpace {
 public:
  /// @throws std::invalid_argument if `normal` is zero, has not 2 to 8 entries, or
  /// if an entry of its canonical form is 2^31 or more in magnitude.
  explicit HalfSpace(const IntegerVector& normal);

  /// d, 2 to 8.
  [[nodiscard]] std::size_t dimension() const noexcept { return normal_.size(); }
  /// The canonical normal, shape [d].
  [[nodiscard]] const IntegerVector& normal() const noexcept { return normal_; }
  /// The normal at length 1, shape [d].
  [[nodiscard]] Direction unit() const;
  /// The normal at length 1 in three dimensions, shape [3]. @pre d = 3; zero otherwise.
  [[nodiscard]] const Eigen::Vector3d& unit_normal() const noexcept { return unit_; }

  /// Signed sine of the angle from the boundary great circle; in [-1, 1] for a
  /// unit vector w. @pre d = 3.
  [[nodiscard]] double margin(const Eigen::Vector3d& w) const noexcept { return unit_.dot(w); }
  /// The same in d dimensions, w of shape [d] (asserted).
  template <typename Derived>
  [[nodiscard]] double margin(const Eigen::MatrixBase<Derived>& w) const {
    KITH_ASSERT(static_cast<std::size_t>(w.size()) == dimension());
    if (dimension() == 3) return unit_.dot(Eigen::Vector3d{w(0), w(1), w(2)});
    double sum = 0.0;
    for (std::size_t k = 0; k < dimension(); ++k) {
      sum += static_cast<double>(normal_[k]) * w(static_cast<Eigen::Index>(k));
    }
    return sum * inverse_length_;
  }

  /// In double precision: margin(w) >= 0. @pre d = 3.
  [[nodiscard]] bool contains(const Eigen::Vector3d& w) const noexcept { return margin(w) >= 0.0; }
  /// The same in d dimensions, w of shape [d] (asserted).
  template <typename Derived>
  [[nodiscard]] bool contains(const Eigen::MatrixBase<Derived>& w) const {
    return margin(w) >= 0.0;
  }
  /// Exactly, for an integer direction, shape [d].
  [[nodiscard]] bool contains(const IntegerVector& w) const { return sign_of_dot(normal_, w) >= 0; }

  /// The half-space on the other side of the same boundary.
  [[nodiscard]] HalfSpace opposite() const { return HalfSpace{-normal_}; }

  friend bool operator==(const HalfSpace& a, const HalfSpace& b) noexcept { return a.normal_ == b.normal_; }
  friend auto operator<=>(const HalfSpace& a, const HalfSpace& b) noexcept { return a.normal_ <=> b.normal_; }

 private:
  IntegerVector normal_;
  Eigen::Vector3d unit_ = Eigen::Vector3d::Zero();
  double inverse_length_ = 0.0;  // where d is not 3
};

}  // namespace kith

template <>
struct std::hash<kith::HalfSpace> {
  std::size_t operator()(const kith::HalfSpace& h) const noexcept {
    return std::hash<kith::IntegerVector>{}(h.normal());
  }
};
