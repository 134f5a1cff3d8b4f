#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// Which demonstrations a team has met, as a demonstration or as a test: few of many.
class VisitedDemos {
 public:
  /// None of `num_demos`.
  explicit VisitedDemos(std::size_t num_demos) : is_visited_(num_demos, false) {}

  [[nodiscard]] bool contains(DemoIndex demo) const { return is_visited_[demo.value()]; }
  void insert(DemoIndex demo) {
    if (contains(demo)) return;
    is_visited_[demo.value()] = true;
    in_order_.push_back(demo);
  }
  /// In the order in which they were met.
  [[nodiscard]] std::span<const DemoIndex> in_order() const noexcept { return in_order_; }

  friend bool operator==(const VisitedDemos&, const VisitedDemos&) = default;

 private:
  std::vector<bool> is_visited_;
  std::vector<DemoIndex> in_order_;
};

}  // namespace kith
