#include "kernels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "kith/core/vector_clones.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kBlock = 256;

// The sum of term(i) for i in [0, n), in kLanes interleaved partial sums that
// are then added pairwise.
template <typename Term>
[[gnu::always_inline]] inline double lane_sum(std::size_t n, Term term) {
  std::array<double, kLanes> lane{};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lane[l] += term(i + l);
  }
  for (std::size_t l = 0; i < n; ++i, ++l) lane[l] += term(i);
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

// The largest of the values, in any order: there is nothing to round.
[[gnu::always_inline]] inline double largest_of(std::span<const double> values) {
  std::array<double, kLanes> lane;
  lane.fill(-std::numeric_limits<double>::infinity());
  const double* const v = values.data();
  std::size_t i = 0;
  for (; i + kLanes <= values.size(); i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lane[l] = v[i + l] > lane[l] ? v[i + l] : lane[l];
  }
  for (; i < values.size(); ++i) lane[0] = v[i] > lane[0] ? v[i] : lane[0];
  double top = lane[0];
  for (const double candidate : lane) top = candidate > top ? candidate : top;
  return top;
}

// exp(y) for -708 <= y <= 0: y = k ln 2 + r with |r| <= ln(2) / 2, Taylor's
// polynomial of degree 13 in r, and k added to the exponent bits.
[[gnu::always_inline]] inline double exp_reduced(double y) noexcept {
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
  constexpr double kLn2High = 0x1.62e42fee00000p-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  const double shifted = y * std::numbers::log2e + kRound;
  const double k = shifted - kRound;
  const double r = (y - k * kLn2High) - k * kLn2Low;
  double p = 1.0 / 6227020800.0;
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  return p * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023u) << 52);
}

// arcsin(sqrt(v))^2 / v on [0, 1/2], relative error below 6e-13: the Chebyshev
// interpolant of degree 13 in powers of v.
[[gnu::always_inline]] inline double square_arcsine_ratio(double v) noexcept {
  double p = 0.8916180467849655;
  p = p * v - 2.1519280692625338;
  p = p * v + 2.5434297399649264;
  p = p * v - 1.728829180101958;
  p = p * v + 0.828033809756918;
  p = p * v - 0.21563291406967802;
  p = p * v + 0.09336631805740617;
  p = p * v + 0.0407799916493493;
  p = p * v + 0.06235738200469336;
  p = p * v + 0.08121936358727501;
  p = p * v + 0.11428763536324937;
  p = p * v + 0.1777777398414143;
  p = p * v + 0.33333333362689993;
  return p * v + 0.9999999999996251;
}

}  // namespace

Planes::Planes(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood)
    : planes_{half_spaces.size()} {
  Scratch<const HalfSpace*, 32> pointers{half_spaces.size()};
  const std::span<const HalfSpace*> sorted = pointers.values();
  std::transform(half_spaces.begin(), half_spaces.end(), sorted.begin(), [](const HalfSpace& h) { return &h; });
  std::sort(sorted.begin(), sorted.end(), [](const HalfSpace* a, const HalfSpace* b) { return *a < *b; });
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t next = i + 1;
    while (next < sorted.size() && *sorted[next] == *sorted[i]) ++next;
    const Eigen::Vector3d& u = sorted[i]->unit_normal();
    const auto times = static_cast<double>(next - i);
    // Not times * log_far where that is 0 * infinity: both factors are never such here, as times >= 1.
    planes_.values()[size_++] = {u.x(), u.y(), u.z(), times * likelihood.log_far(), times * likelihood.concentration()};
    i = next;
  }
}

KITH_VECTOR_CLONES void log_relative_products(const Points& points, std::span<const Plane> planes,
                                              std::span<double> out) {
  const std::size_t n = points.size();
  const double* const x = points.x.data();
  const double* const y = points.y.data();
  const double* const z = points.z.data();
  double* const sum = out.data();
  std::fill(out.begin(), out.end(), 0.0);
  for (const Plane& plane : planes) {
    const Plane p = plane;
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < n; ++i) {
      const double t = p.ux * x[i] + p.uy * y[i] + p.uz * z[i];
      const double far = p.log_far + p.kappa * t;  // meaningless, perhaps NaN, on the near side
      sum[i] += t < 0.0 ? far : 0.0;
    }
  }
}

KITH_VECTOR_CLONES double add(std::span<const double> terms, std::span<double> sums) {
  const double* const from = terms.data();
  double* const to = sums.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < sums.size(); ++i) to[i] += from[i];
  return largest_of(sums);
}

KITH_VECTOR_CLONES void raise(std::span<const double> others, std::span<double> values) {
  const double* const from = others.data();
  double* const to = values.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < values.size(); ++i) to[i] = from[i] > to[i] ? from[i] : to[i];
}

