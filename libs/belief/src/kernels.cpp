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

constexpr std::size_t kBlock = 256;

// As many lanes as the widest vectors have.
template <typename Number>
constexpr std::size_t kLanes = 64 / sizeof(Number);

// The sum of term(i) for i in [0, n), in interleaved partial sums, one per lane, that
// are then added pairwise.
template <typename Number, typename Term>
[[gnu::always_inline]] inline Number lane_sum(std::size_t n, Term term) {
  constexpr std::size_t lanes = kLanes<Number>;
  std::array<Number, lanes> lane{};
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) lane[l] += term(i + l);
  }
  for (std::size_t l = 0; i < n; ++i, ++l) lane[l] += term(i);
  for (std::size_t half = lanes / 2; half > 0; half /= 2) {
    for (std::size_t l = 0; l < half; ++l) lane[l] += lane[l + half];
  }
  return lane[0];
}

// The largest of the values, in any order: there is nothing to round.
template <typename Number>
[[gnu::always_inline]] inline Number largest_of(const Number* v, std::size_t n) {
  constexpr std::size_t lanes = kLanes<Number>;
  std::array<Number, lanes> lane;
  lane.fill(-std::numeric_limits<Number>::infinity());
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) lane[l] = v[i + l] > lane[l] ? v[i + l] : lane[l];
  }
  for (; i < n; ++i) lane[0] = v[i] > lane[0] ? v[i] : lane[0];
  Number top = lane[0];
  for (const Number candidate : lane) top = candidate > top ? candidate : top;
  return top;
}

// exp(y) for -708 <= y <= 0: y = k ln 2 + r with |r| <= ln(2) / 2, the Chebyshev interpolant
// of degree 11 in r (relative error 5e-18), and k added to the exponent bits.
[[gnu::always_inline]] inline double exp_reduced(double y) noexcept {
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
  constexpr double kLn2High = 0x1.62e42fee00000p-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  const double shifted = y * std::numbers::log2e + kRound;
  const double k = shifted - kRound;
  const double r = (y - k * kLn2High) - k * kLn2Low;
  double p = 2.5110049204818658e-08;
  p = p * r + 2.763265472252779e-07;
  p = p * r + 2.755724088722987e-06;
  p = p * r + 2.4801485441561313e-05;
  p = p * r + 0.00019841269890076403;
  p = p * r + 0.0013888888952352863;
  p = p * r + 0.008333333333319589;
  p = p * r + 0.04166666666648795;
  p = p * r + 0.1666666666666668;
  p = p * r + 0.5000000000000019;
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

// The same in single precision, of degree 5: relative error below 3e-6.
[[gnu::always_inline]] inline float square_arcsine_ratio(float v) noexcept {
  float p = 0.2677575f;
  p = p * v - 0.06885644f;
  p = p * v + 0.15819329f;
  p = p * v + 0.1722934f;
  p = p * v + 0.33357576f;
  return p * v + 0.9999983f;
}

// out[i] = the square of the angle whose half has the sine sqrt(v[i]), 0 <= v.
template <typename Number>
[[gnu::always_inline]] inline void square_angles(std::size_t n, const Number* v, Number* out) {
  for (std::size_t i = 0; i < n; ++i) out[i] = Number{4} * v[i] * square_arcsine_ratio(v[i]);
  if (!(largest_of(v, n) > Number{0.5})) return;
  for (std::size_t i = 0; i < n; ++i) {  // angles beyond a right angle, which are rare: from the supplement
    const Number rest = v[i] < Number{1} ? Number{1} - v[i] : Number{0};
    const Number angle = std::numbers::pi_v<Number> - Number{2} * std::sqrt(rest * square_arcsine_ratio(rest));
    out[i] = v[i] > Number{0.5} ? angle * angle : out[i];
  }
}

// weighted_square_angles in either precision. Weights below 1e-15 count as nothing: their single-precision
// products could be denormal, which is slow.
template <typename Number>
[[gnu::always_inline]] inline double sum_square_angles(const Points& points, std::span<const double> weights,
                                                       const Eigen::Vector3d& centre) {
  const auto cx = static_cast<Number>(centre.x());
  const auto cy = static_cast<Number>(centre.y());
  const auto cz = static_cast<Number>(centre.z());
  std::array<Number, kBlock> half_chord;  // sin^2(angle / 2), from the chord: accurate for small angles
  std::array<Number, kBlock> weight;
  std::array<Number, kBlock> square;
  Number* const v = half_chord.data();
  Number* const w = weight.data();
  Number* const out = square.data();
  double total = 0.0;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, points.size() - begin);
    const double* const px = points.x.data() + begin;
    const double* const py = points.y.data() + begin;
    const double* const pz = points.z.data() + begin;
    const double* const pw = weights.data() + begin;
    for (std::size_t i = 0; i < n; ++i) {
      const Number x = static_cast<Number>(px[i]) - cx;
      const Number y = static_cast<Number>(py[i]) - cy;
      const Number z = static_cast<Number>(pz[i]) - cz;
      v[i] = Number{0.25} * (x * x + y * y + z * z);
      w[i] = pw[i] < 1e-15 ? Number{0} : static_cast<Number>(pw[i]);
    }
    square_angles(n, v, out);
    total += static_cast<double>(lane_sum<Number>(n, [out, w](std::size_t i) { return w[i] * out[i]; }));
  }
  return total;
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
    if (likelihood.is_hard()) {
      planes_.values()[size_++] = {u.x(), u.y(), u.z(), -std::numeric_limits<double>::infinity()};
    } else {
      const double kappa = times * likelihood.concentration();
      planes_.values()[size_++] = {kappa * u.x(), kappa * u.y(), kappa * u.z(), times * likelihood.log_far()};
    }
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
  if (planes.empty()) std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Plane p = planes[k];
    const auto term = [&](std::size_t i) {
      const double t = p.x * x[i] + p.y * y[i] + p.z * z[i];
      return t < 0.0 ? p.log_far + t : 0.0;
    };
    if (k == 0) {
      KITH_INDEPENDENT_LOOP
      for (std::size_t i = 0; i < n; ++i) sum[i] = term(i);
    } else {
      KITH_INDEPENDENT_LOOP
      for (std::size_t i = 0; i < n; ++i) sum[i] += term(i);
    }
  }
}

