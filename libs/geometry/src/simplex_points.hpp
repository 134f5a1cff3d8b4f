#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sobol.hpp"

namespace kith::detail {

// Sobol points as cones are sampled by them: a number that chooses a part, a point lambda of the standard simplex of n
// coordinates (SimplexMap), and a number that decides whether the point is accepted. Their roots are most of the cost
// of a sample, and the same for all cones.
class SimplexPoints {
 public:
  // `count` points with each of the shifts, one after the other.
  SimplexPoints(std::size_t n, std::span<const Sobol::Shift> shifts, std::size_t count);

  [[nodiscard]] std::size_t size() const noexcept { return numbers_.size() / (n_ + 2); }
  [[nodiscard]] double which(std::size_t i) const { return numbers_[i * (n_ + 2)]; }
  [[nodiscard]] std::span<const double> lambda(std::size_t i) const {
    return std::span{numbers_}.subspan(i * (n_ + 2) + 1, n_);
  }
  [[nodiscard]] double last(std::size_t i) const { return numbers_[i * (n_ + 2) + n_ + 1]; }

  // Appends what becomes of the current point of a sequence.
  static void append(const Sobol& sobol, std::size_t n, std::vector<double>& numbers);

 private:
  std::size_t n_;
  std::vector<double> numbers_;  // row-major, shape [size(), n + 2]
};

// The first points of the sequence that is not shifted, made when n is asked for the first time. n in [1, 8].
[[nodiscard]] const SimplexPoints& cover_points(std::size_t n);

// 1 024 points with each of 16 random shifts, which are always the same; made when n is asked for the first time.
inline constexpr std::size_t kAreaEstimates = 16;
inline constexpr std::size_t kAreaPoints = 1024;
[[nodiscard]] const SimplexPoints& area_points(std::size_t n);
[[nodiscard]] std::vector<Sobol::Shift> area_shifts();

}  // namespace kith::detail
