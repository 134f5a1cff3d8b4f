#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kith::detail {

// Sobol points in up to nine dimensions with the direction numbers of Joe and Kuo, in the order of the Gray code, each
// coordinate moved by a digital shift (exclusive or). With random shifts every point is uniform in the cube.
class Sobol {
 public:
  static constexpr std::size_t kMaxDimension = 9;
  using Shift = std::array<std::uint32_t, kMaxDimension>;

  explicit Sobol(const Shift& shift);

  // Moves on to the next point; the first call gives the first.
  void next();
  // Coordinate k of the current point, in (0, 1).
  [[nodiscard]] double operator[](std::size_t k) const { return (static_cast<double>(bits_[k]) + 0.5) * 0x1.0p-32; }

 private:
  std::array<std::array<std::uint32_t, 32>, kMaxDimension> directions_;
  std::array<std::uint32_t, kMaxDimension> bits_;
  std::uint32_t index_ = 0;
};

}  // namespace kith::detail
