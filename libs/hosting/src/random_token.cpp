#include "random_token.hpp"

#include <sys/random.h>

#include <cerrno>
#include <system_error>

#include "kith/core/error.hpp"

namespace kith {

std::string random_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  std::size_t filled = 0;
  while (filled < count) {
    const auto n = getrandom(bytes.data() + filled, count - filled, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      throw Error{ErrorKind::kIo, "cannot draw random bytes: " + std::generic_category().message(errno)};
    }
    filled += static_cast<std::size_t>(n);
  }
  return bytes;
}

std::string random_token() {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  constexpr std::size_t kBytes = 16;
  std::string token;
  unsigned value = 0;
  unsigned bits = 0;
  for (const char c : random_bytes(kBytes)) {
    value = value << 8 | static_cast<unsigned char>(c);
    bits += 8;
    while (bits >= 6) {
      bits -= 6;
      token += kAlphabet[value >> bits & 63u];
    }
    value &= (1u << bits) - 1;
  }
  token += kAlphabet[value << (6 - bits) & 63u];
  return token;
}

std::string random_code(std::size_t length) {
  constexpr std::string_view kAlphabet = "23456789ABCDEFGHJKLMNPQRSTUVWXYZ";  // 32: no 0, 1, I, O
  std::string code;
  for (const char c : random_bytes(length)) code += kAlphabet[static_cast<unsigned char>(c) & 31u];
  return code;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

}  // namespace kith
