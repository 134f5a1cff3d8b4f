// What is the same whoever computes the digest.
#include <string>
#include <string_view>
#include <utility>

#include "kith/files/sha256.hpp"

namespace kith {

std::string Sha256::hex() && {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string text;
  for (const char byte : std::move(*this).digest()) {
    text += kHex[static_cast<unsigned char>(byte) >> 4];
    text += kHex[static_cast<unsigned char>(byte) & 0xFu];
  }
  return text;
}

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes);
  return std::move(hash).hex();
}

}  // namespace kith
