#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace kith {

/// A 64-bit tag from a name (FNV-1a), so that parts of an address are words
/// and do not depend on positions in a list.
[[nodiscard]] constexpr std::uint64_t stream_tag(std::string_view name) noexcept {
  std::uint64_t hash = 0xCBF29CE484222325ull;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  return hash;
}

/// A reproducible stream of random bits, addressed by a path rather than by
/// history.
///
/// A stream is a pair (key, counter) of the Philox4x32-10 generator of Salmon
/// et al., "Parallel Random Numbers: As Easy as 1, 2, 3" [salmon2011].
/// `split(tag)` yields a child whose key depends only on this key and `tag`,
/// not on how many numbers were drawn here: replicate 17 sees the same bits
/// whether it runs first, last, or on another thread. Keys have 64 bits, so two
/// of n streams coincide with probability about n^2 / 2^65.
///
/// Models std::uniform_random_bit_generator. Copy it freely: a copy replays.
/// Not thread-safe; give each task its own split.
class RandomStream {
 public:
  using result_type = std::uint32_t;

  /// Roots the tree of streams of one run. Record `seed` with the results.
  explicit RandomStream(std::uint64_t seed) noexcept;

  /// Child stream number `tag`; independent of the draws made so far.
  [[nodiscard]] RandomStream split(std::uint64_t tag) const noexcept;
  [[nodiscard]] RandomStream split(std::string_view name) const noexcept { return split(stream_tag(name)); }

  /// The next 32 random bits.
  result_type operator()() noexcept {
    if (next_ == 4) refill();
    return block_[next_++];
  }

  /// Identifies the stream's address; equal for equal paths, whatever was drawn.
  [[nodiscard]] std::uint64_t address() const noexcept;

  static constexpr result_type min() noexcept { return 0; }
  static constexpr result_type max() noexcept { return std::numeric_limits<result_type>::max(); }

 private:
  RandomStream(std::uint32_t key0, std::uint32_t key1) noexcept : key_{key0, key1} {}
  void refill() noexcept;

  std::uint32_t key_[2];
  std::uint64_t counter_ = 0;
  std::uint32_t block_[4]{};
  unsigned next_ = 4;
};

}  // namespace kith
