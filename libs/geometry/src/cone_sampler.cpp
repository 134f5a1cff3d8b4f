// Cones above three dimensions as unions of simplicial cones: how they are made,
// and the rejection that draws from them. Areas: cone_area.cpp.

#include "kith/geometry/cone_sampler.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <queue>
#include <stdexcept>
#include <utility>

#include "guide_table.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/math.hpp"
#include "kith/geometry/cover.hpp"
#include "nearest_point.hpp"
#include "simplex_points.hpp"
#include "simplicial_fan.hpp"
#include "sobol.hpp"

namespace kith {
namespace {

// Halving stops when the envelope of the densities is this many times their rough integral: that of eight
// perpendicular rays is ten times it. Or when there are this many more parts.
constexpr double kEnoughEnvelope = 12.0;
constexpr std::size_t kMostHalvings = 2000;

Direction real(const IntegerVector& v) {
  Direction result(static_cast<Eigen::Index>(v.size()));
  for (std::size_t k = 0; k < v.size(); ++k) result[static_cast<Eigen::Index>(k)] = static_cast<double>(v[k]);
  return result;
}

Eigen::MatrixXd columns(std::span<const IntegerVector> vectors, std::size_t dimension) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = real(vectors[i]);
  return result;
}

// How far two chances of acceptance may be from one another, relative to them, because of rounding, and much more.
constexpr double kRoughly = 1e-12;

// The sum of n rays, columns of a matrix of n rows, each times its lambda; n = lambda.size() is 1 to 8.
template <std::size_t n>
void combine_in(const double* rays, const std::array<std::uint32_t, 8>& which, std::span<const double> lambda,
                double* out) {
  std::array<double, n> sum{};
  for (std::size_t k = 0; k < n; ++k) {
    const double* const ray = rays + which[k] * n;
    const double factor = lambda[k];
    for (std::size_t i = 0; i < n; ++i) sum[i] += factor * ray[i];
  }
  std::copy(sum.begin(), sum.end(), out);
}

void combine(const double* rays, const std::array<std::uint32_t, 8>& which, std::span<const double> lambda,
             double* out) {
  switch (lambda.size()) {
    case 1:
      return combine_in<1>(rays, which, lambda, out);
    case 2:
      return combine_in<2>(rays, which, lambda, out);
    case 3:
      return combine_in<3>(rays, which, lambda, out);
    case 4:
      return combine_in<4>(rays, which, lambda, out);
    case 5:
      return combine_in<5>(rays, which, lambda, out);
    case 6:
      return combine_in<6>(rays, which, lambda, out);
    case 7:
      return combine_in<7>(rays, which, lambda, out);
    case 8:
      return combine_in<8>(rays, which, lambda, out);
    default:
      KITH_ASSERT(false);
  }
}

}  // namespace

ConeSampler::ConeSampler(const Cone& cone) : cone_{cone} {
  if (dimension() == 2) make_arc();
  if (dimension() > 3) make_parts();
}

void ConeSampler::make_arc() {
  Eigen::Vector2d start = Eigen::Vector2d::UnitX();
  Eigen::Vector2d towards = Eigen::Vector2d::UnitY();
  arc_ = cone_.solid_angle();
  if (!cone_.facets().empty()) {
    // From the boundary of one facet, turning to its inner side.
    towards = cone_.minimal_set().front().unit();
    start = Eigen::Vector2d{towards.y(), -towards.x()};
    // Where it is not the start, the other side of it: the arc then ends there.
    if (cone_.facets().size() == 2 && cone_.minimal_set().back().margin(start) < 0.0) start = -start;
  }
  axes_ = Eigen::MatrixXd(2, 2);
  axes_.col(0) = start;
  axes_.col(1) = towards;
}

Direction ConeSampler::arc_point(double t) const {
  return math::cos(t * arc_) * axes_.col(0) + math::sin(t * arc_) * axes_.col(1);
}

