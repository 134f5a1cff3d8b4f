#include "simplex_points.hpp"

#include <array>
#include <utility>

#include "kith/core/assert.hpp"
#include "kith/core/stream.hpp"
#include "nearest_point.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMost = IntegerVector::kMaxDimension;
constexpr std::size_t kCoverPoints = 32768;  // at most 2.6 MB for each n
constexpr std::uint64_t kShiftSeed = 4;      // any will do

enum class Purpose { kCover, kArea };

template <Purpose purpose, std::size_t n>
const SimplexPoints& points_of() {
  static const SimplexPoints points = purpose == Purpose::kCover
                                          ? SimplexPoints{n, std::vector<Sobol::Shift>(1), kCoverPoints}
                                          : SimplexPoints{n, area_shifts(), kAreaPoints};
  return points;
}

template <Purpose purpose, std::size_t... n>
const SimplexPoints& points_for(std::size_t wanted, std::index_sequence<n...>) {
  using Make = const SimplexPoints& (*)();
  constexpr std::array<Make, sizeof...(n)> kMake{&points_of<purpose, n + 1>...};
  KITH_ASSERT(wanted >= 1 && wanted <= sizeof...(n));
  return kMake[wanted - 1]();
}

}  // namespace

SimplexPoints::SimplexPoints(std::size_t n, std::span<const Sobol::Shift> shifts, std::size_t count) : n_{n} {
  numbers_.reserve(shifts.size() * count * (n + 2));
  for (const auto& shift : shifts) {
    Sobol sobol{shift};
    for (std::size_t i = 0; i < count; ++i) {
      sobol.next();
      append(sobol, n, numbers_);
    }
  }
}

void SimplexPoints::append(const Sobol& sobol, std::size_t n, std::vector<double>& numbers) {
  std::array<double, kMost> uniforms{};
  for (std::size_t k = 1; k < n; ++k) uniforms[k - 1] = sobol[k];
  SimplexMap lambda{std::span{uniforms}.first(n - 1)};
  numbers.push_back(sobol[0]);
  for (std::size_t k = 0; k < n; ++k) numbers.push_back(lambda.next());
  numbers.push_back(sobol[n]);
}

std::vector<Sobol::Shift> area_shifts() {
  std::vector<Sobol::Shift> shifts(kAreaEstimates);
  RandomStream random{kShiftSeed};
  for (auto& shift : shifts)
    for (std::uint32_t& bits : shift) bits = random();
  return shifts;
}

const SimplexPoints& cover_points(std::size_t n) {
  return points_for<Purpose::kCover>(n, std::make_index_sequence<kMost>{});
}

const SimplexPoints& area_points(std::size_t n) {
  return points_for<Purpose::kArea>(n, std::make_index_sequence<kMost>{});
}

}  // namespace kith::detail
