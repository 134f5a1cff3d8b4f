#pragma once

#include <optional>
#include <vector>

#include "fuzzing.hpp"
#include "kith/geometry/cone.hpp"

namespace kith::fuzzing {

/// Up to `most` half-spaces with entries in [-limit, limit]; a zero vector ends the list.
[[nodiscard]] inline std::vector<HalfSpace> half_spaces(Bytes& bytes, std::size_t most, std::int64_t limit) {
  std::vector<HalfSpace> list;
  while (list.size() < most) {
    const auto small = static_cast<std::size_t>(2 * limit + 1);
    const auto entry = [&] {
      return small < 256 ? static_cast<std::int64_t>(bytes.below(small)) - limit : bytes.integer(limit);
    };
    const auto x = entry();
    const auto y = entry();
    const IntegerVector normal{x, y, entry()};
    if (normal.is_zero()) break;
    list.emplace_back(normal);
  }
  return list;
}

}  // namespace kith::fuzzing