void ConeSampler::make_parts() {
  const auto d = static_cast<Eigen::Index>(dimension());
  const auto num_lines = static_cast<Eigen::Index>(cone_.lines_.size());
  rank_ = dimension() - cone_.lines_.size();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(d, d);
  if (num_lines > 0) basis = Eigen::HouseholderQR<Eigen::MatrixXd>{columns(cone_.lines_, dimension())}.householderQ();
  axes_ = basis.leftCols(num_lines);
  frame_ = basis.rightCols(d - num_lines);

  std::vector<IntegerVector> rays = cone_.rays_;
  std::sort(rays.begin(), rays.end());
  rays_ = frame_.transpose() * columns(rays, dimension());
  rays_.colwise().normalize();
  const auto members = detail::triangulate(cone_.minimal_set(), rays, rank_);
  const std::size_t num_parts = rank_ == 0 ? 1 : members.size() / rank_;
  for (std::size_t i = 0; i < num_parts; ++i) {
    Part part{};
    std::copy_n(members.begin() + static_cast<std::ptrdiff_t>(i * rank_), rank_, part.rays.begin());
    part.content = 1.0;
    if (rank_ > 1) part.content = std::abs(detail::chosen_columns(rays_, part.rays, rank_).determinant());
    measure(part);
    parts_.push_back(part);
  }
  halve_wide_parts();
  double sum = 0.0;
  for (const Part& part : parts_) {
    // Coordinates along the lines add to the square of the smallest length as perpendicular rays do.
    sum += part.content * detail::half_power(part.peak + static_cast<double>(num_lines), dimension());
    envelope_.push_back(sum);
  }
  KITH_ASSERT(std::isfinite(sum));
}

// The mean of lambda_i lambda_j is (1 + [i = j]) / (n (n + 1)).
void ConeSampler::measure(Part& part) const {
  if (rank_ == 0) return;
  const auto chosen = detail::chosen_columns(rays_, part.rays, rank_);
  const auto n = static_cast<double>(rank_);
  part.peak = detail::inverse_square_distance(chosen.transpose() * chosen);
  part.typical = n * (n + 1.0) / (chosen.rowwise().sum().squaredNorm() + n);
}

void ConeSampler::halve_wide_parts() {
  const auto most = [&](const Part& part) { return part.content * detail::half_power(part.peak, rank_); };
  const auto likely = [&](const Part& part) { return part.content * detail::half_power(part.typical, rank_); };
  std::priority_queue<std::pair<double, std::size_t>> widest;
  double sum_most = 0.0;
  double sum_likely = 0.0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    widest.emplace(most(parts_[i]), i);
    sum_most += most(parts_[i]);
    sum_likely += likely(parts_[i]);
  }

  for (std::size_t n = 0; rank_ > 1 && n < kMostHalvings && !(sum_most <= kEnoughEnvelope * sum_likely); ++n) {
    const auto [bound, i] = widest.top();
    widest.pop();
    const bool loses_digits = bound > 0.5 * sum_most;  // also if infinite
    sum_most -= bound;
    sum_likely -= likely(parts_[i]);
    halve(i);
    for (const std::size_t half : {i, parts_.size() - 1}) {
      widest.emplace(most(parts_[half]), half);
      sum_most += most(parts_[half]);
      sum_likely += likely(parts_[half]);
    }
    if (!loses_digits) continue;
    sum_most = 0.0;
    for (const Part& part : parts_) sum_most += most(part);
  }
}

// Through the middle of the widest pair of rays. Each half has the content over the length of the sum of the two.
void ConeSampler::halve(std::size_t part) {
  const auto column = [&](std::size_t k) { return rays_.col(static_cast<Eigen::Index>(parts_[part].rays[k])); };
  std::size_t first = 0;
  std::size_t second = 1;
  for (std::size_t i = 0; i < rank_; ++i) {
    for (std::size_t j = i + 1; j < rank_; ++j) {
      if (column(i).dot(column(j)) < column(first).dot(column(second))) {
        first = i;
        second = j;
      }
    }
  }
  const Eigen::VectorXd sum = column(first) + column(second);
  const double length = sum.norm();
  const auto middle = static_cast<std::uint32_t>(rays_.cols());
  rays_.conservativeResize(Eigen::NoChange, rays_.cols() + 1);
  rays_.rightCols(1) = sum / length;
  parts_[part].content /= length;
  Part other = parts_[part];
  parts_[part].rays[first] = middle;
  other.rays[second] = middle;
  measure(parts_[part]);
  measure(other);
  parts_.push_back(other);
}

