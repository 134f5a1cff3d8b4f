#include <utility>

#include "kith/geometry/cone.hpp"

namespace kith {

std::optional<std::vector<HalfSpace>> minimal_set(std::span<const HalfSpace> half_spaces) {
  const std::optional<Cone> cone = Cone::intersection(half_spaces);
  if (!cone) return std::nullopt;
  return cone->minimal_set();
}

bool has_interior(std::span<const HalfSpace> half_spaces) { return Cone::intersection(half_spaces).has_value(); }

double solid_angle(std::span<const HalfSpace> half_spaces) {
  const std::optional<Cone> cone = Cone::intersection(half_spaces);
  return cone ? cone->solid_angle() : 0.0;
}

std::vector<HalfSpace> irreducible_conflict(std::span<const HalfSpace> half_spaces) {
  if (has_interior(half_spaces)) return {};
  std::vector<HalfSpace> conflict{half_spaces.begin(), half_spaces.end()};
  for (std::size_t i = 0; i < conflict.size();) {
    std::vector<HalfSpace> rest = conflict;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (has_interior(rest)) {
      ++i;
    } else {
      conflict = std::move(rest);
    }
  }
  return conflict;
}

}  // namespace kith
