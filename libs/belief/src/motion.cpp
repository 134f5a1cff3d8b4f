#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "kernels.hpp"
#include "kith/core/batch_normal.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/math.hpp"
#include "kith/core/vector_clones.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kBlock = NormalPairs::kBlock;
constexpr int kRetries = 20;
using Block = NormalPairs::Block;

struct Step {
  double along, across;  // in the tangent plane, radians
};

// A right-handed frame (first, second, p) without branches (Duff et al. 2017, "Building an Orthonormal
// Basis, Revisited"), and the combination first * along + second * across.
Eigen::Vector3d tangent(const Eigen::Vector3d& p, const Step& step) {
  const double sign = std::copysign(1.0, p.z());
  const double a = -1.0 / (sign + p.z());
  const double b = p.x() * p.y() * a;
  const Eigen::Vector3d first{1.0 + sign * p.x() * p.x() * a, sign * b, -sign * p.x()};
  const Eigen::Vector3d second{b, sign + p.y() * p.y() * a, -p.y()};
  return first * step.along + second * step.across;
}

// The exponential map, for any length of the step.
Eigen::Vector3d moved(const Eigen::Vector3d& p, const Step& step) {
  const double angle = std::sqrt(step.along * step.along + step.across * step.across);
  if (angle == 0.0) return p;
  const Eigen::Vector3d to = math::cos(angle) * p + (math::sin(angle) / angle) * tangent(p, step);
  return to / to.norm();
}

bool inside(const Eigen::Vector3d& p, std::span<const Eigen::Vector3d> normals) {
  return std::all_of(normals.begin(), normals.end(), [&](const Eigen::Vector3d& u) { return u.dot(p) >= 0.0; });
}

// Margins that single precision cannot tell from 0.
constexpr float kUnsure = 2e-6f;

// A block of moves at once, in single precision: by how much each point moves, the square of its
// angle, its smallest margin over the prior's normals there, and whether the
// move is one of the few to be made one by one: 1 or 0.
struct Moves {
  Block x, y, z;  // displacements
  Block to_x, to_y, to_z;
  Block square, margin;
  std::array<unsigned char, kBlock> is_odd;
};

// The displacement (cos r - 1) p + (sin r / r) (first along + second across) of each point, with r^2 = q. With
// g = sign along, w = x g + y across and k = -w / (sign + z), the tangent is (along + k x, sign across + k y, -w):
// the frame of tangent(). Chebyshev interpolants of (cos r - 1) / q and sin r / r for q <= 1, relative errors
// 5e-9 and 3e-8 before rounding; longer steps are made one by one.
KITH_VECTOR_CLONES void displace(const Points& points, std::size_t begin, std::size_t n, float angle,
                                 const float* along, const float* across, Moves& out) {
  const double* const px = points.x.data() + begin;
  const double* const py = points.y.data() + begin;
  const double* const pz = points.z.data() + begin;
  float* const dx = out.x.data();
  float* const dy = out.y.data();
  float* const dz = out.z.data();
  float* const to_x = out.to_x.data();
  float* const to_y = out.to_y.data();
  float* const to_z = out.to_z.data();
  float* const square = out.square.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < n; ++i) {
    const float s = angle * along[i];
    const float t = angle * across[i];
    const float q = s * s + t * t;
    float c = 2.4256145e-5f;
    c = c * q - 0.0013885491f;
    c = c * q + 0.041666599f;
    c = c * q - 0.5f;
    c = c * q;
    float f = -0.00019296961f;
    f = f * q + 0.0083299446f;
    f = f * q - 0.16666599f;
    f = f * q + 1.0f;
    const auto x = static_cast<float>(px[i]);
    const auto y = static_cast<float>(py[i]);
    const auto z = static_cast<float>(pz[i]);
    const float sign = z < 0.0f ? -1.0f : 1.0f;
    const float w = x * (sign * s) + y * t;
    const float k = w / (sign + z);
    dx[i] = c * x + f * (s - k * x);
    dy[i] = c * y + f * (sign * t - k * y);
    dz[i] = c * z - f * w;
    to_x[i] = x + dx[i];
    to_y[i] = y + dy[i];
    to_z[i] = z + dz[i];
    square[i] = q;
  }
}

// Longer moves than displace() can make, and those that would leave the prior or end so close to its
// boundary that single precision cannot tell, are odd.
KITH_VECTOR_CLONES void find_odd(std::size_t n, std::span<const Eigen::Vector3d> normals, Moves& moves) {
  const float* const x = moves.to_x.data();
  const float* const y = moves.to_y.data();
  const float* const z = moves.to_z.data();
  float* const least = moves.margin.data();
  std::fill_n(least, n, 1.0f);
  for (const Eigen::Vector3d& u : normals) {
    const auto ux = static_cast<float>(u.x());
    const auto uy = static_cast<float>(u.y());
    const auto uz = static_cast<float>(u.z());
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < n; ++i) {
      const float t = ux * x[i] + uy * y[i] + uz * z[i];
      least[i] = t < least[i] ? t : least[i];
    }
  }
  const float* const square = moves.square.data();
  unsigned char* const flag = moves.is_odd.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < n; ++i) flag[i] = square[i] > 1.0f || least[i] < kUnsure ? 1 : 0;
}

