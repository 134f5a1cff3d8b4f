// With alpha = 1 / theta and u = alpha mu, observed counts have the log-likelihood of negative_binomial.cpp. A count
// that is censored at y has log S, S = P(Y > y) = I_p(y + 1, theta), the regularised incomplete beta function at
// p = u / (1 + u), whose derivative by log(mu) is p^(y + 1) (1 - p)^theta / B(y + 1, theta). Poisson's is the limit
// of the regularised incomplete gamma function P(y + 1, mu).
#include "kith/stats/censored_counts.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "rising_product.hpp"
#include "term_hypotheses.hpp"
#include "type_two_test.hpp"

namespace kith {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond it the model is Poisson's.
constexpr double kLargestTheta = 1e5;
constexpr double kSmallestTheta = 1e-4;
// A coefficient with a larger standard error has no bound: Newton's steps go on until the likelihood does not rise any
// more.
constexpr double kUnboundedRatio = 100.0;

struct Repeated {
  double count = 0.0;
  double times = 0.0;
};
struct CensoredCell {
  double observed = 0.0;           // number
  double sum = 0.0;                // of the observed counts
  std::vector<Repeated> censored;  // bounds
};
struct CensoredData {
  std::vector<CensoredCell> cells;
  MatrixXd columns;              // [cells, p]
  std::vector<Repeated> counts;  // observed ones of all cells
  double log_factorials = 0.0;   // of the observed counts
  double mean = 0.0;             // of all counts
};

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

CensoredData censored_data(std::span<const double> counts, const std::vector<bool>& observed,
                           const FactorDesign& design) {
  CensoredData data;
  data.columns = detail::observed_columns(design);
  std::vector<std::size_t> row_of(design.counts.size(), 0);
  std::size_t rows = 0;
  for (std::size_t c = 0; c < design.counts.size(); ++c) row_of[c] = design.counts[c] > 0 ? rows++ : 0;
  data.cells.resize(rows);
  std::vector<std::map<double, double>> bounds(rows);
  std::map<double, double> times;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto row = row_of[design.cell_of[i]];
    data.mean += counts[i] / static_cast<double>(counts.size());
    if (observed[i]) {
      data.cells[row].observed += 1.0;
      data.cells[row].sum += counts[i];
      times[counts[i]] += 1.0;
    } else {
      bounds[row][counts[i]] += 1.0;
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (const auto& [bound, number] : bounds[row]) data.cells[row].censored.push_back({bound, number});
  }
  for (const auto& [count, number] : times) {
    data.counts.push_back({count, number});
    data.log_factorials += number * boost::math::lgamma(count + 1.0);
  }
  return data;
}

struct CensoredState {
  double log_likelihood = 0.0;
  VectorXd score;        // by the coefficients
  MatrixXd information;  // observed
};

CensoredState state_at(const CensoredData& data, const VectorXd& coefficients, double theta) {
  const double alpha = 1.0 / theta;
  const detail::RisingProduct rising{alpha};
  CensoredState state{-data.log_factorials, VectorXd::Zero(coefficients.size()),
                      MatrixXd::Zero(coefficients.size(), coefficients.size())};
  for (const auto& [count, times] : data.counts) state.log_likelihood += times * rising.log(count);
  const VectorXd eta = data.columns * coefficients;
  for (Index c = 0; c < data.columns.rows(); ++c) {
    const auto& cell = data.cells[static_cast<std::size_t>(c)];
    const double mu = std::exp(eta(c));
    const double u = alpha * mu;
    const double share = 1.0 / (1.0 + u);
    state.log_likelihood += cell.sum * (eta(c) - std::log1p(u)) - cell.observed * mu * detail::log1p_ratio(u);
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
double theta_score(const CensoredData& data, const VectorXd& coefficients, double theta) {
  constexpr double kStep = 1e-3;
  const double alpha = 1.0 / theta;
  const detail::RisingProduct rising{alpha};
  double by_alpha = 0.0;
  for (const auto& [count, times] : data.counts) by_alpha += times * rising.slope(count);
  double by_log_theta = 0.0;
  const VectorXd eta = data.columns * coefficients;
  for (Index c = 0; c < data.columns.rows(); ++c) {
    const auto& cell = data.cells[static_cast<std::size_t>(c)];
    const double mu = std::exp(eta(c));
    const double u = alpha * mu;
    by_alpha += cell.observed * mu * mu * (detail::log1p_rest(u) + 1.0 / (1.0 + u)) - cell.sum * mu / (1.0 + u);
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

// The coefficients of largest likelihood at this theta; nothing if they run away to infinity.
std::optional<VectorXd> fit_coefficients(const CensoredData& data, double theta, VectorXd coefficients) {
  constexpr int kMostSteps = 200;
  constexpr double kSmallestGain = 1e-16;
  auto at = state_at(data, coefficients, theta);
  for (int step = 0; step < kMostSteps; ++step) {
    const VectorXd change = at.information.ldlt().solve(at.score);
    const double gain = change.dot(at.score);
    if (!std::isfinite(gain) || !(coefficients.cwiseAbs().maxCoeff() < 1e3)) return std::nullopt;
    const double rounding = 1e-13 * std::abs(at.log_likelihood);
    double part = std::min(1.0, 5.0 / change.cwiseAbs().maxCoeff());
    auto next = state_at(data, coefficients + part * change, theta);
    while (!(next.log_likelihood >= at.log_likelihood - rounding) && part > 1e-9) {
      part /= 2.0;
      next = state_at(data, coefficients + part * change, theta);
    }
    coefficients += part * change;
    at = std::move(next);
    if (std::abs(gain) > kSmallestGain * (1.0 + std::abs(at.log_likelihood))) continue;
    const VectorXd variances =
        at.information.ldlt().solve(MatrixXd::Identity(coefficients.size(), coefficients.size())).diagonal();
    if (!(variances.minCoeff() > 0.0) || !(variances.maxCoeff() < kUnboundedRatio * kUnboundedRatio))
      return std::nullopt;
    return coefficients;
  }
  return std::nullopt;
}

struct CensoredFit {
  double theta = kInfinity;
  VectorXd coefficients;
  double log_likelihood = 0.0;
};

// Follows the profile likelihood from Poisson's side to the first theta at which it falls towards infinity.
std::optional<CensoredFit> fit_censored(const CensoredData& data) {
  VectorXd start = VectorXd::Zero(data.columns.cols());
  start(0) = std::log(data.mean + 0.1);
  const auto poisson = fit_coefficients(data, kInfinity, start);
  if (!poisson) return std::nullopt;
  const CensoredFit limit{kInfinity, *poisson, state_at(data, *poisson, kInfinity).log_likelihood};
  VectorXd coefficients = *poisson;
  bool failed = false;
  const auto score = [&](double log_theta) {
    const double theta = std::exp(log_theta);
    auto fitted = fit_coefficients(data, theta, coefficients);
    if (!fitted) {
      failed = true;
      return 0.0;
    }
    coefficients = std::move(*fitted);
    return theta_score(data, coefficients, theta);
  };
  double high = std::log(kLargestTheta);
  double high_score = score(high);
  if (failed) return std::nullopt;
  if (high_score >= 0.0) return limit;
  double low = high;
  double low_score = high_score;
  while (low_score < 0.0) {
    high = low;
    high_score = low_score;
    low -= 1.5;
    if (low < std::log(kSmallestTheta)) return std::nullopt;
    low_score = score(low);
    if (failed) return std::nullopt;
  }
  double root = low;
  if (low_score > 0.0) {
    std::uintmax_t evaluations = 100;
    const auto [from, to] = boost::math::tools::toms748_solve(
        score, low, high, low_score, high_score, boost::math::tools::eps_tolerance<double>(40), evaluations);
    if (failed) return std::nullopt;
    root = from + (to - from) / 2.0;
  }
  const double theta = std::exp(root);
  const auto fitted = fit_coefficients(data, theta, coefficients);
  if (!fitted) return std::nullopt;
  CensoredFit fit{theta, *fitted, state_at(data, *fitted, theta).log_likelihood};
  return fit.log_likelihood > limit.log_likelihood ? fit : limit;
}

// The inverse of the observed information of the coefficients and, if theta is finite, of log(theta), which is left
// out of what is returned.
MatrixXd coefficient_covariance(const CensoredData& data, const CensoredFit& fit) {
  const auto p = fit.coefficients.size();
  const auto state = state_at(data, fit.coefficients, fit.theta);
  if (std::isinf(fit.theta)) return state.information.ldlt().solve(MatrixXd::Identity(p, p));
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
  return MatrixXd{information.ldlt().solve(MatrixXd::Identity(p + 1, p + 1))}.topLeftCorner(p, p);
}

TermTest censored_term_test(std::span<const double> counts, const std::vector<bool>& observed,
                            std::span<const Factor> factors, const FactorDesign& design, std::size_t term) {
  const auto fit = [&](const std::vector<std::vector<std::size_t>>& terms) -> std::optional<detail::SubFit> {
    const auto model = make_factor_design(counts.size(), factors, terms);
    if (!model) return std::nullopt;
    const auto fitted = fit_censored(censored_data(counts, observed, *model));
    if (!fitted) return std::nullopt;
    return detail::SubFit{fitted->log_likelihood, model->kept.size()};
  };
  return detail::type_two_test(design, term, fit, detail::likelihood_ratio_test);
}

}  // namespace

Estimable<CensoredCountModel> fit_censored_counts(std::span<const double> counts, const std::vector<bool>& observed,
                                                  std::span<const Factor> factors,
                                                  std::span<const std::vector<std::size_t>> terms) {
  using Result = Estimable<CensoredCountModel>;
  if (counts.size() != observed.size())
    throw std::invalid_argument{"fit_censored_counts: one value per count that says whether it was observed"};
  const auto design = make_factor_design(counts.size(), factors, terms);
  if (!design) return Result::impossible(design.reason());
  const auto is_count = [](double count) { return count >= 0.0 && std::isfinite(count) && count == std::floor(count); };
  if (!std::ranges::all_of(counts, is_count))
    return Result::impossible("counts must be whole numbers that are not negative");
  if (std::ranges::find(observed, true) == observed.end()) return Result::impossible("all counts are censored");
  if (std::ranges::all_of(counts, [](double count) { return count == 0.0; }))
    return Result::impossible("all counts are zero");
  if (counts.size() <= design->kept.size())
    return Result::impossible("there are no more observations than coefficients");
  const auto data = censored_data(counts, observed, *design);
  const auto fit = fit_censored(data);
  if (!fit) {
    return Result::impossible(
        "the likelihood has no maximum: some combinations of levels may have only zeros or only censored counts");
  }
  CensoredCountModel model;
  if (std::isfinite(fit->theta)) model.theta = fit->theta;
  model.log_likelihood = fit->log_likelihood;
  model.observations = counts.size();
  model.censored = static_cast<std::size_t>(std::ranges::count(observed, false));
  for (std::size_t t = 0; t < design->terms.size(); ++t)
    model.term_tests.push_back(censored_term_test(counts, observed, factors, *design, t));
  const MatrixXd covariance = coefficient_covariance(data, *fit);
  model.fixed = make_fixed_effects(
      *design, {fit->coefficients.data(), static_cast<std::size_t>(fit->coefficients.size())},
      {covariance.data(), static_cast<std::size_t>(covariance.size())},
      [](std::span<const double>) { return kInfinity; }, Link::kLog);
  return model;
}

}  // namespace kith
