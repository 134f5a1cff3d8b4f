#pragma once

#include <string>
#include <string_view>

namespace kith {

/// SHA-256 of the bytes (FIPS 180-4), as 64 hexadecimal digits: tells whether two
/// files are the same.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace kith
