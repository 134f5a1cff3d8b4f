#pragma once

#include <cstdint>

namespace kith {

/// Where work is taken from: a number that all who share the work add to, threads and processes alike.
class WorkCounter {
 public:
  virtual ~WorkCounter() = default;
  /// Adds `n` and returns what it was before: the first of n positions that nobody else gets. From any thread.
  virtual std::uint64_t take(std::uint64_t n) = 0;
};

}  // namespace kith
