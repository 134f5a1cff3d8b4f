#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kith/core/stream.hpp"

namespace kith {

/// Independent standard normals in single precision, in blocks of pairs, for
/// kernels that move thousands of particles: the Box-Muller transform in plain
/// loops with polynomials for the logarithm, the sine and the cosine, which a
/// compiler can vectorise. Twenty times as fast as one call per number.
///
/// One 64-bit key is drawn from the stream (2 draws). A pair comes from 32 bits for
/// its radius and 32 for its angle: pairs i and i + 128 of block b (i < 128) from the
/// halves of Threefry4x32-20 of the counter 128 b + i under that key [salmon2011]. No |value| exceeds sqrt(64 ln 2) =
/// 6.66; a standard normal does so once in 3 10^10 draws. A value differs from the
/// exact transform of its bits by at most 1e-6 (decision 15).
class NormalPairs {
 public:
  static constexpr std::size_t kBlock = 256;
  using Block = std::array<float, kBlock>;

  explicit NormalPairs(RandomStream& random) noexcept;

  /// The pairs kBlock * block, ..., each once in `cosine` and in `sine`: 2 kBlock independent values.
  void fill(std::uint64_t block, Block& cosine, Block& sine) const noexcept;

 private:
  std::uint32_t key_[2];
};

/// Independent 32-bit words in blocks of pairs, for kernels that need many at once: the words from which NormalPairs
/// makes its values. Twenty times as fast as one call per word.
///
/// One 64-bit key is drawn from the stream (2 draws).
class WordPairs {
 public:
  static constexpr std::size_t kBlock = NormalPairs::kBlock;
  using Block = std::array<std::uint32_t, kBlock>;

  explicit WordPairs(RandomStream& random) noexcept;

  /// The pairs kBlock * block, ..., each once in `first` and in `second`: 2 kBlock independent words.
  void fill(std::uint64_t block, Block& first, Block& second) const noexcept;

 private:
  std::uint32_t key_[2];
};

}  // namespace kith
