// With alpha = 1 / theta and u = alpha mu, n observed counts of sum S in a cell and N_y of them equal to y in all,
//
//   log L = sum_cells [S log mu - S log(1 + u) - n mu log(1 + u) / u]
//           + sum_y N_y [sum_{j < y} log(1 + alpha j) - log y!],
//
// which holds down to alpha = 0 without the differences of log-gammas at theta that lose all digits there. A count
// that is censored at y adds log S, S = P(Y > y) = I_p(y + 1, theta), the regularised incomplete beta function at
// p = u / (1 + u), whose derivative by log(mu) is p^(y + 1) (1 - p)^theta / B(y + 1, theta). Poisson's is the limit
// of the regularised incomplete gamma function P(y + 1, mu). Both derivatives are log-concave in log(mu), so S is, and
// log L is concave in the coefficients.
#include "count_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "rising_product.hpp"
#include "root.hpp"
#include "term_hypotheses.hpp"

namespace kith::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<RepeatedCount> listed(const std::map<double, double>& times) {
  std::vector<RepeatedCount> list;
  for (const auto& [count, number] : times) list.push_back({count, number});
  return list;
}

// Whether the span of the columns of `rows` has a vector v >= 0 other than 0. Projections by turns onto the span and
// onto the vectors >= 0 never lose any of u'v, which is sum(v) >= |v| at the start u = 1: if |u| falls below 1 there is
// no such v, and if there is none, u tends to 0.
bool span_has_a_non_negative_vector(const MatrixXd& rows) {
  constexpr int kMostTurns = 100'000;
  constexpr double kRounding = 1e-9;
  const Eigen::HouseholderQR<MatrixXd> qr{rows};
  const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(rows.rows(), rows.cols());
  VectorXd u = VectorXd::Ones(rows.rows());
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const VectorXd projected = basis * (basis.transpose() * u);
    u = projected.cwiseMax(0.0);
    if (u.norm() < 1.0 - kRounding) return false;
    if (projected.minCoeff() > -kRounding) return true;
  }
  return true;
}

// log P(Y > y) with its first two derivatives by log(mu).
struct Survival {
  double logarithm = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};

Survival survival_of(double y, double mu, double theta) {
  const double a = y + 1.0;
  double survival = 0.0;
  double slope = 0.0;
  double relative = 0.0;  // derivative of log(slope)
  if (std::isinf(theta)) {
    survival = boost::math::gamma_p(a, mu);
    slope = mu * boost::math::gamma_p_derivative(a, mu);
    relative = a - mu;
  } else {
    const double p = mu / (mu + theta);
    const double q = theta / (mu + theta);
    survival = boost::math::ibeta(a, theta, p);
    slope = p * q * boost::math::ibeta_derivative(a, theta, p);
    relative = a * q - theta * p;
  }
  if (!(survival > 0.0)) return {-kInfinity, 0.0, 0.0};
  const double ratio = slope / survival;
  return {std::log(survival), ratio, ratio * relative - ratio * ratio};
}

struct CountState {
  double log_likelihood = 0.0;  // what of it depends on the coefficients
  VectorXd score;               // by the coefficients
  MatrixXd information;         // observed
};

CountState state_at(const CountData& data, const VectorXd& coefficients, double theta) {
  const double alpha = 1.0 / theta;
  CountState state{0.0, VectorXd::Zero(coefficients.size()), MatrixXd::Zero(coefficients.size(), coefficients.size())};
  const VectorXd eta = data.columns * coefficients;
  for (Index c = 0; c < data.columns.rows(); ++c) {
    const auto& cell = data.cells[static_cast<std::size_t>(c)];
    const double mu = std::exp(eta(c));
    const double u = alpha * mu;
    const double share = 1.0 / (1.0 + u);
    state.log_likelihood += cell.sum * (eta(c) - std::log1p(u)) - cell.observed * mu * log1p_ratio(u);
    double slope = (cell.sum - cell.observed * mu) * share;
    double curvature = -(cell.sum * u + cell.observed * mu) * share * share;
    for (const auto& [bound, times] : cell.censored) {
      const auto survival = survival_of(bound, mu, theta);
      state.log_likelihood += times * survival.logarithm;
      slope += times * survival.slope;
      curvature += times * survival.curvature;
    }
    const VectorXd row = data.columns.row(c).transpose();
    state.score += slope * row;
    state.information -= curvature * row * row.transpose();
  }
  return state;
}