void gather(std::span<const double> values, std::span<const std::uint32_t> index, std::span<double> out) {
  const double* const from = values.data();
  const std::uint32_t* const at = index.data();
  double* const to = out.data();
  for (std::size_t i = 0; i < out.size(); ++i) to[i] = from[at[i]];
}

KITH_VECTOR_CLONES double rescale(double scale, std::span<double> values) {
  double* const v = values.data();
  for (std::size_t i = 0; i < values.size(); ++i) v[i] *= scale;
  return lane_sum(values.size(), [v](std::size_t i) { return v[i] * v[i]; });
}

KITH_VECTOR_CLONES double exp_below(std::span<const double> in, double shift, std::span<double> out) {
  const std::size_t n = in.size();
  const double* const from = in.data();
  double* const to = out.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double y = from[i] - shift;
    const double value = exp_reduced(y < -708.0 ? -708.0 : y);
    to[i] = y < -708.0 ? 0.0 : value;
  }
  return lane_sum(n, [to](std::size_t i) { return to[i]; });
}

KITH_VECTOR_CLONES void subtract(std::span<const double> values, double shift, std::span<double> out) {
  const double* const from = values.data();
  double* const to = out.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < out.size(); ++i) to[i] = from[i] - shift;
}

KITH_VECTOR_CLONES double sum_of_squares(std::span<const double> values) {
  const double* const v = values.data();
  return lane_sum(values.size(), [v](std::size_t i) { return v[i] * v[i]; });
}

KITH_VECTOR_CLONES double largest(std::span<const double> values) { return largest_of(values); }

KITH_VECTOR_CLONES Eigen::Vector3d weighted_sum(const Points& points, std::span<const double> weights) {
  const double* const w = weights.data();
  const auto along = [&](std::span<const double> axis) {
    const double* const c = axis.data();
    return lane_sum(weights.size(), [w, c](std::size_t i) { return w[i] * c[i]; });
  };
  return {along(points.x), along(points.y), along(points.z)};
}

KITH_VECTOR_CLONES double weighted_square_angles(const Points& points, std::span<const double> weights,
                                                 const Eigen::Vector3d& centre) {
  const double cx = centre.x();
  const double cy = centre.y();
  const double cz = centre.z();
  std::array<double, kBlock> half_chord;  // sin^2(angle / 2), from the chord: accurate for small angles
  std::array<double, kBlock> square;
  double* const v = half_chord.data();
  double* const out = square.data();
  double total = 0.0;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, points.size() - begin);
    const double* const x = points.x.data() + begin;
    const double* const y = points.y.data() + begin;
    const double* const z = points.z.data() + begin;
    const double* const w = weights.data() + begin;
    for (std::size_t i = 0; i < n; ++i) {
      v[i] = 0.25 * ((x[i] - cx) * (x[i] - cx) + (y[i] - cy) * (y[i] - cy) + (z[i] - cz) * (z[i] - cz));
      out[i] = 4.0 * v[i] * square_arcsine_ratio(v[i]);
    }
    if (largest_of({v, n}) > 0.5) {  // angles beyond a right angle, which are rare: from the supplement
      for (std::size_t i = 0; i < n; ++i) {
        const double rest = v[i] < 1.0 ? 1.0 - v[i] : 0.0;
        const double angle = std::numbers::pi - 2.0 * std::sqrt(rest * square_arcsine_ratio(rest));
        out[i] = v[i] > 0.5 ? angle * angle : out[i];
      }
    }
    total += lane_sum(n, [out, w](std::size_t i) { return w[i] * out[i]; });
  }
  return total;
}

KITH_VECTOR_CLONES double weight_inside(const Points& points, std::span<const double> weights,
                                        std::span<const HalfSpace> half_spaces) {
  std::array<double, kBlock> inside;
  double total = 0.0;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, points.size() - begin);
    const double* const x = points.x.data() + begin;
    const double* const y = points.y.data() + begin;
    const double* const z = points.z.data() + begin;
    double* const w = inside.data();
    std::copy_n(weights.data() + begin, n, w);
    for (const HalfSpace& h : half_spaces) {
      const double ux = h.unit_normal().x();
      const double uy = h.unit_normal().y();
      const double uz = h.unit_normal().z();
      for (std::size_t i = 0; i < n; ++i) w[i] = ux * x[i] + uy * y[i] + uz * z[i] < 0.0 ? 0.0 : w[i];
    }
    total += lane_sum(n, [w](std::size_t i) { return w[i]; });
  }
  return total;
}

}  // namespace kith::detail
