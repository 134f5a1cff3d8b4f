#pragma once

#include <optional>
#include <string_view>

#include "kith/domains/family_map.hpp"

namespace kith::detail {

// A character that no symbol has yet; nothing if there is none left.
[[nodiscard]] std::optional<char> unused_glyph(const FamilyMap& family_map, std::string_view preferred);

// Gives every combination of things that can share a cell a symbol, so that it can be drawn.
void name_combinations(FamilyMap& family_map);

}  // namespace kith::detail