// The derivative of the log-likelihood by log(theta), the coefficients given.
double theta_score(const CountData& data, const VectorXd& coefficients, double theta) {
  constexpr double kStep = 1e-3;
  const double alpha = 1.0 / theta;
  const RisingProduct rising{alpha};
  double by_alpha = 0.0;
  for (const auto& [count, times] : data.counts) by_alpha += times * rising.slope(count);
  double by_log_theta = 0.0;
  const VectorXd eta = data.columns * coefficients;
  for (Index c = 0; c < data.columns.rows(); ++c) {
    const auto& cell = data.cells[static_cast<std::size_t>(c)];
    const double mu = std::exp(eta(c));
    const double u = alpha * mu;
    by_alpha += cell.observed * mu * mu * (log1p_rest(u) + 1.0 / (1.0 + u)) - cell.sum * mu / (1.0 + u);
    for (const auto& [bound, times] : cell.censored) {
      const auto log_survival = [&, y = bound](double step) {
        return survival_of(y, mu, theta * std::exp(step)).logarithm;
      };
      by_log_theta += times *
                      (8.0 * (log_survival(kStep) - log_survival(-kStep)) -
                       (log_survival(2.0 * kStep) - log_survival(-2.0 * kStep))) /
                      (12.0 * kStep);
    }
  }
  return by_log_theta - alpha * by_alpha;
}

// The coefficients of largest likelihood at this theta: Newton's steps, halved until they lose nothing but rounding.
std::optional<VectorXd> fit_coefficients(const CountData& data, double theta, VectorXd coefficients) {
  constexpr int kMostSteps = 200;
  constexpr double kLongestStep = 5.0;
  // A step that promises less of log-likelihood is the last: coefficients are then off by 1e-7 of their standard
  // errors.
  constexpr double kSmallestGain = 1e-14;
  constexpr double kRounding = 1e-13;  // of the log-likelihood
  auto at = state_at(data, coefficients, theta);
  for (int step = 0; step < kMostSteps; ++step) {
    VectorXd change = at.information.ldlt().solve(at.score);
    if (!change.allFinite()) return std::nullopt;
    double gain = change.dot(at.score);
    if (gain <= kSmallestGain) return coefficients + change;
    change *= std::min(1.0, kLongestStep / change.cwiseAbs().maxCoeff());
    const double least = at.log_likelihood - kRounding * (1.0 + std::abs(at.log_likelihood));
    auto next = state_at(data, coefficients + change, theta);
    while (!(next.log_likelihood >= least)) {
      change /= 2.0;
      gain /= 2.0;
      if (gain <= kSmallestGain) return coefficients;
      next = state_at(data, coefficients + change, theta);
    }
    coefficients += change;
    at = std::move(next);
  }
  return std::nullopt;
}

CountFit fit_at(const CountData& data, double theta, VectorXd coefficients) {
  const RisingProduct rising{1.0 / theta};
  double log_likelihood = state_at(data, coefficients, theta).log_likelihood - data.log_factorials;
  for (const auto& [count, times] : data.counts) log_likelihood += times * rising.log(count);
  return {theta, std::move(coefficients), log_likelihood};
}

MatrixXd inverse(const MatrixXd& information) {
  return information.ldlt().solve(MatrixXd::Identity(information.rows(), information.cols()));
}

}  // namespace

CountData count_data(std::span<const double> counts, const std::vector<bool>& observed, const FactorDesign& design) {
  CountData data;
  data.columns = observed_columns(design);
  data.cells.resize(static_cast<std::size_t>(data.columns.rows()));

  std::vector<std::size_t> row_of(design.counts.size(), 0);
  std::size_t rows = 0;
  for (std::size_t c = 0; c < design.counts.size(); ++c) row_of[c] = design.counts[c] > 0 ? rows++ : 0;

  std::vector<std::map<double, double>> bounds(rows);
  std::map<double, double> times;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto row = row_of[design.cell_of[i]];
    data.mean += counts[i] / static_cast<double>(counts.size());
    if (observed.empty() || observed[i]) {
      data.cells[row].observed += 1.0;
      data.cells[row].sum += counts[i];
      times[counts[i]] += 1.0;
    } else {
      bounds[row][counts[i]] += 1.0;
    }
  }

  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!observed.empty() && !observed[i]) continue;
    auto& cell = data.cells[row_of[design.cell_of[i]]];
    const double deviation = counts[i] - cell.sum / cell.observed;
    cell.squares += deviation * deviation;
  }

  for (std::size_t row = 0; row < rows; ++row) data.cells[row].censored = listed(bounds[row]);
  data.counts = listed(times);
  for (const auto& [count, number] : data.counts) data.log_factorials += number * boost::math::lgamma(count + 1.0);
  return data;
}

