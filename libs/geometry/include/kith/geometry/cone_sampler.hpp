#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// A cone in d = 2 to 8 dimensions prepared for measuring, drawing and covering.
///
/// Above three dimensions the cone is cut into simplicial cones with unit rays R
/// (its lines, if any, are split off: the rest stands at right angles to them).
/// The point R lambda / |R lambda| of the sphere, lambda uniform on the standard
/// simplex, has a density in proportion to |R lambda|^d, so that the area of one
/// of the parts is |det R| / (d-1)! times the mean of |R lambda|^-d. Parts whose
/// rays are far apart are halved until no part weighs too much.
///
/// Takes milliseconds to make where the cone has hundreds of extreme rays; make
/// one for many draws. The same for equal cones, bit by bit.
class ConeSampler {
 public:
  /// @throws std::length_error if the cone falls into more than a million simplicial cones.
  explicit ConeSampler(const Cone& cone);

  [[nodiscard]] const Cone& cone() const noexcept { return cone_; }
  [[nodiscard]] std::size_t dimension() const noexcept { return cone_.dimension(); }
  /// How many simplicial cones it was cut into; 0 for d = 2 and 3.
  [[nodiscard]] std::size_t num_parts() const noexcept { return parts_.size(); }

  /// Cone::measure of the cone. Closed forms where at most three dimensions are left
  /// beside the lines. Otherwise the mean of 16 randomised quasi-Monte Carlo
  /// estimates, Sobol points with digital shifts from a fixed stream: an
  /// unbiased estimate, and its standard error from their spread. Both are in
  /// proportion to the area, however tiny the cone.
  /// @param points per estimate.
  [[nodiscard]] SolidAngle solid_angle(std::size_t points = 1024) const;

  /// A uniform draw from the cone's part of the unit sphere, shape [d]; inside up to
  /// rounding. In three dimensions Cone::sample; above by rejection, which is exact,
  /// with 2 (d + 1) draws of 32 bits for each of usually one to twelve attempts.
  [[nodiscard]] Direction sample(RandomStream& random) const;

  /// Exactly n points that cover the cone's part of the sphere evenly, shape [d, n]:
  /// equal arcs in two dimensions, fibonacci_cover in three; above, the first n
  /// Sobol points that the rejection of sample() accepts. No randomness.
  /// @throws std::invalid_argument if n == 0.
  [[nodiscard]] Eigen::MatrixXd cover(std::size_t n) const;

 private:
  // A simplicial cone of `rank_` of the rays.
  struct Part {
    std::array<std::uint32_t, 8> rays;
    double content;  // |det R|
    double peak;     // the largest |R lambda|^-2
    double typical;  // one over the mean of |R lambda|^2
  };
  // What a point of the simplex becomes.
  struct Proposal {
    Direction point;
    double acceptance;
  };

  void make_arc();
  void make_parts();
  void measure(Part& part) const;
  void halve_wide_parts();
  void halve(std::size_t part);
  [[nodiscard]] Direction arc_point(double t) const;
  [[nodiscard]] Proposal propose(double which, std::span<const double> lambda) const;
  [[nodiscard]] double closed_form_share() const;
  [[nodiscard]] std::vector<double> shares(std::size_t points) const;

  Cone cone_;
  std::size_t rank_ = 0;   // dimensions beside the lines
  Eigen::MatrixXd axes_;   // orthonormal; the lines, shape [d, d - rank]; in two dimensions the arc's start and quarter
  double arc_ = 0.0;       // d = 2: its length
  Eigen::MatrixXd frame_;  // orthonormal; the rest, shape [d, rank]
  Eigen::MatrixXd rays_;   // unit columns in the frame, shape [rank, .]
  std::vector<Part> parts_;
  std::vector<double> envelope_;  // of all parts so far: content times the largest density
};

}  // namespace kith
