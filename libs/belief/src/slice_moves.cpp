#include "slice_moves.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kith/core/integer_vector.hpp"
#include "kith/random/distributions.hpp"

namespace kith::detail {
namespace {

constexpr int kMostShrinkages = 100;
constexpr double kOutside = -std::numeric_limits<double>::infinity();

using Vector = std::array<double, IntegerVector::kMaxDimension>;

// One great circle: x(angle) = point cos(angle) + side sin(angle).
class Circle {
 public:
  explicit Circle(const FallingDensity& density)
      : density_{density}, prior_(density.prior.size() / density.dimension), falls_(density.far.size()) {}

  void lay(const Vector& point, const Vector& side) {
    const std::size_t d = density_.dimension;
    const auto project = [&](const std::vector<double>& normals, std::vector<Along>& along) {
      for (std::size_t j = 0; j < along.size(); ++j) {
        along[j] = {};
        for (std::size_t k = 0; k < d; ++k) {
          along[j].point += normals[j * d + k] * point[k];
          along[j].side += normals[j * d + k] * side[k];
        }
      }
    };
    project(density_.prior, prior_);
    project(density_.normals, falls_);
  }

  [[nodiscard]] double log_density(double cosine, double sine) const {
    for (const Along& u : prior_) {
      if (u.point * cosine + u.side * sine < 0.0) return kOutside;
    }
    double sum = 0.0;
    for (std::size_t j = 0; j < falls_.size(); ++j) {
      const double t = falls_[j].point * cosine + falls_[j].side * sine;
      if (t < 0.0) sum += density_.far[j] + density_.slope[j] * t;
    }
    return sum;
  }

 private:
  struct Along {
    double point = 0.0, side = 0.0;  // u . point, u . side
  };
  const FallingDensity& density_;
  std::vector<Along> prior_;
  std::vector<Along> falls_;
};

// A uniform unit vector at right angles to the point.
Vector tangent_at(const Vector& point, std::size_t d, RandomStream& random) {
  Vector side{};
  double length = 0.0;
  while (!(length > 1e-9)) {
    fill_standard_normal(std::span{side}.first(d), random);
    double along = 0.0;
    for (std::size_t k = 0; k < d; ++k) along += side[k] * point[k];
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

}  // namespace

void move_in_density(const FallingDensity& density, std::size_t sweeps, std::span<double> values,
                     RandomStream& random) {
  const std::size_t d = density.dimension;
  const std::size_t n = values.size() / d;
  Circle circle{density};
  for (std::size_t i = 0; i < n; ++i) {
    Vector point{};
    for (std::size_t k = 0; k < d; ++k) point[k] = values[k * n + i];
    for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
      const Vector side = tangent_at(point, d, random);
      circle.lay(point, side);
      const double level = circle.log_density(1.0, 0.0) + std::log(uniform01(random));
      if (!(level > kOutside)) continue;
      double high = 2.0 * std::numbers::pi * uniform01(random);
      double low = high - 2.0 * std::numbers::pi;
      double angle = high;
      for (int attempt = 0; attempt < kMostShrinkages; ++attempt) {
        const double cosine = std::cos(angle);
        const double sine = std::sin(angle);
        if (circle.log_density(cosine, sine) > level) {
          double length = 0.0;
          for (std::size_t k = 0; k < d; ++k) {
            point[k] = point[k] * cosine + side[k] * sine;
            length += point[k] * point[k];
          }
          for (std::size_t k = 0; k < d; ++k) point[k] /= std::sqrt(length);
          break;
        }
        (angle < 0.0 ? low : high) = angle;
        angle = low + (high - low) * uniform01(random);
      }
    }
    for (std::size_t k = 0; k < d; ++k) values[k * n + i] = point[k];
  }
}

}  // namespace kith::detail
