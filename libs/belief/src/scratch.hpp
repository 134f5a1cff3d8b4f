#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kith::detail {

// Room for n values for the time of one call: on the stack where they are few
// enough, so that updating beliefs of usual size allocates nothing. The values
// are not initialised.
template <typename T, std::size_t Usual>
class Scratch {
 public:
  explicit Scratch(std::size_t n) : size_{n} {
    if (n > Usual) heap_.resize(n);
  }
  ~Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::span<T> values() noexcept { return {size_ > Usual ? heap_.data() : stack_.data(), size_}; }

 private:
  std::size_t size_;
  std::vector<T> heap_;
  std::array<T, Usual> stack_;
};

// One number per particle. An update has up to eight such lists at a time, which is why they end soon beyond the 1000
// particles of most beliefs: threads can have stacks of 128 kB.
inline constexpr std::size_t kUsualParticles = 1024;
template <typename T>
using ParticleScratch = Scratch<T, kUsualParticles>;

}  // namespace kith::detail
