#include "kith/geometry/half_space.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kith {
namespace {

// Below this, in three dimensions, cross products of normals fit into 64 bits and every sign test into 128; in
// more, products with rays of 64 bits into 128.
constexpr std::int64_t kEntryLimit = std::int64_t{1} << 31;

IntegerVector canonical(const IntegerVector& normal) {
  if (normal.size() < 2) throw std::invalid_argument{"HalfSpace: the normal must have two to eight entries"};
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

HalfSpace::HalfSpace(const IntegerVector& normal) : normal_{canonical(normal)} {
  if (dimension() == 3) {
    unit_ = Eigen::Vector3d{static_cast<double>(normal_[0]), static_cast<double>(normal_[1]),
                            static_cast<double>(normal_[2])}
                .normalized();
    return;
  }
  double square = 0.0;
  for (const std::int64_t x : normal_) square += static_cast<double>(x) * static_cast<double>(x);
  inverse_length_ = 1.0 / std::sqrt(square);
}

Direction HalfSpace::unit() const {
  if (dimension() == 3) return unit_;
  Direction result(static_cast<Eigen::Index>(dimension()));
  for (std::size_t k = 0; k < dimension(); ++k) {
    result[static_cast<Eigen::Index>(k)] = static_cast<double>(normal_[k]) * inverse_length_;
  }
  return result;
}

}  // namespace kith
