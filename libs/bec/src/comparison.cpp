#include "kith/bec/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kith {
namespace {

constexpr double kLeastDifference = 1e-4;  // counts

// The length of normals up to which cones in d dimensions are surely exact (see Cone), less a bit for d = 4.
double longest_normal(std::size_t dimension) {
  constexpr std::array<int, 9> kExactBits{0, 0, 20, 20, 19, 15, 12, 10, 8};
  return std::ldexp(1.0, kExactBits[dimension]);
}

double length_of(const IntegerVector& v) {
  double square = 0.0;
  for (const std::int64_t x : v) square += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(square);
}

IntegerVector shortened(const IntegerVector& v, double length) {
  const double factor = longest_normal(v.size()) / length;
  IntegerVector result(v.size());
  for (std::size_t k = 0; k < v.size(); ++k) result[k] = std::llround(factor * static_cast<double>(v[k]));
  return result;
}

}  // namespace

std::optional<HalfSpace> preference(const IntegerVector& difference, std::int64_t scale) {
  if (difference.is_zero()) return std::nullopt;
  if (scale > 1) {
    const auto least = static_cast<std::int64_t>(kLeastDifference * static_cast<double>(scale));
    const bool is_none =
        std::all_of(difference.begin(), difference.end(), [&](std::int64_t x) { return x <= least && x >= -least; });
    if (is_none) return std::nullopt;
  }
  const IntegerVector normal = scale > 1 ? difference : primitive(difference);
  const double length = length_of(normal);
  // In space exact cones take all normals that a half-space may have.
  const bool fits = (scale == 1 && normal.size() == 3) || length <= longest_normal(normal.size());
  return HalfSpace{fits ? normal : shortened(normal, length)};
}

std::optional<HalfSpace> preference_of_robot(const Domain& domain, const IntegerVector& loss) {
  auto half_space = preference(loss, domain.count_scale());
  if (!half_space) return half_space;
  const int sign = sign_of_dot(half_space->normal(), domain.weights().integer);
  if (sign < 0 || (sign == 0 && !domain.is_exact())) return std::nullopt;
  return half_space;
}

}  // namespace kith
