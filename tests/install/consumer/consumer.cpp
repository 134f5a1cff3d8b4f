#include <cmath>
#include <cstdio>

#include "kith/domains/domain_file.hpp"
#include "kith/geometry/cone.hpp"

// The area left by the minimal set of item delivery, and a built-in domain that
// has to have come along inside the library.
int main() {
  const auto region = kith::Cone::intersection(
      std::vector{kith::HalfSpace{{-1, 0, 2}}, kith::HalfSpace{{0, -1, -4}}, kith::HalfSpace{{1, 1, 0}}});
  const kith::Domain domain = kith::load_domain("item-delivery");
  const bool right = region && std::abs(region->solid_angle() - 0.0260947) < 1e-7 && domain.num_starts() == 9312;
  std::printf("%s\n", right ? "found kith" : "kith gives other numbers");
  return right ? 0 : 1;
}
