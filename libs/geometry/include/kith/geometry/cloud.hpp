#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "kith/geometry/cone_sampler.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// A share of an area, and how well it is known.
struct Share {
  double value = 0.0;           ///< [0, 1].
  double standard_error = 0.0;  ///< That of as many independent draws, (k + 1/2 inside of n + 1); never 0.
};

/// Fixed points that cover a cone evenly, with which the areas of many parts of
/// it are compared: a half-space is one bit per point, an intersection the
/// conjunction of words, its share of the area a count of bits. For loops that
/// try thousands of half-spaces over one region, where an area of its own for
/// each would take milliseconds. n points do not see parts of less than 1/n.
class Cloud {
 public:
  /// One bit per point, in words; bits beyond the last point are 0.
  using Mask = std::vector<std::uint64_t>;

  /// @throws std::invalid_argument if num_points == 0.
  Cloud(const ConeSampler& region, std::size_t num_points) : points_{region.cover(num_points).transpose()} {}

  /// Shape [d, n].
  [[nodiscard]] Eigen::MatrixXd points() const { return points_.transpose(); }
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(points_.rows()); }

  /// Which points the half-space contains; O(d n). Keep it where the half-space recurs.
  /// @throws std::invalid_argument unless the dimensions are equal.
  [[nodiscard]] Mask mask(const HalfSpace& half_space) const;
  /// Which points all of them contain: all points for none.
  [[nodiscard]] Mask mask(std::span<const HalfSpace> half_spaces) const;

  /// The share of the region's area in which all of the masks hold; O(n / 64) each. All of it for none.
  /// @throws std::invalid_argument unless the masks have the cloud's size.
  [[nodiscard]] Share share(std::span<const Mask* const> masks) const;
  [[nodiscard]] Share share(std::initializer_list<const Mask*> masks) const {
    return share(std::span<const Mask* const>{masks.begin(), masks.size()});
  }

 private:
  [[nodiscard]] std::size_t num_words() const noexcept { return (size() + 63) / 64; }
  [[nodiscard]] Mask everything() const;

  Eigen::MatrixXd points_;  // shape [n, d]: axis by axis
};

}  // namespace kith
