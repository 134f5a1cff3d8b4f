#include "kith/random/stream.hpp"

namespace kith {
namespace {

constexpr std::uint32_t low(std::uint64_t x) noexcept { return static_cast<std::uint32_t>(x); }
constexpr std::uint32_t high(std::uint64_t x) noexcept { return static_cast<std::uint32_t>(x >> 32); }

// Words 2 and 3 of the counter hold this when splitting and 0 when drawing, so
// the block behind a child's key is never one that the parent hands out.
constexpr std::uint32_t kSplit = 0xFFFFFFFFu;

}  // namespace

RandomStream::RandomStream(std::uint64_t seed) noexcept : key_{{low(seed), high(seed)}} {}

RandomStream RandomStream::split(std::uint64_t tag) const noexcept {
  const auto block = r123::Philox4x32{}({{low(tag), high(tag), kSplit, kSplit}}, key_);
  return RandomStream{r123::Philox4x32::key_type{{block.v[0], block.v[1]}}};
}

void RandomStream::refill() noexcept {
  block_ = r123::Philox4x32{}({{low(counter_), high(counter_), 0, 0}}, key_);
  ++counter_;
  next_ = 0;
}

std::uint64_t RandomStream::address() const noexcept { return (std::uint64_t{key_.v[1]} << 32) | key_.v[0]; }

}  // namespace kith
