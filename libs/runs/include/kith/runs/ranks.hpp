#pragma once

#include <cstddef>
#include <string>

#include "kith/study/work_counter.hpp"

namespace kith {

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
  /// How many of them share this machine, this one included.
  [[nodiscard]] virtual std::size_t num_on_this_machine() = 0;
};

}  // namespace kith
