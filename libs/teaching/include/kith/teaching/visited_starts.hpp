#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// Which demonstrations a team has met, as a demonstration or as a test: few of many.
class VisitedStarts {
 public:
  /// None of `num_states`.
  explicit VisitedStarts(std::size_t num_states) : is_visited_(num_states, false) {}

  [[nodiscard]] bool contains(StartIndex start) const { return is_visited_[start.value()]; }
  void insert(StartIndex start) {
    if (contains(start)) return;
    is_visited_[start.value()] = true;
    in_order_.push_back(start);
  }
  /// In the order in which they were met.
  [[nodiscard]] std::span<const StartIndex> in_order() const noexcept { return in_order_; }

  friend bool operator==(const VisitedStarts&, const VisitedStarts&) = default;

 private:
  std::vector<bool> is_visited_;
  std::vector<StartIndex> in_order_;
};

}  // namespace kith
