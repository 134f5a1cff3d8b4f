#include "sphere_points.hpp"

#include <algorithm>
#include <utility>

#include "general_kernels.hpp"
#include "kernels.hpp"
#include "scratch.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kThree = 3;
constexpr double kVanishing = 1e-12;  // length of a sum without a direction

Points in_three(std::span<const double> values) {
  const std::size_t n = values.size() / kThree;
  return {values.first(n), values.subspan(n, n), values.last(n)};
}

MutablePoints in_three(std::span<double> values) {
  const std::size_t n = values.size() / kThree;
  return {values.first(n), values.subspan(n, n), values.last(n)};
}

// Normals in three dimensions, for the time of one call.
class Normals {
 public:
  explicit Normals(const std::vector<Direction>& normals) : normals_{normals.size()} {
    std::transform(normals.begin(), normals.end(), normals_.values().begin(),
                   [](const Direction& normal) { return Eigen::Vector3d{normal}; });
  }
  [[nodiscard]] std::span<const Eigen::Vector3d> list() { return normals_.values(); }

 private:
  Scratch<Eigen::Vector3d, 16> normals_;
};

}  // namespace

void SpherePoints::log_relative_products(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                                         std::span<double> out) const {
  if (dimension_ == kThree) {
    detail::log_relative_products(in_three(values_), Planes{half_spaces, likelihood}.list(), out);
  } else {
    detail::log_relative_products(AxisPoints{values_, dimension_}, half_spaces, likelihood, out);
  }
}

double SpherePoints::weight_inside(std::span<const double> weights, std::span<const HalfSpace> half_spaces) const {
  if (dimension_ == kThree) return detail::weight_inside(in_three(values_), weights, half_spaces);
  return detail::weight_inside(AxisPoints{values_, dimension_}, weights, half_spaces);
}

Direction SpherePoints::mean_direction(std::span<const double> weights) const {
  if (dimension_ == kThree) {
    const Points points = in_three(values_);
    const Eigen::Vector3d sum = weighted_sum(points, weights);
    const double length = sum.norm();
    return length < kVanishing ? Direction{Eigen::Vector3d{points.x[0], points.y[0], points.z[0]}}
                               : Direction{sum / length};
  }
  const AxisPoints points{values_, dimension_};
  Direction sum = weighted_sum(points, weights);
  const double length = sum.norm();
  if (length >= kVanishing) return sum / length;
  for (std::size_t k = 0; k < dimension_; ++k) sum[static_cast<Eigen::Index>(k)] = points.axis(k)[0];
  return sum;
}

double SpherePoints::square_angles(std::span<const double> weights, const Direction& centre) const {
  if (dimension_ == kThree) return weighted_square_angles(in_three(values_), weights, Eigen::Vector3d{centre});
  return weighted_square_angles(AxisPoints{values_, dimension_}, weights, centre);
}

double SpherePoints::rough_square_angles(std::span<const double> weights, const Direction& centre) const {
  if (dimension_ == kThree) return detail::rough_square_angles(in_three(values_), weights, Eigen::Vector3d{centre});
  return square_angles(weights, centre);
}

void move_points(std::vector<double>& values, std::size_t dimension, double angle,
                 const std::vector<Direction>& normals, RandomStream& random) {
  if (dimension == kThree) {
    const std::span<double> all{values};
    move_points(in_three(std::span<const double>{values}), angle, Normals{normals}.list(), random, in_three(all));
  } else {
    move_points(std::span<double>{values}, dimension, angle, std::span{normals}, random);
  }
}

void draw_points(std::vector<double>& values, std::size_t dimension, std::span<const std::uint32_t> index, double angle,
                 const std::vector<Direction>& normals, RandomStream& random) {
  if (dimension != kThree) {
    std::vector<double> drawn(values.size());
    gather(AxisPoints{values, dimension}, index, drawn);
    values = std::move(drawn);
    if (angle > 0.0) move_points(values, dimension, angle, normals, random);
    return;
  }
  // Drawn into scratch memory and moved back from there: moving costs no copy.
  const std::size_t n = values.size() / kThree;
  ParticleScratch<double> x{n};
  ParticleScratch<double> y{n};
  ParticleScratch<double> z{n};
  const MutablePoints drawn{x.values(), y.values(), z.values()};
  gather(in_three(std::span<const double>{values}), index, drawn);

  const MutablePoints to = in_three(std::span<double>{values});
  if (angle > 0.0) {
    move_points({drawn.x, drawn.y, drawn.z}, angle, Normals{normals}.list(), random, to);
  } else {
    std::copy(drawn.x.begin(), drawn.x.end(), to.x.begin());
    std::copy(drawn.y.begin(), drawn.y.end(), to.y.begin());
    std::copy(drawn.z.begin(), drawn.z.end(), to.z.begin());
  }
}

}  // namespace kith::detail