bool is_separated(const CountData& data) {
  std::vector<Index> bounded, free;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const bool is_bounded = cell.sum > 0.0 || (cell.observed > 0.0 && !cell.censored.empty());
    (is_bounded ? bounded : free).push_back(static_cast<Index>(c));
  }
  const MatrixXd columns = data.columns(bounded, Eigen::all);
  const Eigen::FullPivLU<MatrixXd> products{columns.transpose() * columns};
  if (products.dimensionOfKernel() == 0) return false;
  const MatrixXd directions = products.kernel();
  MatrixXd rows = data.columns(free, Eigen::all) * directions;
  for (Index row = 0; row < rows.rows(); ++row) {
    const auto& cell = data.cells[static_cast<std::size_t>(free[static_cast<std::size_t>(row)])];
    if (cell.observed > 0.0) rows.row(row) *= -1.0;
  }
  return span_has_a_non_negative_vector(rows);
}

std::optional<CountFit> fit_poisson(const CountData& data) {
  VectorXd start = VectorXd::Zero(data.columns.cols());
  start(0) = std::log(data.mean + 0.1);
  auto coefficients = fit_coefficients(data, kInfinity, std::move(start));
  if (!coefficients) return std::nullopt;
  return fit_at(data, kInfinity, std::move(*coefficients));
}

// Follows the profile likelihood from Poisson's side to the first theta at which it falls towards infinity.
std::optional<CountFit> fit_negative_binomial(const CountData& data) {
  // Beyond it the variance exceeds the mean by less than 1e-5 of it: the model is Poisson's.
  const double highest = std::log(1e5 * std::max(1.0, data.mean));
  constexpr double kLowest = -9.2;  // theta = 1e-4
  auto poisson = fit_poisson(data);
  if (!poisson) return std::nullopt;
  VectorXd coefficients = poisson->coefficients;
  bool failed = false;
  const auto score = [&](double log_theta) {
    auto fitted = fit_coefficients(data, std::exp(log_theta), coefficients);
    failed = failed || !fitted;
    if (!fitted) return 0.0;  // ends the search
    coefficients = std::move(*fitted);
    return theta_score(data, coefficients, std::exp(log_theta));
  };
  double low = highest, high = highest;
  double low_score = score(low), high_score = 0.0;
  if (low_score >= 0.0) return failed ? std::nullopt : std::move(poisson);
  while (low_score < 0.0 && low > kLowest) {
    high = std::exchange(low, low - 1.5);
    high_score = std::exchange(low_score, score(low));
  }
  if (low_score < 0.0) return std::nullopt;
  const double theta = std::exp(low_score > 0.0 ? root_between(low, high, low_score, high_score, 40, score) : low);
  const auto fitted = fit_coefficients(data, theta, coefficients);
  if (failed || !fitted) return std::nullopt;
  auto fit = fit_at(data, theta, *fitted);
  return fit.log_likelihood > poisson->log_likelihood ? std::move(fit) : std::move(*poisson);
}

MatrixXd covariance_of(const CountData& data, const CountFit& fit) {
  const bool is_censored =
      std::ranges::any_of(data.cells, [](const CountCell& cell) { return !cell.censored.empty(); });
  if (!is_censored) {
    VectorXd weights = (data.columns * fit.coefficients).array().exp();
    for (Index c = 0; c < weights.size(); ++c)
      weights(c) *= data.cells[static_cast<std::size_t>(c)].observed / (1.0 + weights(c) / fit.theta);
    return inverse(data.columns.transpose() * weights.asDiagonal() * data.columns);
  }

  const auto p = fit.coefficients.size();
  const auto state = state_at(data, fit.coefficients, fit.theta);
  if (std::isinf(fit.theta)) return inverse(state.information);

  // By differences, in the logarithm of theta.
  constexpr double kStep = 1e-2;
  const auto difference = [](auto function) {
    return ((8.0 * (function(kStep) - function(-kStep)) - (function(2.0 * kStep) - function(-2.0 * kStep))) /
            (12.0 * kStep));
  };

  MatrixXd information(p + 1, p + 1);
  information.topLeftCorner(p, p) = state.information;
  for (Index j = 0; j < p; ++j) {
    information(j, p) = information(p, j) =
        -difference([&](double step) { return state_at(data, fit.coefficients, fit.theta * std::exp(step)).score(j); });
  }
  information(p, p) =
      -difference([&](double step) { return theta_score(data, fit.coefficients, fit.theta * std::exp(step)); });
  return inverse(information).topLeftCorner(p, p);
}

}  // namespace kith::detail
