#pragma once

#include <string>
#include <string_view>

namespace kith {

/// Bytes as text (RFC 4648, 4), padded with '='.
[[nodiscard]] std::string base64(std::string_view bytes);

/// The same in the alphabet for addresses of web pages and names of files, without padding (RFC 4648, 5).
[[nodiscard]] std::string base64url(std::string_view bytes);

}  // namespace kith
