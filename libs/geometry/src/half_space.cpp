#include "kith/geometry/half_space.hpp"

#include <algorithm>
#include <stdexcept>

namespace kith {
namespace {

// Below this, cross products of normals fit into 64 bits and every sign test into 128.
constexpr std::int64_t kEntryLimit = std::int64_t{1} << 31;

IntegerVector canonical(const IntegerVector& normal) {
  if (normal.size() != 3) throw std::invalid_argument{"HalfSpace: the normal must have three entries"};
  const IntegerVector result = primitive(normal);
  if (result.is_zero()) throw std::invalid_argument{"HalfSpace: the normal must not be zero"};
  const bool fits =
      std::all_of(result.begin(), result.end(), [](std::int64_t x) { return x > -kEntryLimit && x < kEntryLimit; });
  if (!fits) {
    throw std::invalid_argument{"HalfSpace: the entries of the normal must stay below 2^31, not " + to_string(result)};
  }
  return result;
}

}  // namespace

HalfSpace::HalfSpace(const IntegerVector& normal)
    : normal_{canonical(normal)},
      unit_{Eigen::Vector3d{static_cast<double>(normal_[0]), static_cast<double>(normal_[1]),
                            static_cast<double>(normal_[2])}
                .normalized()} {}

}  // namespace kith
