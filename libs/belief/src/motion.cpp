#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "kernels.hpp"
#include "kith/core/vector_clones.hpp"
#include "kith/random/batch_normal.hpp"
#include "kith/random/distributions.hpp"

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
  const double angle = std::hypot(step.along, step.across);
  if (angle == 0.0) return p;
  const Eigen::Vector3d to = std::cos(angle) * p + (std::sin(angle) / angle) * tangent(p, step);
  return to / to.norm();
}

bool inside(const Eigen::Vector3d& p, std::span<const Eigen::Vector3d> normals) {
  return std::all_of(normals.begin(), normals.end(), [&](const Eigen::Vector3d& u) { return u.dot(p) >= 0.0; });
}

// A block of moves at once: where each point would go, the square of its
// angle, its smallest margin over the prior's normals there, and whether the
// move is one of the few to be mended: 1 or 0.
struct Moves {
  Block x, y, z, square, margin;
  std::array<unsigned char, kBlock> is_odd;
};

// Series of cos(sqrt q) and sin(sqrt q) / sqrt q, accurate to 3e-16 for q <= 1;
// longer steps are mended afterwards.
KITH_VECTOR_CLONES void move_block(const MutablePoints& points, std::size_t begin, std::size_t n, double angle,
                                   const double* along, const double* across, Moves& out) {
  const double* const px = points.x.data() + begin;
  const double* const py = points.y.data() + begin;
  const double* const pz = points.z.data() + begin;
  double* const to_x = out.x.data();
  double* const to_y = out.y.data();
  double* const to_z = out.z.data();
  double* const square = out.square.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < n; ++i) {
    const double s = angle * along[i];
    const double t = angle * across[i];
    const double q = s * s + t * t;
    double c = 1.0 / 20922789888000.0;
    c = c * q - 1.0 / 87178291200.0;
    c = c * q + 1.0 / 479001600.0;
    c = c * q - 1.0 / 3628800.0;
    c = c * q + 1.0 / 40320.0;
    c = c * q - 1.0 / 720.0;
    c = c * q + 1.0 / 24.0;
    c = c * q - 0.5;
    c = c * q + 1.0;
    double f = 1.0 / 355687428096000.0;
    f = f * q - 1.0 / 1307674368000.0;
    f = f * q + 1.0 / 6227020800.0;
    f = f * q - 1.0 / 39916800.0;
    f = f * q + 1.0 / 362880.0;
    f = f * q - 1.0 / 5040.0;
    f = f * q + 1.0 / 120.0;
    f = f * q - 1.0 / 6.0;
    f = f * q + 1.0;
    const double x = px[i];
    const double y = py[i];
    const double z = pz[i];
    const double sign = z < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + z);
    const double b = x * y * a;
    const double mx = c * x + f * ((1.0 + sign * x * x * a) * s + b * t);
    const double my = c * y + f * (sign * b * s + (sign + y * y * a) * t);
    const double mz = c * z - f * (sign * x * s + y * t);
    // One step of Newton's iteration for 1 / |m| keeps rounding from building up over many moves.
    const double scale = 1.5 - 0.5 * (mx * mx + my * my + mz * mz);
    to_x[i] = mx * scale;
    to_y[i] = my * scale;
    to_z[i] = mz * scale;
    square[i] = q;
  }
}

// Longer moves than the series of move_block reach, and those that would leave the prior, are odd.
KITH_VECTOR_CLONES void find_odd(std::size_t n, std::span<const Eigen::Vector3d> normals, Moves& moves) {
  const double* const x = moves.x.data();
  const double* const y = moves.y.data();
  const double* const z = moves.z.data();
  double* const least = moves.margin.data();
  std::fill_n(least, n, 1.0);
  for (const Eigen::Vector3d& u : normals) {
    const double ux = u.x();
    const double uy = u.y();
    const double uz = u.z();
    KITH_INDEPENDENT_LOOP
    for (std::size_t i = 0; i < n; ++i) {
      const double t = ux * x[i] + uy * y[i] + uz * z[i];
      least[i] = t < least[i] ? t : least[i];
    }
  }
  const double* const square = moves.square.data();
  unsigned char* const flag = moves.is_odd.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < n; ++i) flag[i] = square[i] > 1.0 || least[i] < 0.0 ? 1 : 0;
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

// The few moves of a block that its loops cannot make: those farther than their
// series reach, and those that would leave the prior.
void mend(const MutablePoints& points, std::size_t begin, std::size_t n, double angle, const Block& along,
          const Block& across, std::span<const Eigen::Vector3d> normals, RandomStream& random, Moves& moves) {
  const auto* const flags = moves.is_odd.data();
  const auto next = [&](std::size_t from) {
    const void* const odd = std::memchr(flags + from, 1, n - from);
    return odd == nullptr ? n : static_cast<std::size_t>(static_cast<const unsigned char*>(odd) - flags);
  };
  for (std::size_t i = next(0); i < n; i = next(i + 1)) {
    const Eigen::Vector3d from{points.x[begin + i], points.y[begin + i], points.z[begin + i]};
    const bool is_long = moves.square[i] > 1.0;
    Eigen::Vector3d to = from;
    if (is_long) to = moved(from, {angle * along[i], angle * across[i]});
    if (!is_long || !inside(to, normals)) to = redrawn(from, angle, normals, random);
    moves.x[i] = to.x();
    moves.y[i] = to.y();
    moves.z[i] = to.z();
  }
}

}  // namespace

void move_points(const MutablePoints& points, double angle, std::span<const Eigen::Vector3d> normals,
                 RandomStream& random) {
  const NormalPairs normal{random};
  Block along;
  Block across;
  Moves moves;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, points.size() - begin);
    normal.fill(begin / kBlock, along, across);
    move_block(points, begin, n, angle, along.data(), across.data(), moves);
    find_odd(n, normals, moves);
    mend(points, begin, n, angle, along, across, normals, random, moves);
    const auto offset = static_cast<std::ptrdiff_t>(begin);
    std::copy_n(moves.x.begin(), n, points.x.begin() + offset);
    std::copy_n(moves.y.begin(), n, points.y.begin() + offset);
    std::copy_n(moves.z.begin(), n, points.z.begin() + offset);
  }
}

}  // namespace kith::detail
