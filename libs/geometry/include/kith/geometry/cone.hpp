#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/geometry/half_space.hpp"
#include "kith/random/distributions.hpp"

namespace kith {

/// A full-dimensional convex cone in three dimensions: the intersection of
/// finitely many half-spaces that has a non-empty interior. On the unit sphere
/// it is the whole sphere (no facet), a hemisphere (1), a lune (2) or a convex
/// spherical polygon (3 or more).
///
/// All predicates are exact: facets are canonical integer half-spaces, extreme
/// rays are integer cross products, signs are taken in 128-bit arithmetic.
///
/// Built by clipping, one half-space at a time, in O(facets) each; what is left
/// of the facets is the minimal (irredundant) set by construction.
class Cone {
 public:
  /// The whole sphere.
  Cone() = default;

  /// The intersection of all of them, or nothing if its interior is empty
  /// (touching in a ray or a plane only counts as empty). An empty list gives
  /// the whole sphere.
  [[nodiscard]] static std::optional<Cone> intersection(std::span<const HalfSpace> half_spaces);

  /// Clips in place: removes what lies outside `half_space`. Returns false, and
  /// leaves the cone as it was, if no interior would be left. O(facets); for loops
  /// that clip millions of times, since it allocates only when the cone grows.
  [[nodiscard]] bool clip(const HalfSpace& half_space);

  /// This cone without what lies outside `half_space`; nothing if no interior is left.
  [[nodiscard]] std::optional<Cone> clipped(const HalfSpace& half_space) const;

  /// Whether every point of the cone satisfies `half_space` (it would be redundant).
  [[nodiscard]] bool implies(const HalfSpace& half_space) const;
  /// Whether the boundary plane of `half_space` passes through the interior.
  [[nodiscard]] bool is_cut_by(const HalfSpace& half_space) const;

  /// The irredundant half-spaces, counter-clockwise seen from outside.
  [[nodiscard]] std::span<const HalfSpace> facets() const noexcept { return facets_; }
  /// The irredundant half-spaces sorted lexicographically: the canonical minimal set.
  [[nodiscard]] std::vector<HalfSpace> minimal_set() const;

  /// Integer vectors whose non-negative combinations are exactly this cone: the
  /// extreme rays; for lunes, hemispheres and the sphere a ray inside each facet
  /// (or the normal), and both directions of every line.
  [[nodiscard]] std::vector<IntegerVector> generators() const;

  /// An integer direction strictly inside every facet: for a polygon the sum of
  /// its extreme rays. @throws std::overflow_error if an entry would leave 64
  /// bits, which cannot happen while normals stay below 2^24.
  [[nodiscard]] IntegerVector interior_direction() const;

  /// Area on the unit sphere, in steradian, in (0, 4 pi]. Polygons by the formula
  /// of [vanoosterom1983] over a triangle fan, which stays accurate for tiny
  /// regions because the triple products are exact; by Girard's theorem where
  /// corners of the fan are more than 120 degrees apart.
  [[nodiscard]] double solid_angle() const;

  /// In double precision: every margin is at least 0.
  [[nodiscard]] bool contains(const Eigen::Vector3d& w) const noexcept;
  /// Exactly, for an integer direction, shape [3].
  [[nodiscard]] bool contains(const IntegerVector& w) const;

  /// The point of the unit sphere that an area-preserving map of the unit square
  /// onto the cone assigns to (u, v), both in [0, 1): equal areas of the square
  /// become equal areas of the cone. `u` turns about a centre (the axis of the
  /// sphere or hemisphere, the edge of a lune, the first extreme ray of a
  /// polygon), `v` leads away from it. Polygons by the two steps of [arvo1995],
  /// continued over a triangle fan; inside up to rounding.
  [[nodiscard]] Eigen::Vector3d equal_area_point(double u, double v) const;

  /// A uniform draw from the cone's part of the unit sphere: equal_area_point of
  /// two uniform numbers; 4 draws of 32 bits.
  [[nodiscard]] Eigen::Vector3d sample(RandomStream& random) const;

  /// Same set of directions.
  friend bool operator==(const Cone& a, const Cone& b);

 private:
  [[nodiscard]] bool clip_lune(const HalfSpace& half_space);
  [[nodiscard]] bool clip_polygon(const HalfSpace& half_space);
  void replace_rays(const HalfSpace& half_space, std::size_t begin, std::size_t end);
  void to_triangle(const HalfSpace& half_space, int orientation);

  std::vector<HalfSpace> facets_;
  // Extreme rays of a polygon: rays_[i] = facets_[i] x facets_[i + 1] (cyclic). Empty below 3 facets.
  std::vector<IntegerVector> rays_;
};

/// The irredundant half-spaces of the set, sorted lexicographically, or nothing
/// if the intersection has no interior.
[[nodiscard]] std::optional<std::vector<HalfSpace>> minimal_set(std::span<const HalfSpace> half_spaces);

/// Whether the intersection has interior points.
[[nodiscard]] bool has_interior(std::span<const HalfSpace> half_spaces);

/// Solid angle of the intersection in steradian; 0 if it has no interior.
[[nodiscard]] double solid_angle(std::span<const HalfSpace> half_spaces);

/// An irreducible subset of the half-spaces whose intersection has no interior:
/// none of them can be left out. In the given order; at most four of them, by
/// Helly's theorem; empty if the whole set has interior points. Deletion filter
/// [chinneck1991]: earlier half-spaces are dropped first. Names a clash to people.
[[nodiscard]] std::vector<HalfSpace> irreducible_conflict(std::span<const HalfSpace> half_spaces);

}  // namespace kith
