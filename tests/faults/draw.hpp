#pragma once

#include "kith/core/stream.hpp"

namespace kith::faults {

/// An element of a list that is not empty.
template <typename List>
const auto& drawn_from(const List& list, RandomStream& random) {
  return list[random() % list.size()];
}

}  // namespace kith::faults
