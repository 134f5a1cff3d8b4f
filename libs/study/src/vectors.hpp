#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/core/integer_vector.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith::detail {

// "0 1 5": so many integers; nothing if the text is anything else.
[[nodiscard]] std::optional<IntegerVector> parse_vector(const std::string& text, std::size_t dimension);

// "0 1.25 5", in units of 1 / scale; whole numbers only if the scale is 1.
[[nodiscard]] std::optional<IntegerVector> parse_counts(const std::string& text, std::size_t dimension,
                                                        std::int64_t scale);

// "1 0 -4;0 -1 2": normals of half-spaces; an empty text is an empty list.
[[nodiscard]] std::optional<std::vector<HalfSpace>> parse_half_spaces(const std::string& text, std::size_t dimension);

}  // namespace kith::detail
