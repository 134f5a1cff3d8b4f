#include "kith/stats/multivariate_t.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "kith/stats/distributions.hpp"
#include "tail_integral.hpp"

// With Z_i = l_i Y + sqrt(1 - l_i^2) E_i, all independent, given Y the statistics are independent:
//
//   P(max |Z_i| > r) = Int phi(y) [1 - Prod_i (1 - q_i(y))] dy,   q_i(y) = P(|Z_i| > r given Y = y)
//   P(max |T_i| > t) = Int density(s) P(max |Z_i| > t s) ds
//
// In general Z_i = a_i . X with X of `rank` independent normals. X / S is a direction u, uniform on the sphere, times a
// length whose square over the rank is F(rank, df); the largest |a_i . u| times the length exceeds t in
//
//   P(max |T_i| > t) = E_u P(F > t^2 / (rank max_i (a_i . u)^2)).

namespace kith {
namespace {

using Correlations = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Eigen::Index;

constexpr double kSymmetric = 1e-9;  // Also what eigenvalues may be below 0.
constexpr double kProduct = 1e-9;    // How far correlations may be from products.

Correlations checked_correlations(std::span<const double> values) {
  const auto size = static_cast<Index>(std::llround(std::sqrt(static_cast<double>(values.size()))));
  if (size < 1 || static_cast<std::size_t>(size * size) != values.size())
    throw std::invalid_argument{"LargestT: correlations must be a square matrix"};
  const Correlations matrix = Eigen::Map<const Correlations>{values.data(), size, size};
  if (!matrix.allFinite() || !matrix.isApprox(matrix.transpose(), kSymmetric) ||
      (matrix.diagonal().array() - 1.0).abs().maxCoeff() > kSymmetric)
    throw std::invalid_argument{"LargestT: correlations must be symmetric with diagonal 1"};
  return matrix;
}

// Sizes, ascending, of l with r_ij = l_i l_j for all i != j and |l_i| < 1, if there is one.
std::optional<std::vector<double>> product_loadings(const Correlations& r) {
  const auto k = r.rows();
  Eigen::VectorXd loadings = Eigen::VectorXd::Zero(k);
  if (k == 2) loadings << std::sqrt(std::abs(r(0, 1))), std::copysign(std::sqrt(std::abs(r(0, 1))), r(0, 1));
  for (Index i = 0; i < k && k > 2; ++i) {
    double largest = 0.0;  // The pair with the largest correlation says most about the size.
    for (Index j = 0; j < k; ++j) {
      for (Index m = j + 1; m < k; ++m) {
        if (j == i || m == i || std::abs(r(j, m)) <= largest) continue;
        largest = std::abs(r(j, m));
        loadings(i) = std::sqrt(std::max(0.0, r(i, j) * r(i, m) / r(j, m)));
      }
    }
  }
  // Signs are relative to that of the largest.
  Index reference = 0;
  loadings.maxCoeff(&reference);
  for (Index i = 0; i < k && k > 2; ++i) {
    if (i != reference && r(reference, i) < 0.0) loadings(i) = -loadings(i);
  }
  for (Index i = 0; i < k; ++i) {
    if (!(std::abs(loadings(i)) < 1.0 - 1e-6)) return std::nullopt;
    for (Index j = 0; j < i; ++j) {
      if (std::abs(r(i, j) - loadings(i) * loadings(j)) > kProduct) return std::nullopt;
    }
  }
  std::vector<double> sizes{loadings.data(), loadings.data() + k};
  for (auto& size : sizes) size = std::abs(size);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

// P(max |Z_i| > r). `loadings` ascend in size; their signs do not matter.
double largest_normal_upper(double r, const std::vector<double>& loadings) {
  const double steepest = loadings.back();
  constexpr double kReach = 9.0;
  const double step = 0.25 * std::sqrt(1.0 - steepest * steepest);
  const auto last = static_cast<int>((kReach + r * steepest) / step);
  double sum = 0.0;
  for (int i = 0; i <= last; ++i) {  // The integrand is even.
    const double y = i * step;
    double log_inside = 0.0;
    double of_one = 0.0;
    double previous = -1.0;
    for (const double l : loadings) {
      if (l != previous) {
        const double spread = std::sqrt(1.0 - l * l);
        const double outside = normal_upper((r - l * y) / spread) + normal_upper((r + l * y) / spread);
        of_one = std::log1p(-std::min(outside, 1.0));
        previous = l;
      }
      log_inside += of_one;
    }
    sum += (i == 0 ? 0.5 : 1.0) * std::exp(-0.5 * y * y) * -std::expm1(log_inside);
  }
  return std::min(1.0, sum * step * std::sqrt(2.0 / std::numbers::pi));
}

double product_upper(double t, double df, const std::vector<double>& loadings) {
  if (std::isinf(df)) return largest_normal_upper(t, loadings);
  const double step = std::min(0.1, 0.7 / std::sqrt(2.0 * df));
  // Both factors are log-concave in u = log s; the tail fades as exp(-r^2 / 2).
  const double mode = -0.5 * std::log1p(t * (t / df));
  if (std::isinf(mode)) return 0.0;
  const double tail = detail::sum_outwards(mode, step, [&](double u) {
    const double weight = detail::log_scale_density(u, df);
    return weight > 0.0 ? weight * largest_normal_upper(t * std::exp(u), loadings) : 0.0;
  });
  return std::min(1.0,
                  tail / detail::sum_outwards(0.0, step, [df](double u) { return detail::log_scale_density(u, df); }));
}

// Values of max_i (a_i . u)^-2 over directions u that cover the sphere evenly: normals from the additive recurrence
// whose steps are the powers of 1 / g, g^(d + 1) = g + 1, which generalises the golden ratio.
std::vector<double> squared_reaches(const Eigen::MatrixXd& a) {
  constexpr std::size_t kPoints = std::size_t{1} << 17U;
  const auto dimension = a.cols();
  double g = 1.5;
  for (int i = 0; i < 60; ++i) g = std::pow(1.0 + g, 1.0 / (static_cast<double>(dimension) + 1.0));
  std::vector<double> steps(static_cast<std::size_t>(dimension));
  double power = 1.0;
  for (auto& step : steps) step = power /= g;
  std::vector<double> reaches;
  reaches.reserve(kPoints);
  Eigen::VectorXd x(dimension);
  for (std::size_t n = 0; n < kPoints; ++n) {
    for (Index d = 0; d < dimension; ++d) {
      const double at = (static_cast<double>(n) + 0.5) * steps[static_cast<std::size_t>(d)];
      x(d) = normal_quantile(std::clamp(at - std::floor(at), 1e-12, 1.0 - 1e-12));
    }
    reaches.push_back(x.squaredNorm() / (a * x).cwiseAbs2().maxCoeff());
  }
  std::sort(reaches.begin(), reaches.end());
  return reaches;
}

}  // namespace

LargestT::LargestT(std::span<const double> correlations) {
  const auto matrix = checked_correlations(correlations);
  size_ = static_cast<std::size_t>(matrix.rows());
  if (auto loadings = product_loadings(matrix)) {
    loadings_ = std::move(*loadings);
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{matrix};
  const auto& values = solver.eigenvalues();
  if (values.minCoeff() < -kSymmetric * static_cast<double>(size_))
    throw std::invalid_argument{"LargestT: correlations must be positive semidefinite"};
  const auto rank = (values.array() > kSymmetric * static_cast<double>(size_)).count();
  rank_ = static_cast<std::size_t>(rank);
  const Eigen::MatrixXd a =
      solver.eigenvectors().rightCols(rank) * values.tail(rank).cwiseSqrt().asDiagonal();  // [k, rank]
  // The tail as a function of the squared reach is smooth, so few values with their shares say as much as all.
  const auto reaches = squared_reaches(a);
  constexpr std::size_t kTogether = 64;
  for (std::size_t begin = 0; begin < reaches.size(); begin += kTogether) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + kTogether; ++i) sum += reaches[i];
    directions_.push_back(
        {sum / static_cast<double>(kTogether), static_cast<double>(kTogether) / static_cast<double>(reaches.size())});
  }
}

double LargestT::upper(double t, double df) const {
  if (!(t >= 0.0) || !(df > 0.0)) throw std::invalid_argument{"LargestT: t must be >= 0 and df > 0"};
  if (t == 0.0) return 1.0;
  if (std::isinf(t)) return 0.0;
  if (size_ == 1) return student_t_two_sided(t, df);
  if (!loadings_.empty()) return product_upper(t, df, loadings_);
  const auto rank = static_cast<double>(rank_);
  double sum = 0.0;
  for (const auto& direction : directions_)
    sum += direction.share * f_upper(t * t * direction.squared_reach / rank, rank, df);
  return std::min(1.0, sum);
}

double LargestT::quantile(double p, double df) const {
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument{"LargestT: p must be in (0, 1)"};
  if (!(df > 0.0)) throw std::invalid_argument{"LargestT: df must be > 0"};
  return detail::upper_quantile(p, [&](double t) { return upper(t, df); });
}

}  // namespace kith
