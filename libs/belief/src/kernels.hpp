#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/core/stream.hpp"
#include "kith/geometry/half_space.hpp"
#include "scratch.hpp"

// The inner loops of the particle filter, over structures of arrays. They are
// plain loops that the compiler vectorises; sums run in a fixed number of lanes,
// so a result does not depend on the width of the machine's vectors.
namespace kith::detail {

// Points of the sphere as three arrays of equal length.
struct Points {
  std::span<const double> x, y, z;
  [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
};
struct MutablePoints {
  std::span<double> x, y, z;
  [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
};

// One half-space's contribution to the exponent: t = (x, y, z) . p < 0 ? log_far + t : 0. The vector is kappa times
// the unit normal; the unit normal if the far side is impossible, where log_far is -infinity.
struct Plane {
  double x, y, z, log_far;
};

// The half-spaces as planes, sorted, with repetitions merged into one of a
// multiple weight: so the order of the list cannot change the rounding.
class Planes {
 public:
  Planes(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood);
  [[nodiscard]] std::span<const Plane> list() { return planes_.values().first(size_); }

 private:
  Scratch<Plane, 32> planes_;
  std::size_t size_ = 0;
};

// out[i] = the exponent of point i, summed over the planes: the log of the
// product of relative likelihoods.
void log_relative_products(const Points& points, std::span<const Plane> planes, std::span<double> out);

// sums[i] += terms[i]; returns the largest sum.
double add(std::span<const double> terms, std::span<double> sums);
// values[i] = max(values[i], others[i]).
void raise(std::span<const double> others, std::span<double> values);
// Point i of `out` = point index[i] of `points`, which is another array.
void gather(const Points& points, std::span<const std::uint32_t> index, const MutablePoints& out);

// out[i] = exp(in[i] - shift) for in[i] <= shift, with 0 below exp(-708);
// relative error below 1e-15. Returns the sum.
double exp_below(std::span<const double> in, double shift, std::span<double> out);

// out[i] = values[i] - shift.
void subtract(std::span<const double> values, double shift, std::span<double> out);
// values[i] *= scale.
void scale_by(double scale, std::span<double> values);

[[nodiscard]] double sum_of_squares(std::span<const double> values);
[[nodiscard]] double largest(std::span<const double> values);

// sum_i weights[i] points[i].
[[nodiscard]] Eigen::Vector3d weighted_sum(const Points& points, std::span<const double> weights);

// sum_i weights[i] angle(points[i], centre)^2, relative error below 1e-12.
[[nodiscard]] double weighted_square_angles(const Points& points, std::span<const double> weights,
                                            const Eigen::Vector3d& centre);
// The same in single precision, for weights of at most 1: relative error below 1e-5.
[[nodiscard]] double rough_square_angles(const Points& points, std::span<const double> weights,
                                         const Eigen::Vector3d& centre);

// Sum of the weights of the points with normal . p >= 0 for all of the half-spaces.
[[nodiscard]] double weight_inside(const Points& points, std::span<const double> weights,
                                   std::span<const HalfSpace> half_spaces);

// Moves every point by N(0, angle^2) per axis in its tangent plane, through the
// exponential map, from `from` to `to`, which may be the same arrays. A move to where some normal . p < 0 is
// drawn again up to 20 times, else the point stays. Displacements are computed in single precision (relative
// error 1e-6), what they arrive at is of unit length to 1e-15.
void move_points(const Points& from, double angle, std::span<const Eigen::Vector3d> normals, RandomStream& random,
                 const MutablePoints& to);

}  // namespace kith::detail