KITH_VECTOR_CLONES double add(std::span<const double> terms, std::span<double> sums) {
  const double* const from = terms.data();
  double* const to = sums.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < sums.size(); ++i) to[i] += from[i];
  return largest_of(to, sums.size());
}

KITH_VECTOR_CLONES void raise(std::span<const double> others, std::span<double> values) {
  const double* const from = others.data();
  double* const to = values.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < values.size(); ++i) to[i] = from[i] > to[i] ? from[i] : to[i];
}

KITH_VECTOR_CLONES void gather(const Points& points, std::span<const std::uint32_t> index, const MutablePoints& out) {
  const double* const x = points.x.data();
  const double* const y = points.y.data();
  const double* const z = points.z.data();
  const std::uint32_t* const at = index.data();
  double* const to_x = out.x.data();
  double* const to_y = out.y.data();
  double* const to_z = out.z.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < index.size(); ++i) {
    const auto k = static_cast<std::int32_t>(at[i]);  // signed, as vectors gather
    to_x[i] = x[k];
    to_y[i] = y[k];
    to_z[i] = z[k];
  }
}

KITH_VECTOR_CLONES void scale_by(double scale, std::span<double> values) {
  double* const v = values.data();
  for (std::size_t i = 0; i < values.size(); ++i) v[i] *= scale;
}

KITH_VECTOR_CLONES double exp_below(std::span<const double> in, double shift, std::span<double> out) {
  const std::size_t n = in.size();
  const double* const from = in.data();
  double* const to = out.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < n; ++i) {
    const double y = from[i] - shift;
    const double value = exp_reduced(y < -708.0 ? -708.0 : y);
    to[i] = y < -708.0 ? 0.0 : value;
  }
  return lane_sum<double>(n, [to](std::size_t i) { return to[i]; });
}

KITH_VECTOR_CLONES void subtract(std::span<const double> values, double shift, std::span<double> out) {
  const double* const from = values.data();
  double* const to = out.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < out.size(); ++i) to[i] = from[i] - shift;
}

KITH_VECTOR_CLONES double sum_of_squares(std::span<const double> values) {
  const double* const v = values.data();
  return lane_sum<double>(values.size(), [v](std::size_t i) { return v[i] * v[i]; });
}

KITH_VECTOR_CLONES double largest(std::span<const double> values) { return largest_of(values.data(), values.size()); }

KITH_VECTOR_CLONES Eigen::Vector3d weighted_sum(const Points& points, std::span<const double> weights) {
  const double* const w = weights.data();
  const auto along = [&](std::span<const double> axis) {
    const double* const c = axis.data();
    return lane_sum<double>(weights.size(), [w, c](std::size_t i) { return w[i] * c[i]; });
  };
  return {along(points.x), along(points.y), along(points.z)};
}

KITH_VECTOR_CLONES double weighted_square_angles(const Points& points, std::span<const double> weights,
                                                 const Eigen::Vector3d& centre) {
  return sum_square_angles<double>(points, weights, centre);
}

KITH_VECTOR_CLONES double rough_square_angles(const Points& points, std::span<const double> weights,
                                              const Eigen::Vector3d& centre) {
  return sum_square_angles<float>(points, weights, centre);
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
    total += lane_sum<double>(n, [w](std::size_t i) { return w[i]; });
  }
  return total;
}

}  // namespace kith::detail
