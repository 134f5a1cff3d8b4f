#include "kith/study/sha256.hpp"

#include <openssl/evp.h>

#include <array>

#include "kith/core/assert.hpp"

namespace kith {

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  const int ok = EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
  KITH_ASSERT(ok == 1 && length == 32);  // fails only without memory
  static constexpr char kHex[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < length; ++i) {
    text += kHex[digest[i] >> 4];
    text += kHex[digest[i] & 0xFu];
  }
  return text;
}

}  // namespace kith
