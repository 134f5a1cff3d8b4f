#include "standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace kith::cli {

void reserve_standard_descriptors() noexcept {
  for (const int descriptor : std::array{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    (void)open("/", O_PATH);  // takes the lowest free number, this one; read() and write() fail with EBADF as before
  }
}

}  // namespace kith::cli
