#pragma once

#include <optional>
#include <vector>

#include "fuzzing.hpp"
#include "kith/geometry/cone.hpp"

namespace kith::fuzzing {

/// Up to `most` half-spaces with entries in [-limit, limit]; a zero vector ends the list.
[[nodiscard]] inline std::vector<HalfSpace> half_spaces(Bytes& bytes, std::size_t most, std::int64_t limit,
                                                        std::size_t dimension = 3) {
  std::vector<HalfSpace> list;
  const auto small = static_cast<std::size_t>(2 * limit + 1);
  while (list.size() < most) {
    IntegerVector normal(dimension);
    for (std::size_t k = 0; k < dimension; ++k) {
      normal[k] = small < 256 ? static_cast<std::int64_t>(bytes.below(small)) - limit : bytes.integer(limit);
    }
    if (normal.is_zero()) break;
    list.emplace_back(normal);
  }
  return list;
}

/// Their intersection in d dimensions, the whole sphere if there are none; nothing without an interior.
[[nodiscard]] inline std::optional<Cone> intersection(const std::vector<HalfSpace>& half_spaces,
                                                      std::size_t dimension) {
  Cone cone{dimension};
  return cone.clip(half_spaces) ? std::optional{cone} : std::nullopt;
}

}  // namespace kith::fuzzing
