#include "kith/store/random_token.hpp"

#include <sys/random.h>

#include <cerrno>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/base64.hpp"

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
  constexpr std::size_t kBytes = 16;
  return base64url(random_bytes(kBytes));
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
