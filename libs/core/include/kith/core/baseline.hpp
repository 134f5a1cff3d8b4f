#pragma once

#include <string_view>

namespace kith {

/// The strategy to compare with, by its name in study files and tables: everybody is taught alone, one after the other,
/// in sessions of one person each.
inline constexpr std::string_view kBaseline = "baseline";

}  // namespace kith
