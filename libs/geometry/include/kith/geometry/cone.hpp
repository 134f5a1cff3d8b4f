#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/geometry/eigen.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// An area on the unit sphere of d dimensions, and how well it is known.
struct SolidAngle {
  double value = 0.0;           ///< Steradian in three dimensions, radians of the circle in two.
  double standard_error = 0.0;  ///< 0 where the value comes from a closed form, up to rounding.
};

/// The area of the whole unit sphere of d dimensions, 2 pi^(d/2) / Gamma(d/2): 2 pi
/// of the circle, 4 pi of the sphere in space. @throws std::invalid_argument if d == 0.
[[nodiscard]] double sphere_area(std::size_t dimension);

/// A full-dimensional convex cone in d = 2 to 8 dimensions: the intersection of
/// finitely many half-spaces that has a non-empty interior. On the unit sphere in
/// three dimensions it is the whole sphere (no facet), a hemisphere (1), a lune (2)
/// or a convex spherical polygon (3 or more); on the circle it is an arc.
///
/// All predicates are exact: facets are canonical integer half-spaces, extreme
/// rays are integer vectors, signs are taken in 128-bit arithmetic.
///
/// Built by clipping, one half-space at a time; what is left of the facets is the
/// minimal (irredundant) set by construction. In three dimensions in O(facets)
/// each; in others by the double description method (of Motzkin and others),
/// whose cost grows with the number of extreme rays. Extreme rays must have
/// entries of 64 bits: certain in three dimensions, in d if the lengths of the
/// normals stay below 2^(63/(d-1)) (2^21 for d = 4, 512 for d = 8); beyond that
/// clipping may throw std::overflow_error, and leaves the cone as it was.
class Cone {
 public:
  /// The whole sphere in three dimensions.
  Cone() = default;
  /// The whole sphere in d dimensions. @throws std::invalid_argument unless 2 <= d <= 8.
  explicit Cone(std::size_t dimension);

  /// The intersection of all of them, or nothing if its interior is empty
  /// (touching in a ray or a plane only counts as empty). An empty list gives
  /// the whole sphere in three dimensions: for other d clip a Cone{d}.
  /// @throws std::invalid_argument unless all have the same dimension.
  [[nodiscard]] static std::optional<Cone> intersection(std::span<const HalfSpace> half_spaces);

