#include "kith/core/stream.hpp"

#include <Random123/philox.h>

#include <algorithm>

namespace kith {
namespace {

constexpr std::uint32_t low(std::uint64_t x) noexcept { return static_cast<std::uint32_t>(x); }
constexpr std::uint32_t high(std::uint64_t x) noexcept { return static_cast<std::uint32_t>(x >> 32); }

// Words 2 and 3 of the counter hold this when splitting and 0 when drawing, so
// the block behind a child's key is never one that the parent hands out.
constexpr std::uint32_t kSplit = 0xFFFFFFFFu;

// Random123 stays behind this function, so that programs which use kith do not need its headers.
r123::Philox4x32::ctr_type philox(const r123::Philox4x32::ctr_type& counter, const std::uint32_t (&key)[2]) noexcept {
  return r123::Philox4x32{}(counter, {{key[0], key[1]}});
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed) noexcept : key_{low(seed), high(seed)} {}

RandomStream RandomStream::split(std::uint64_t tag) const noexcept {
  const auto block = philox({{low(tag), high(tag), kSplit, kSplit}}, key_);
  return {block.v[0], block.v[1]};
}

void RandomStream::refill() noexcept {
  const auto block = philox({{low(counter_), high(counter_), 0, 0}}, key_);
  std::copy_n(block.v, 4, block_);
  ++counter_;
  next_ = 0;
}

std::uint64_t RandomStream::address() const noexcept { return (std::uint64_t{key_[1]} << 32) | key_[0]; }

}  // namespace kith
