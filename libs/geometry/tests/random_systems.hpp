#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/geometry/cone.hpp"

namespace kith::testing {

inline std::vector<HalfSpace> half_spaces_with(std::initializer_list<IntegerVector> normals) {
  std::vector<HalfSpace> result;
  for (const IntegerVector& normal : normals) result.emplace_back(normal);
  return result;
}

/// An integer in [-largest, largest].
inline std::int64_t random_integer(std::int64_t largest, RandomStream& random) {
  return static_cast<std::int64_t>(uniform_index(static_cast<std::size_t>(2 * largest + 1), random)) - largest;
}

/// A non-zero vector with entries in [-largest, largest].
inline IntegerVector random_vector(std::int64_t largest, RandomStream& random, std::size_t dimension = 3) {
  IntegerVector v(dimension);
  while (v.is_zero())
    for (std::size_t k = 0; k < dimension; ++k) v[k] = random_integer(largest, random);
  return v;
}

/// `n` half-spaces with small integer normals, so that duplicates, parallel and
/// coplanar normals and rays on boundaries are frequent.
inline std::vector<HalfSpace> random_system(std::size_t n, std::int64_t largest, RandomStream& random,
                                            std::size_t dimension = 3) {
  std::vector<HalfSpace> system;
  for (std::size_t i = 0; i < n; ++i) system.emplace_back(random_vector(largest, random, dimension));
  return system;
}

/// The same, but all satisfied strictly by a common direction.
inline std::vector<HalfSpace> random_feasible_system(std::size_t n, std::int64_t largest, RandomStream& random,
                                                     std::size_t dimension = 3) {
  const IntegerVector inside = random_vector(largest, random, dimension);
  std::vector<HalfSpace> system;
  while (system.size() < n) {
    const IntegerVector v = random_vector(largest, random, dimension);
    const int s = sign_of_dot(v, inside);
    if (s != 0) system.emplace_back(s > 0 ? v : -v);
  }
  return system;
}

inline void shuffle(std::vector<HalfSpace>& system, RandomStream& random) {
  for (std::size_t i = system.size(); i > 1; --i) std::swap(system[i - 1], system[uniform_index(i, random)]);
}

/// Cones of every kind: sphere, hemispheres, lunes, polygons, fat and thin.
inline std::vector<Cone> random_cones(std::size_t count, std::int64_t largest, RandomStream& random) {
  std::vector<Cone> cones;
  while (cones.size() < count) {
    const auto cone = Cone::intersection(random_feasible_system(cones.size() % 9, largest, random));
    if (cone) cones.push_back(*cone);
  }
  return cones;
}

/// How far the worst violated half-space is from containing w.
inline double worst_margin(const Cone& cone, const Direction& w) {
  double worst = 1.0;
  for (const HalfSpace& facet : cone.facets()) worst = std::min(worst, facet.margin(w));
  return worst;
}

}  // namespace kith::testing
