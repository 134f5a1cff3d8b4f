#include "kith/geometry/cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace kith {
namespace {

// Where a product comes this close to 0, its sign may depend on the order of the sum.
constexpr double kUnsure = 1e-12;

// Sets the bits of the points inside. `decide` tells it of the few points near the boundary.
template <std::size_t d, typename Decide>
void fill_mask(const double* points, const double* normal, std::size_t n, const Decide& decide, Cloud::Mask& mask) {
  constexpr std::size_t kBits = 64;
  std::array<double, kBits> products{};
  for (std::size_t begin = 0; begin < n; begin += kBits) {
    const std::size_t count = std::min(kBits, n - begin);
    for (std::size_t i = 0; i < count; ++i) {
      double t = 0.0;
      for (std::size_t k = 0; k < d; ++k) t += normal[k] * points[(begin + i) * d + k];
      products[i] = t;
    }
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double t = products[i];
      word |= std::uint64_t{std::abs(t) > kUnsure ? t > 0.0 : decide(begin + i)} << i;
    }
    mask[begin / kBits] = word;
  }
}

}  // namespace

Cloud::Mask Cloud::everything() const {
  Mask mask(num_words(), ~std::uint64_t{0});
  if (size() % 64 != 0) mask.back() = (std::uint64_t{1} << (size() % 64)) - 1;
  return mask;
}

Cloud::Mask Cloud::mask(const HalfSpace& half_space) const {
  if (static_cast<Eigen::Index>(half_space.dimension()) != points_.rows()) {
    throw std::invalid_argument{"Cloud: the half-space must have the dimension of the region"};
  }
  const Direction unit = half_space.unit();
  Mask mask(num_words());
  const auto is_inside = [&](std::size_t i) { return points_.col(static_cast<Eigen::Index>(i)).dot(unit) >= 0.0; };
  switch (points_.rows()) {
    case 4:
      fill_mask<4>(points_.data(), unit.data(), size(), is_inside, mask);
      break;
    case 5:
      fill_mask<5>(points_.data(), unit.data(), size(), is_inside, mask);
      break;
    case 6:
      fill_mask<6>(points_.data(), unit.data(), size(), is_inside, mask);
      break;
    case 7:
      fill_mask<7>(points_.data(), unit.data(), size(), is_inside, mask);
      break;
    case 8:
      fill_mask<8>(points_.data(), unit.data(), size(), is_inside, mask);
      break;
    default:
      for (std::size_t i = 0; i < size(); ++i) mask[i / 64] |= std::uint64_t{is_inside(i)} << (i % 64);
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