  /// d, 2 to 8.
  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }

  /// Clips in place: removes what lies outside `half_space`. Returns false, and
  /// leaves the cone as it was, if no interior would be left. In three dimensions
  /// O(facets), for loops that clip millions of times, since it allocates only
  /// when the cone grows. @throws std::invalid_argument unless the dimensions are equal.
  [[nodiscard]] bool clip(const HalfSpace& half_space);
  /// The same with each of them. Returns false, with some of them applied, if no interior is left.
  [[nodiscard]] bool clip(std::span<const HalfSpace> half_spaces);

  /// This cone without what lies outside `half_space`; nothing if no interior is left.
  [[nodiscard]] std::optional<Cone> clipped(const HalfSpace& half_space) const;

  /// Whether every point of the cone satisfies `half_space` (it would be redundant).
  [[nodiscard]] bool implies(const HalfSpace& half_space) const;
  /// Whether the boundary plane of `half_space` passes through the interior.
  [[nodiscard]] bool is_cut_by(const HalfSpace& half_space) const;

  /// The irredundant half-spaces; in three dimensions counter-clockwise seen from outside.
  [[nodiscard]] std::span<const HalfSpace> facets() const noexcept { return facets_; }
  /// The irredundant half-spaces sorted lexicographically: the canonical minimal set.
  [[nodiscard]] std::vector<HalfSpace> minimal_set() const;

  /// Integer vectors whose non-negative combinations are exactly this cone: the
  /// extreme rays; for lunes, hemispheres and the sphere a ray inside each facet
  /// (or the normal), and both directions of every line. In other than three
  /// dimensions: one ray for each extreme ray modulo the lines, sorted, then the
  /// lines; the same for equal cones.
  [[nodiscard]] std::vector<IntegerVector> generators() const;

  /// An integer direction strictly inside every facet: for a polygon, and in other
  /// than three dimensions, the sum of the extreme rays. @throws std::overflow_error
  /// if an entry would leave 64 bits, which in three dimensions cannot happen while
  /// normals stay below 2^24.
  [[nodiscard]] IntegerVector interior_direction() const;

  /// Area on the unit sphere, in (0, sphere_area(d)]. In three dimensions, in
  /// steradian, polygons by the formula of [vanoosterom1983] over a triangle fan,
  /// which stays accurate for tiny regions because the triple products are exact;
  /// by Girard's theorem where corners of the fan are more than 120 degrees apart.
  /// In two, the angle in radians. In more, measure().value.
  [[nodiscard]] double solid_angle() const;
  /// The same with its standard error; above three dimensions by ConeSampler, which
  /// takes milliseconds. The same bits for equal cones.
  [[nodiscard]] SolidAngle measure() const;

  /// In double precision: every margin is at least 0. @pre d = 3.
  [[nodiscard]] bool contains(const Eigen::Vector3d& w) const noexcept;
  /// The same in d dimensions, w of shape [d] (asserted).
  template <typename Derived>
  [[nodiscard]] bool contains(const Eigen::MatrixBase<Derived>& w) const {
    return std::all_of(facets_.begin(), facets_.end(), [&](const HalfSpace& facet) { return facet.contains(w); });
  }
  /// Exactly, for an integer direction, shape [d].
  [[nodiscard]] bool contains(const IntegerVector& w) const;

  /// The point of the unit sphere that an area-preserving map of the unit square
  /// onto the cone assigns to (u, v), both in [0, 1): equal areas of the square
  /// become equal areas of the cone. `u` turns about a centre (the axis of the
  /// sphere or hemisphere, the edge of a lune, the first extreme ray of a
  /// polygon), `v` leads away from it. Polygons by the two steps of [arvo1995],
  /// continued over a triangle fan; inside up to rounding.
  /// @throws std::invalid_argument unless d = 3: ConeSampler is for all d.
  [[nodiscard]] Eigen::Vector3d equal_area_point(double u, double v) const;

  /// A uniform draw from the cone's part of the unit sphere: equal_area_point of
  /// two uniform numbers; 4 draws of 32 bits.
  /// @throws std::invalid_argument unless d = 3: ConeSampler is for all d.
  [[nodiscard]] Eigen::Vector3d sample(RandomStream& random) const;

  /// Same set of directions.
  friend bool operator==(const Cone& a, const Cone& b);

 private:
  friend class ConeSampler;  // reads rays and lines

  [[nodiscard]] bool clip_lune(const HalfSpace& half_space);
  [[nodiscard]] bool clip_polygon(const HalfSpace& half_space);
  void replace_rays(const HalfSpace& half_space, std::size_t begin, std::size_t end);
  void to_triangle(const HalfSpace& half_space, int orientation);
  [[nodiscard]] std::vector<IntegerVector> generators_in_space() const;
  [[nodiscard]] IntegerVector interior_direction_in_space() const;

  // Where d is not 3.
  [[nodiscard]] bool clip_beyond_space(const HalfSpace& half_space);
  [[nodiscard]] bool clip_rays(const HalfSpace& half_space);
  void clip_line(const HalfSpace& half_space, std::size_t line);
  void cut_rays(const HalfSpace& half_space, std::span<const int> sides, std::span<const Int128> products);

  std::size_t dimension_ = 3;
  std::vector<HalfSpace> facets_;
  // d = 3: extreme rays of a polygon, rays_[i] = facets_[i] x facets_[i + 1] (cyclic); empty below 3 facets.
  // Otherwise: one primitive ray for each extreme ray modulo the lines, zero where a line has its first entry.
  std::vector<IntegerVector> rays_;
  // Where d is not 3: the largest subspace inside, as the rows of a reduced echelon form, each primitive.
  std::vector<IntegerVector> lines_;
  // Where d is not 3: bit k of the words of ray i: it lies on the boundary of facets_[k].
  std::vector<std::uint64_t> tight_;
};

/// The irredundant half-spaces of the set, sorted lexicographically, or nothing
/// if the intersection has no interior.
[[nodiscard]] std::optional<std::vector<HalfSpace>> minimal_set(std::span<const HalfSpace> half_spaces);

/// Whether the intersection has interior points.
[[nodiscard]] bool has_interior(std::span<const HalfSpace> half_spaces);

/// Cone::solid_angle of the intersection; 0 if it has no interior.
[[nodiscard]] double solid_angle(std::span<const HalfSpace> half_spaces);

/// An irreducible subset of the half-spaces whose intersection has no interior:
/// none of them can be left out. In the given order; at most d + 1 of them, by
/// Helly's theorem; empty if the whole set has interior points. Deletion filter
/// [chinneck1991]: earlier half-spaces are dropped first. Names a clash to people.
[[nodiscard]] std::vector<HalfSpace> irreducible_conflict(std::span<const HalfSpace> half_spaces);

}  // namespace kith
