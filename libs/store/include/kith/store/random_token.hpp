#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kith {

// Bytes of the system's generator. @throws kith::Error (kIo) if it has none.
[[nodiscard]] std::string random_bytes(std::size_t count);

// 128 random bits in the alphabet of base64url: 22 characters.
[[nodiscard]] std::string random_token();

// A code that people can type: letters and digits that do not look alike.
[[nodiscard]] std::string random_code(std::size_t length);

// Whether two texts of the same length are equal, in time that depends on the length only.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept;

}  // namespace kith
