#pragma once

#include "kith/core/error.hpp"

namespace kith::cli {

inline constexpr int kInternalError = 1;
inline constexpr int kBrokenPipeCode = 141;  ///< 128 + SIGPIPE

/// What the program ends with after an error of this kind (`kith --help` lists them), and what it is called in JSON if
/// it has no place in a file.
struct ErrorEnding {
  int code;
  const char* name;
};
[[nodiscard]] constexpr ErrorEnding ending_of(ErrorKind kind) noexcept {
  constexpr ErrorEnding kEndings[] = {{2, "usage"},   {3, "invalid-input"}, {4, "infeasible"}, {5, "io"},
                                      {6, "partial"}, {7, "mismatch"},      {8, "busy"}};
  return kEndings[static_cast<std::size_t>(kind)];
}
[[nodiscard]] constexpr int exit_code(ErrorKind kind) noexcept { return ending_of(kind).code; }

}  // namespace kith::cli