// Adds the displacements in double precision. They are tangent to 1e-7 only, so the sum is
// divided by its length: with e = length^2 - 1 by the series of (1 + e)^(-1/2), whose rest is below 1e-19.
KITH_VECTOR_CLONES void arrive(const Points& from, std::size_t begin, std::size_t n, const Moves& moves,
                               const MutablePoints& to) {
  const double* const px = from.x.data() + begin;
  const double* const py = from.y.data() + begin;
  const double* const pz = from.z.data() + begin;
  const float* const dx = moves.x.data();
  const float* const dy = moves.y.data();
  const float* const dz = moves.z.data();
  double* const to_x = to.x.data() + begin;
  double* const to_y = to.y.data() + begin;
  double* const to_z = to.z.data() + begin;
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < n; ++i) {
    const double x = px[i] + static_cast<double>(dx[i]);
    const double y = py[i] + static_cast<double>(dy[i]);
    const double z = pz[i] + static_cast<double>(dz[i]);
    const double e = x * x + y * y + z * z - 1.0;
    const double scale = 1.0 + e * (0.375 * e - 0.5);
    to_x[i] = x * scale;
    to_y[i] = y * scale;
    to_z[i] = z * scale;
  }
}

// Another try for a point whose move left the prior.
Eigen::Vector3d redrawn(const Eigen::Vector3d& from, double angle, std::span<const Eigen::Vector3d> normals,
                        RandomStream& random) {
  for (int attempt = 0; attempt < kRetries; ++attempt) {
    std::array<double, 2> normal;
    fill_standard_normal(normal, random);
    const Eigen::Vector3d to = moved(from, {angle * normal[0], angle * normal[1]});
    if (inside(to, normals)) return to;
  }
  return from;
}

// Where the odd points of a block go.
class OddMoves {
 public:
  // From where they are, before anything is overwritten.
  OddMoves(const Points& from, std::size_t begin, std::size_t n, double angle, const Block& along, const Block& across,
           std::span<const Eigen::Vector3d> normals, const Moves& moves, RandomStream& random) {
    const auto* const flags = moves.is_odd.data();
    const auto next = [&](std::size_t first) {
      const void* const odd = std::memchr(flags + first, 1, n - first);
      return odd == nullptr ? n : static_cast<std::size_t>(static_cast<const unsigned char*>(odd) - flags);
    };
    for (std::size_t i = next(0); i < n; i = next(i + 1)) {
      const Eigen::Vector3d start{from.x[begin + i], from.y[begin + i], from.z[begin + i]};
      const Step step{angle * static_cast<double>(along[i]), angle * static_cast<double>(across[i])};
      // A short step that surely leads outside need not be made at all.
      const bool is_lost = moves.square[i] <= 1.0f && moves.margin[i] < -kUnsure;
      Eigen::Vector3d to = is_lost ? start : moved(start, step);
      if (is_lost || !inside(to, normals)) to = redrawn(start, angle, normals, random);
      at_[size_] = begin + i;
      x_[size_] = to.x();
      y_[size_] = to.y();
      z_[size_] = to.z();
      ++size_;
    }
  }

  void arrive(const MutablePoints& to) const {
    for (std::size_t k = 0; k < size_; ++k) {
      to.x[at_[k]] = x_[k];
      to.y[at_[k]] = y_[k];
      to.z[at_[k]] = z_[k];
    }
  }

 private:
  std::size_t size_ = 0;
  std::array<std::size_t, kBlock> at_;
  std::array<double, kBlock> x_, y_, z_;
};

}  // namespace

void move_points(const Points& from, double angle, std::span<const Eigen::Vector3d> normals, RandomStream& random,
                 const MutablePoints& to) {
  const NormalPairs normal{random};
  Block along;
  Block across;
  Moves moves;
  for (std::size_t begin = 0; begin < from.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, from.size() - begin);
    normal.fill(begin / kBlock, along, across);
    displace(from, begin, n, static_cast<float>(angle), along.data(), across.data(), moves);
    find_odd(n, normals, moves);
    const OddMoves odd{from, begin, n, angle, along, across, normals, moves, random};
    arrive(from, begin, n, moves, to);
    odd.arrive(to);
  }
}

}  // namespace kith::detail
