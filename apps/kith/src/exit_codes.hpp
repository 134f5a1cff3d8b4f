#pragma once

#include "kith/core/error.hpp"

namespace kith::cli {

inline constexpr int kInternalError = 1;
inline constexpr int kBrokenPipeCode = 141;  ///< 128 + SIGPIPE

/// What the program ends with after an error of this kind (`kith --help` lists them).
[[nodiscard]] constexpr int exit_code(ErrorKind kind) noexcept {
  switch (kind) {
    case ErrorKind::kUsage:
      return 2;
    case ErrorKind::kInvalidInput:
      return 3;
    case ErrorKind::kInfeasible:
      return 4;
    case ErrorKind::kIo:
      return 5;
    case ErrorKind::kPartial:
      return 6;
    case ErrorKind::kMismatch:
      return 7;
    case ErrorKind::kBusy:
      return 8;
  }
  return kInternalError;
}

}  // namespace kith::cli
