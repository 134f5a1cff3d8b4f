#pragma once

#include "kith/core/integer_vector.hpp"

namespace kith::detail {

// The primitive vector along a x + b y, exactly. Throws std::overflow_error if an entry leaves 64 bits; intermediate
// results may be larger. Not both of a and b may be zero.
[[nodiscard]] IntegerVector combination(Int128 a, const IntegerVector& x, Int128 b, const IntegerVector& y);

}  // namespace kith::detail
