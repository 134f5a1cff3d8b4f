#pragma once

#include <cstddef>
#include <cstdint>

namespace kith {

/// Hashes a list of numbers, one after the other; the same on every platform.
class ListHash {
 public:
  constexpr void add(std::uint64_t number) noexcept {
    bits_ = (bits_ ^ number) * 0xBF58476D1CE4E5B9ull;
    bits_ ^= bits_ >> 29;
  }
  [[nodiscard]] constexpr std::size_t value() const noexcept { return static_cast<std::size_t>(bits_); }

 private:
  std::uint64_t bits_ = 0x9E3779B97F4A7C15ull;
};

/// A hash of a list of whole numbers, for containers that are keyed by such lists.
struct HashOfList {
  template <typename List>
  [[nodiscard]] constexpr std::size_t operator()(const List& list) const noexcept {
    ListHash hash;
    for (const auto number : list) hash.add(static_cast<std::uint64_t>(number));
    return hash.value();
  }
};

}  // namespace kith
