#pragma once

#include <cstddef>
#include <string_view>

namespace kith {

/// Whether no place of a JSON text is inside of more than `depth` brackets and braces, and no byte is zero, where a
/// parser would stop; checked before a parser that recurses sees it. Text that is no JSON is judged by the same count.
[[nodiscard]] bool json_nests_within(std::string_view text, std::size_t depth) noexcept;

}  // namespace kith
