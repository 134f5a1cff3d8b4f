#pragma once

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith::testing {

/// The atlas of the built-in item delivery, made once per test program.
[[nodiscard]] inline const Atlas& item_delivery() {
  static const Atlas atlas{load_domain("item-delivery")};
  return atlas;
}

[[nodiscard]] inline std::vector<HalfSpace> half_spaces(std::initializer_list<IntegerVector> normals) {
  std::vector<HalfSpace> result;
  for (const auto& normal : normals) result.emplace_back(normal);
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace kith::testing
