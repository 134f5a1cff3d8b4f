#include "slice_moves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kith/core/integer_vector.hpp"
#include "kith/core/vector_clones.hpp"
#include "kith/random/batch_normal.hpp"
#include "kith/random/distributions.hpp"

namespace kith::detail {
namespace {

constexpr int kMostShrinkages = 100;
constexpr double kNothing = -std::numeric_limits<double>::infinity();
constexpr std::size_t kLanes = 8;  // partial sums, which vectors of any width compute alike
constexpr std::size_t kBlock = NormalPairs::kBlock;

using Vector = std::array<double, IntegerVector::kMaxDimension>;

// The prior's half-spaces and those of the density one after the other, coordinate by coordinate, filled up to a
// multiple of kLanes with entries that never count. The prior's rule out what is beyond them.
struct Falls {
  std::size_t count = 0;        // a multiple of kLanes
  std::vector<double> normals;  // shape [d, count]
  std::vector<double> far, slope;

  explicit Falls(const FallingDensity& density) {
    const std::size_t d = density.dimension;
    const std::size_t in_prior = density.prior.size() / d;
    const std::size_t all = in_prior + density.far.size();
    count = (all + kLanes - 1) / kLanes * kLanes;
    normals.assign(d * count, 0.0);
    far.assign(count, 0.0);
    slope.assign(count, 0.0);
    for (std::size_t k = 0; k < d; ++k) {
      for (std::size_t j = 0; j < all; ++j) {
        normals[k * count + j] = j < in_prior ? density.prior[j * d + k] : density.normals[(j - in_prior) * d + k];
      }
    }
    std::fill_n(far.begin(), in_prior, kNothing);
    std::copy(density.far.begin(), density.far.end(), far.begin() + static_cast<std::ptrdiff_t>(in_prior));
    std::copy(density.slope.begin(), density.slope.end(), slope.begin() + static_cast<std::ptrdiff_t>(in_prior));
  }
};

// One great circle: x(angle) = point cos(angle) + side sin(angle). out[j] = u_j . point and out[count + j] = u_j .
// side.
KITH_VECTOR_CLONES void project(const Falls& falls, std::size_t d, const double* point, const double* side,
                                double* out) {
  const std::size_t n = falls.count;
  double* const along = out;
  double* const across = out + n;
  for (std::size_t j = 0; j < n; ++j) along[j] = across[j] = 0.0;
  for (std::size_t k = 0; k < d; ++k) {
    const double* const normal = falls.normals.data() + k * n;
    const double p = point[k];
    const double s = side[k];
    KITH_INDEPENDENT_LOOP
    for (std::size_t j = 0; j < n; ++j) {
      along[j] += normal[j] * p;
      across[j] += normal[j] * s;
    }
  }
}

// The log density at an angle of the circle.
KITH_VECTOR_CLONES double log_density(const Falls& falls, const double* projected, double cosine, double sine) {
  const std::size_t n = falls.count;
  const double* const along = projected;
  const double* const across = projected + n;
  const double* const far = falls.far.data();
  const double* const slope = falls.slope.data();
  std::array<double, kLanes> lane{};
  for (std::size_t j = 0; j < n; j += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double t = along[j + l] * cosine + across[j + l] * sine;
      const double fall = far[j + l] + slope[j + l] * t;
      lane[l] += t < 0.0 ? fall : 0.0;
    }
  }
  for (std::size_t half = kLanes / 2; half > 0; half /= 2) {
    for (std::size_t l = 0; l < half; ++l) lane[l] += lane[l + half];
  }
  return lane[0];
}

// Standard normals in single precision, one after the other.
class Normals {
 public:
  explicit Normals(RandomStream& random) : pairs_{random} {}

  double next() {
    if (used_ == 2 * kBlock) {
      pairs_.fill(block_++, values_[0], values_[1]);
      used_ = 0;
    }
    const std::size_t i = used_++;
    return static_cast<double>(values_[i / kBlock][i % kBlock]);
  }

 private:
  NormalPairs pairs_;
  std::uint64_t block_ = 0;
  std::size_t used_ = 2 * kBlock;
  std::array<NormalPairs::Block, 2> values_;
};

// A uniform unit vector at right angles to the point.
Vector tangent_at(const Vector& point, std::size_t d, Normals& normals) {
  Vector side{};
  double length = 0.0;
  while (!(length > 1e-6)) {
    double along = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      side[k] = normals.next();
      along += side[k] * point[k];
    }
    length = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      side[k] -= along * point[k];
      length += side[k] * side[k];
    }
    length = std::sqrt(length);
  }
  for (std::size_t k = 0; k < d; ++k) side[k] /= length;
  return side;
}

// Slice sampling on one great circle, whose bracket of the given width shrinks towards the point [neal2003].
void move_on_circle(const Falls& falls, const double* projected, double width, std::size_t d, const Vector& side,
                    Vector& point, RandomStream& random) {
  const double level = log_density(falls, projected, 1.0, 0.0) + std::log(uniform01(random));
  if (!(level > kNothing)) return;
  double high = width * uniform01(random);
  double low = high - width;
  for (int attempt = 0; attempt < kMostShrinkages; ++attempt) {
    const double angle = low + (high - low) * uniform01(random);
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    if (log_density(falls, projected, cosine, sine) > level) {
      double length = 0.0;
      for (std::size_t k = 0; k < d; ++k) {
        point[k] = point[k] * cosine + side[k] * sine;
        length += point[k] * point[k];
      }
      length = std::sqrt(length);
      for (std::size_t k = 0; k < d; ++k) point[k] /= length;
      return;
    }
    (angle < 0.0 ? low : high) = angle;
  }
}

}  // namespace

void move_in_density(const FallingDensity& density, const SliceSteps& steps, std::span<double> values,
                     RandomStream& random) {
  const std::size_t d = density.dimension;
  const std::size_t n = values.size() / d;
  const Falls falls{density};
  std::vector<double> projected(2 * falls.count);
  Normals normals{random};
  constexpr double kCircle = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < n; ++i) {
    Vector point{};
    for (std::size_t k = 0; k < d; ++k) point[k] = values[k * n + i];
    for (std::size_t sweep = 0; sweep < steps.sweeps; ++sweep) {
      const Vector side = tangent_at(point, d, normals);
      project(falls, d, point.data(), side.data(), projected.data());
      const double width = sweep % 2 == 0 ? kCircle : std::min(steps.width, kCircle);
      move_on_circle(falls, projected.data(), width, d, side, point, random);
    }
    for (std::size_t k = 0; k < d; ++k) values[k * n + i] = point[k];
  }
}

}  // namespace kith::detail
