#pragma once

#include <cstddef>

#include "kith/geometry/half_space.hpp"

namespace kith::detail {

// Entries of normals stay below 2^31, so their cross products fit into 64 bits
// unchecked, and the products of those with normals into 128.
inline IntegerVector cross_unchecked(const IntegerVector& a, const IntegerVector& b) {
  IntegerVector result(3);
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
  return result;
}

inline IntegerVector cross_of_normals(const HalfSpace& a, const HalfSpace& b) {
  return cross_unchecked(a.normal(), b.normal());
}

inline Int128 product(const HalfSpace& half_space, const IntegerVector& ray) {
  const IntegerVector& n = half_space.normal();
  return Int128{n[0]} * ray[0] + Int128{n[1]} * ray[1] + Int128{n[2]} * ray[2];
}

// @pre v is not zero.
inline std::size_t first_nonzero(const IntegerVector& v) {
  std::size_t k = 0;
  while (v[k] == 0) ++k;
  return k;
}

inline int side(const HalfSpace& half_space, const IntegerVector& ray) { return sign(product(half_space, ray)); }

}  // namespace kith::detail
