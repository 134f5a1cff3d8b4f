#pragma once

#include <string>
#include <string_view>

namespace kith {

/// The bytes as a gzip file (RFC 1952).
[[nodiscard]] std::string gzipped(std::string_view bytes);

}  // namespace kith
