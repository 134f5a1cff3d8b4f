#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/core/integer_vector.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith::detail {

// "0 1 5": three integers; nothing if the text is anything else.
[[nodiscard]] std::optional<IntegerVector> parse_vector(const std::string& text);

// "1 0 -4;0 -1 2": normals of half-spaces; an empty text is an empty list.
[[nodiscard]] std::optional<std::vector<HalfSpace>> parse_half_spaces(const std::string& text);

}  // namespace kith::detail
