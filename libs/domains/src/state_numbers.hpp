#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "state_layout.hpp"

namespace kith::detail {

// Numbers packed states in the order in which they come. Short words are looked
// up directly, long ones by open addressing; std::unordered_map is ten times slower.
class StateNumbers {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  StateNumbers() = default;
  explicit StateNumbers(std::size_t num_bits) : direct_{num_bits <= kMaxDirectBits} {
    slots_.assign(std::size_t{1} << (direct_ ? num_bits : kFirstBits), kNone);
  }

  // The slot of `s` among `states` (the states numbered so far): holds its number, or kNone.
  [[nodiscard]] std::uint32_t& slot(PackedState s, const std::vector<PackedState>& states) {
    if (direct_) return slots_[s];
    if (states.size() * 2 >= slots_.size()) grow(states);
    return probe(s, states);
  }

  void clear(const std::vector<PackedState>& states) {
    if (!direct_) {
      slots_.assign(std::size_t{1} << kFirstBits, kNone);
      return;
    }
    for (const PackedState s : states) slots_[s] = kNone;
  }

 private:
  static constexpr std::size_t kMaxDirectBits = 22;
  static constexpr std::size_t kFirstBits = 12;

  [[nodiscard]] std::uint32_t& probe(PackedState s, const std::vector<PackedState>& states) {
    const auto shift = static_cast<unsigned>(64 - std::countr_zero(slots_.size()));
    std::size_t at = (s * 0x9E3779B97F4A7C15ULL) >> shift;  // Fibonacci hashing
    while (slots_[at] != kNone && states[slots_[at]] != s) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }

  void grow(const std::vector<PackedState>& states) {
    slots_.assign(slots_.size() * 4, kNone);
    for (std::size_t i = 0; i < states.size(); ++i) probe(states[i], states) = static_cast<std::uint32_t>(i);
  }

  bool direct_ = true;
  std::vector<std::uint32_t> slots_;
};

}  // namespace kith::detail