// `which` part and which side of each line, in [0, 1); `lambda`, shape [d].
ConeSampler::Proposal ConeSampler::propose(double which, std::span<const double> lambda) const {
  const double target = which * envelope_.back();
  const auto found = std::upper_bound(envelope_.begin(), envelope_.end() - 1, target);
  const auto i = static_cast<std::size_t>(found - envelope_.begin());
  const Part& part = parts_[i];
  const double before = i == 0 ? 0.0 : envelope_[i - 1];
  const auto num_lines = dimension() - rank_;
  const double place = std::clamp((target - before) / (envelope_[i] - before), 0.0, 1.0);
  const double num_sides = static_cast<double>(std::size_t{1} << num_lines);
  const auto sides = static_cast<std::size_t>(std::min(place * num_sides, num_sides - 1.0));

  Direction point = Direction::Zero(static_cast<Eigen::Index>(dimension()));
  Direction beside = Direction::Zero(static_cast<Eigen::Index>(rank_));
  for (std::size_t k = 0; k < rank_; ++k) beside += lambda[k] * rays_.col(static_cast<Eigen::Index>(part.rays[k]));
  if (rank_ > 0) point = frame_ * beside;
  for (std::size_t k = 0; k < num_lines; ++k) {
    const double side = ((sides >> k) & 1) != 0 ? -1.0 : 1.0;
    point += side * lambda[rank_ + k] * axes_.col(static_cast<Eigen::Index>(k));
  }
  const double square = point.squaredNorm();
  const double peak = part.peak + static_cast<double>(num_lines);
  const double acceptance = detail::half_power(1.0 / (peak * square), dimension());
  return {point / std::sqrt(square), acceptance};
}

Direction ConeSampler::sample(RandomStream& random) const {
  if (dimension() == 2) return arc_point(uniform01(random));
  if (dimension() == 3) return cone_.sample(random);
  for (;;) {
    std::array<double, IntegerVector::kMaxDimension> cube{};
    for (std::size_t k = 0; k < dimension(); ++k) cube[k] = uniform01(random);
    detail::SimplexMap map{std::span{cube}.subspan(1, dimension() - 1)};
    std::array<double, IntegerVector::kMaxDimension> lambda{};
    for (std::size_t k = 0; k < dimension(); ++k) lambda[k] = map.next();
    const Proposal proposal = propose(cube[0], std::span{lambda}.first(dimension()));
    if (uniform01(random) < proposal.acceptance) return proposal.point;
  }
}

Eigen::MatrixXd ConeSampler::cover(std::size_t n) const {
  if (n == 0) throw std::invalid_argument{"ConeSampler: a cover needs at least one point"};
  if (dimension() == 3) return fibonacci_cover(cone_, n);
  Eigen::MatrixXd points(static_cast<Eigen::Index>(dimension()), static_cast<Eigen::Index>(n));
  if (dimension() == 2) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      points.col(i) = arc_point((static_cast<double>(i) + 0.5) / static_cast<double>(n));
    }
    return points;
  }

  // Most proposals are rejected, so where there are lines the point is computed only where its squared length, which
  // is rounded otherwise here, leaves a chance.
  const detail::GuideTable guide{envelope_};
  const bool is_pointed = rank_ == dimension();
  Eigen::Index found = 0;
  Direction beside(static_cast<Eigen::Index>(rank_));  // the lines, in the frame
  const auto take = [&](double which, std::span<const double> lambda, double last) {
    const Part& part = parts_[guide.find(which)];
    if (rank_ > 0) combine(rays_.data(), part.rays, lambda.first(rank_), beside.data());
    double square = beside.squaredNorm();
    for (const double along : lambda.subspan(rank_)) square += along * along;
    const double likely = 1.0 / ((part.peak + static_cast<double>(dimension() - rank_)) * square);
    const double acceptance = detail::half_power(likely, dimension());
    if (is_pointed) {
      if (last < acceptance) points.col(found++) = beside / std::sqrt(square);
      return;
    }
    if (last - acceptance > kRoughly * acceptance) return;
    const Proposal proposal = propose(which, lambda);
    if (last < proposal.acceptance) points.col(found++) = proposal.point;
  };

  const auto& first = detail::cover_points(dimension());
  for (std::size_t i = 0; i < first.size() && found < points.cols(); ++i) {
    take(first.which(i), first.lambda(i), first.last(i));
  }
  if (found == points.cols()) return points;
  detail::Sobol sobol{detail::Sobol::Shift{}};
  for (std::size_t i = 0; i < first.size(); ++i) sobol.next();
  for (std::vector<double> numbers; found < points.cols(); numbers.clear()) {
    sobol.next();
    detail::SimplexPoints::append(sobol, dimension(), numbers);
    take(numbers.front(), std::span{numbers}.subspan(1, dimension()), numbers.back());
  }
  return points;
}

}  // namespace kith
