#include "kith/geometry/cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "kith/core/vector_clones.hpp"

namespace kith {
namespace {

// Where a product comes this close to 0, its sign may depend on the order of the sum.
constexpr double kUnsure = 1e-12;

constexpr std::size_t kPerWord = 64;  // points of a mask

// Where up to 64 points lie: bit i stands for point i.
struct Sides {
  std::uint64_t inside = 0;  // clearly
  std::uint64_t unsure = 0;
};

// `points`: axis by axis, `n` of each.
template <std::size_t d>
[[gnu::always_inline]] inline Sides sides_in(const double* points, std::size_t n, const double* normal) {
  std::array<double, kPerWord> products;
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kPerWord; ++i) {
    double t = 0.0;
    for (std::size_t k = 0; k < d; ++k) t += normal[k] * points[k * n + i];
    products[i] = t;
  }
  Sides sides;
  for (std::size_t i = 0; i < kPerWord; ++i) {
    sides.inside |= std::uint64_t{products[i] > kUnsure} << i;
    sides.unsure |= std::uint64_t{std::abs(products[i]) <= kUnsure} << i;
  }
  return sides;
}

KITH_VECTOR_CLONES Sides sides_of(const double* points, std::size_t n, const double* normal, std::size_t d) {
  switch (d) {
    case 4:
      return sides_in<4>(points, n, normal);
    case 5:
      return sides_in<5>(points, n, normal);
    case 6:
      return sides_in<6>(points, n, normal);
    case 7:
      return sides_in<7>(points, n, normal);
    case 8:
      return sides_in<8>(points, n, normal);
    default:
      return {0, ~std::uint64_t{0}};
  }
}

}  // namespace

Cloud::Mask Cloud::everything() const {
  Mask mask(num_words(), ~std::uint64_t{0});
  if (size() % 64 != 0) mask.back() = (std::uint64_t{1} << (size() % 64)) - 1;
  return mask;
}

Cloud::Mask Cloud::mask(const HalfSpace& half_space) const {
  const auto d = static_cast<std::size_t>(points_.cols());
  if (half_space.dimension() != d) {
    throw std::invalid_argument{"Cloud: the half-space must have the dimension of the region"};
  }
  const Direction unit = half_space.unit();
  Mask mask(num_words());
  const auto is_inside = [&](std::size_t i) {
    const Direction point = points_.row(static_cast<Eigen::Index>(i));
    return point.dot(unit) >= 0.0;
  };
  for (std::size_t begin = 0; begin < size(); begin += kPerWord) {
    const std::size_t count = std::min(kPerWord, size() - begin);
    Sides sides{0, count == kPerWord ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1};
    if (count == kPerWord) sides = sides_of(points_.data() + begin, size(), unit.data(), d);
    for (auto rest = sides.unsure; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      sides.inside |= std::uint64_t{is_inside(begin + i)} << i;
    }
    mask[begin / kPerWord] = sides.inside;
  }
  return mask;
}

Cloud::Mask Cloud::mask(std::span<const HalfSpace> half_spaces) const {
  Mask all = everything();
  for (const HalfSpace& half_space : half_spaces) {
    const Mask one = mask(half_space);
    std::transform(all.begin(), all.end(), one.begin(), all.begin(), [](auto a, auto b) { return a & b; });
  }
  return all;
}

Share Cloud::share(std::span<const Mask* const> masks) const {
  const bool fits = std::all_of(masks.begin(), masks.end(), [&](const Mask* m) { return m->size() == num_words(); });
  if (!fits) throw std::invalid_argument{"Cloud: the masks must have the size of the cloud"};
  std::size_t count = masks.empty() ? size() : 0;
  for (std::size_t k = 0; !masks.empty() && k < num_words(); ++k) {
    std::uint64_t word = (*masks.front())[k];
    for (const Mask* mask : masks.subspan(1)) word &= (*mask)[k];
    count += static_cast<std::size_t>(std::popcount(word));
  }
  const auto n = static_cast<double>(size());
  const double p = (static_cast<double>(count) + 0.5) / (n + 1.0);
  return {static_cast<double>(count) / n, std::sqrt(p * (1.0 - p) / n)};
}

}  // namespace kith
