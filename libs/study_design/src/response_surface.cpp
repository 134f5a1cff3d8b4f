#include "kith/study_design/response_surface.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kith {
namespace {

const double kRoot3 = std::sqrt(3.0);
const double kHalfRoot5 = std::sqrt(5.0) / 2.0;

std::size_t num_terms(std::size_t d) { return 1 + 2 * d + d * (d - 1) / 2; }

// Order: constant, linear, squares, products (i < j).
std::vector<double> terms_at(std::span<const double> u) {
  const auto d = u.size();
  std::vector<double> terms;
  terms.reserve(num_terms(d));
  terms.push_back(1.0);
  for (const double x : u) terms.push_back(kRoot3 * x);
  for (const double x : u) terms.push_back(kHalfRoot5 * (3.0 * x * x - 1.0));
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t j = i + 1; j < d; ++j) terms.push_back(3.0 * u[i] * u[j]);
  }
  return terms;
}

struct Fit {
  Eigen::VectorXd coefficients;
  double press = std::numeric_limits<double>::infinity();  // sum of squared leave-one-out errors
};

Fit fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, double ridge) {
  Eigen::MatrixXd normal = x.transpose() * x;
  normal.diagonal().tail(normal.rows() - 1).array() += ridge;
  const Eigen::LDLT<Eigen::MatrixXd> solver{normal};
  Fit result;
  const Eigen::VectorXd projected = x.transpose() * y;
  result.coefficients = solver.solve(projected);
  const Eigen::MatrixXd solved = solver.solve(x.transpose());
  const Eigen::VectorXd predicted = x * result.coefficients;
  result.press = 0.0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double left = 1.0 - x.row(i).dot(solved.col(i));  // 1 - leverage
    if (left < 1e-9) {
      result.press = std::numeric_limits<double>::infinity();
      return result;
    }
    const double error = (y[i] - predicted[i]) / left;
    result.press += error * error;
  }
  return result;
}

}  // namespace

ResponseSurface::ResponseSurface(std::span<const std::vector<double>> points, std::span<const double> values)
    : dimension_{points.empty() ? 0 : points.front().size()} {
  if (points.size() < 3) throw std::invalid_argument{"ResponseSurface: fewer than three points"};
  if (points.size() != values.size()) throw std::invalid_argument{"ResponseSurface: one value per point"};
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd x(n, static_cast<Eigen::Index>(num_terms(dimension_)));
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& point = points[static_cast<std::size_t>(i)];
    if (point.size() != dimension_) throw std::invalid_argument{"ResponseSurface: points of different dimensions"};
    const auto terms = terms_at(point);
    for (Eigen::Index j = 0; j < x.cols(); ++j) x(i, j) = terms[static_cast<std::size_t>(j)];
    y[i] = values[static_cast<std::size_t>(i)];
  }
  Fit best;
  for (const double relative : {1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0}) {
    auto one = fit(x, y, relative * static_cast<double>(n));
    if (one.press < best.press || best.coefficients.size() == 0) best = std::move(one);
  }
  coefficients_.assign(best.coefficients.begin(), best.coefficients.end());
  error_ = std::sqrt(best.press / static_cast<double>(n));
  const double centred = (y.array() - y.mean()).square().sum();
  explained_ = centred > 0.0 ? 1.0 - best.press / centred : 0.0;
}

double ResponseSurface::at(std::span<const double> point) const {
  const auto terms = terms_at(point);
  double sum = 0.0;
  for (std::size_t j = 0; j < coefficients_.size(); ++j) sum += coefficients_[j] * terms[j];
  return sum;
}

double ResponseSurface::main_share(std::size_t k) const {
  double all = 0.0;
  for (std::size_t j = 1; j < coefficients_.size(); ++j) all += coefficients_[j] * coefficients_[j];
  const double linear = coefficients_[1 + k];
  const double square = coefficients_[1 + dimension_ + k];
  return all > 0.0 ? (linear * linear + square * square) / all : 0.0;
}

double ResponseSurface::total_share(std::size_t k) const {
  double all = 0.0;
  for (std::size_t j = 1; j < coefficients_.size(); ++j) all += coefficients_[j] * coefficients_[j];
  if (all <= 0.0) return 0.0;
  double share = main_share(k);
  std::size_t next = 1 + 2 * dimension_;
  for (std::size_t i = 0; i < dimension_; ++i) {
    for (std::size_t j = i + 1; j < dimension_; ++j, ++next) {
      if (i == k || j == k) share += coefficients_[next] * coefficients_[next] / all;
    }
  }
  return share;
}

double ResponseSurface::slope(std::size_t k) const { return 2.0 * kRoot3 * coefficients_[1 + k]; }

}  // namespace kith
