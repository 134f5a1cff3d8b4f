#pragma once

namespace kith::detail {
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);
}  // namespace kith::detail

/// A statement about our own code that must hold; throws std::logic_error with
/// its place if it does not. On in every build: the conditions are cheap.
/// Mistakes of callers throw std::invalid_argument instead.
#define KITH_ASSERT(condition)                         \
  (static_cast<bool>(condition) ? static_cast<void>(0) \
                                : ::kith::detail::assertion_failed(#condition, __FILE__, __LINE__))
