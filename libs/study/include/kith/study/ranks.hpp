#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace kith {

/// Where work is taken from: a number that all who share the work add to, threads and processes alike.
class WorkCounter {
 public:
  virtual ~WorkCounter() = default;
  /// Adds `n` and returns what it was before: the first of n positions that nobody else gets. From any thread.
  virtual std::uint64_t take(std::uint64_t n) = 0;
};

/// The processes that run one study together (ranks in the sense of MPI). Every call but take() is made by all of
/// them, in the same order, from their main threads.
class Ranks : public WorkCounter {
 public:
  [[nodiscard]] virtual std::size_t rank() const = 0;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// What rank 0 passes, for everybody.
  [[nodiscard]] virtual std::string broadcast(std::string bytes) = 0;
  /// Whether anybody says so.
  [[nodiscard]] virtual bool any(bool mine) = 0;
  /// Returns once all have come here.
  virtual void wait_for_all() = 0;
};

}  // namespace kith
