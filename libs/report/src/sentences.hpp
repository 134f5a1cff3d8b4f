#pragma once

#include <cctype>
#include <cstddef>
#include <string>

namespace kith::detail {

inline std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// "1 person", "6 people".
inline std::string how_many(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace kith::detail
