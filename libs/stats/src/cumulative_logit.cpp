#include "kith/stats/cumulative_logit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "checks.hpp"
#include "kith/stats/distributions.hpp"
#include "term_hypotheses.hpp"
#include "type_two_test.hpp"

namespace kith {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A log odds ratio with a larger standard error has no bound: Newton's steps go on until the likelihood does not rise
// any more.
constexpr double kUnboundedOdds = 100.0;

// How many observations of each cell have each level of the response.
struct OrdinalData {
  MatrixXd counts;   // [cells, levels]
  MatrixXd columns;  // [cells, p], without the intercept
  double observations = 0.0;
};

// Parameters: thresholds, then coefficients.
struct OrdinalFit {
  VectorXd parameters;
  MatrixXd covariance;
  double log_likelihood = 0.0;
};

struct Derivatives {
  double log_likelihood = 0.0;
  VectorXd score;
  MatrixXd information;  // observed
};

double inverse_logit(double x) { return 1.0 / (1.0 + std::exp(-x)); }
double log_inverse_logit(double x) { return x > 0.0 ? -std::log1p(std::exp(-x)) : x - std::log1p(std::exp(x)); }

OrdinalData ordinal_data(const FactorDesign& design, const Factor& response) {
  std::vector<std::size_t> row_of(design.counts.size(), 0);
  std::size_t rows = 0;
  for (std::size_t c = 0; c < design.counts.size(); ++c) row_of[c] = design.counts[c] > 0 ? rows++ : 0;
  OrdinalData data;
  data.counts = MatrixXd::Zero(static_cast<Index>(rows), static_cast<Index>(response.levels.size()));
  for (std::size_t i = 0; i < response.codes.size(); ++i)
    data.counts(static_cast<Index>(row_of[design.cell_of[i]]), static_cast<Index>(response.codes[i])) += 1.0;
  const MatrixXd columns = detail::observed_columns(design);
  data.columns = columns.rightCols(columns.cols() - 1);  // the intercept comes first and is always kept
  data.observations = static_cast<double>(response.codes.size());
  return data;
}

// With a = threshold_j - eta, b = threshold_(j-1) - eta and h = 1 / (exp(a - b) - 1):
// log P(y = j) = log F(a) + log F(-b) + log(1 - exp(b - a)), whose derivatives lose no digits in the tails.
Derivatives differentiate(const OrdinalData& data, const VectorXd& parameters) {
  const auto num_thresholds = data.counts.cols() - 1;
  const auto size = parameters.size();
  const VectorXd eta = data.columns * parameters.tail(size - num_thresholds);
  Derivatives sum{0.0, VectorXd::Zero(size), MatrixXd::Zero(size, size)};
  VectorXd row(size);
  const auto rank_one = [&](const VectorXd& left, const VectorXd& right, double weight) {
    sum.information.noalias() += weight * left * right.transpose();
  };
  for (Index c = 0; c < data.counts.rows(); ++c) {
    for (Index j = 0; j <= num_thresholds; ++j) {
      const double count = data.counts(c, j);
      if (count == 0.0) continue;
      const bool has_upper = j < num_thresholds;
      const bool has_lower = j > 0;
      const double a = has_upper ? parameters(j) - eta(c) : 0.0;
      const double b = has_lower ? parameters(j - 1) - eta(c) : 0.0;
      double h = 0.0;
      if (has_upper && has_lower) {
        if (!(a > b)) {
          sum.log_likelihood = -std::numeric_limits<double>::infinity();
          return sum;
        }
        h = 1.0 / std::expm1(a - b);
        sum.log_likelihood += count * std::log(-std::expm1(b - a));
      }
      VectorXd upper = VectorXd::Zero(size);  // gradient of a
      VectorXd lower = VectorXd::Zero(size);  // gradient of b
      if (has_upper) {
        sum.log_likelihood += count * log_inverse_logit(a);
        upper(j) = 1.0;
        upper.tail(size - num_thresholds) = -data.columns.row(c).transpose();
        sum.score += count * (inverse_logit(-a) + h) * upper;
        rank_one(upper, upper, count * (inverse_logit(a) * inverse_logit(-a) + h * (1.0 + h)));
      }
      if (has_lower) {
        sum.log_likelihood += count * log_inverse_logit(-b);
        lower(j - 1) = 1.0;
        lower.tail(size - num_thresholds) = -data.columns.row(c).transpose();
        sum.score -= count * (inverse_logit(b) + h) * lower;
        rank_one(lower, lower, count * (inverse_logit(b) * inverse_logit(-b) + h * (1.0 + h)));
      }
      if (has_upper && has_lower) {
        rank_one(upper, lower, -count * h * (1.0 + h));
        rank_one(lower, upper, -count * h * (1.0 + h));
      }
    }
  }
  return sum;
}

// Newton's method from no effects; the log-likelihood is concave. Nothing if there is no maximum.
std::optional<OrdinalFit> fit_ordinal(const OrdinalData& data) {
  constexpr int kMostSteps = 200;
  constexpr double kSmallestGain = 1e-16;
  const auto num_thresholds = data.counts.cols() - 1;

  // From the thresholds without effects, Newton's steps, halved until they gain.
  VectorXd parameters = VectorXd::Zero(num_thresholds + data.columns.cols());
  const VectorXd totals = data.counts.colwise().sum();
  double below = 0.0;
  for (Index j = 0; j < num_thresholds; ++j) {
    below += totals(j);
    parameters(j) = std::log(below / (data.observations - below));
  }

  auto at = differentiate(data, parameters);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::LDLT<MatrixXd> decomposed{at.information};
    const VectorXd change = decomposed.solve(at.score);
    const double gain = change.dot(at.score);
    if (!std::isfinite(gain) || change.cwiseAbs().maxCoeff() > 1e6) return std::nullopt;

    const double rounding = 1e-13 * std::abs(at.log_likelihood);
    double part = 1.0;
    auto next = differentiate(data, parameters + change);
    while (!(next.log_likelihood >= at.log_likelihood - rounding) && part > 1e-9) {
      part /= 2.0;
      next = differentiate(data, parameters + part * change);
    }
    parameters += part * change;
    at = std::move(next);
    if (std::abs(gain) > kSmallestGain * (1.0 + std::abs(at.log_likelihood))) continue;

    OrdinalFit fit{parameters, {}, at.log_likelihood};
    fit.covariance = at.information.ldlt().solve(MatrixXd::Identity(parameters.size(), parameters.size()));
    const double largest = fit.covariance.diagonal().maxCoeff();
    if (!(fit.covariance.diagonal().minCoeff() > 0.0) || !(largest < kUnboundedOdds * kUnboundedOdds))
      return std::nullopt;
    return fit;
  }
  return std::nullopt;
}

// Brant's test: coefficients of the binary models y > j against one another.
Estimable<TestResult> brant_test(const OrdinalData& data) {
  using Result = Estimable<TestResult>;
  const auto num_thresholds = data.counts.cols() - 1;
  const auto p = data.columns.cols();
  if (num_thresholds < 2) return Result::impossible("the response has two levels");
  if (p == 0) return Result::impossible("the model has no coefficients");
  MatrixXd whole(data.columns.rows(), p + 1);
  whole << VectorXd::Ones(data.columns.rows()), data.columns;
  const VectorXd weights = data.counts.rowwise().sum();
  MatrixXd above(data.columns.rows(), num_thresholds);  // P(y > j) of the binary models
  VectorXd coefficients(num_thresholds * p);
  std::vector<MatrixXd> inverses;
  for (Index j = 0; j < num_thresholds; ++j) {
    OrdinalData binary{MatrixXd(data.counts.rows(), 2), data.columns, data.observations};
    binary.counts.col(0) = data.counts.leftCols(j + 1).rowwise().sum();
    binary.counts.col(1) = data.counts.rightCols(num_thresholds - j).rowwise().sum();
    const auto fit = fit_ordinal(binary);
    if (!fit) return Result::impossible("at some threshold the levels of a factor separate low from high responses");
    coefficients.segment(j * p, p) = fit->parameters.tail(p);
    const VectorXd eta = (data.columns * fit->parameters.tail(p)).array() - fit->parameters(0);
    above.col(j) = eta.unaryExpr([](double x) { return inverse_logit(x); });
    const VectorXd spread = weights.array() * above.col(j).array() * (1.0 - above.col(j).array());
    inverses.emplace_back(
        MatrixXd{whole.transpose() * spread.asDiagonal() * whole}.ldlt().solve(MatrixXd::Identity(p + 1, p + 1)));
  }
  MatrixXd covariance(num_thresholds * p, num_thresholds * p);
  for (Index j = 0; j < num_thresholds; ++j) {
    for (Index l = j; l < num_thresholds; ++l) {
      // P(y > j and y > l) - P(y > j) P(y > l) for j <= l.
      const VectorXd joint = weights.array() * above.col(l).array() * (1.0 - above.col(j).array());
      const MatrixXd block = inverses[static_cast<std::size_t>(j)] * (whole.transpose() * joint.asDiagonal() * whole) *
                             inverses[static_cast<std::size_t>(l)];
      covariance.block(j * p, l * p, p, p) = block.bottomRightCorner(p, p);
      covariance.block(l * p, j * p, p, p) = block.bottomRightCorner(p, p).transpose();
    }
  }
  MatrixXd differences = MatrixXd::Zero((num_thresholds - 1) * p, num_thresholds * p);
  for (Index j = 1; j < num_thresholds; ++j) {
    differences.block((j - 1) * p, 0, p, p) = MatrixXd::Identity(p, p);
    differences.block((j - 1) * p, j * p, p, p) = -MatrixXd::Identity(p, p);
  }
  const VectorXd contrast = differences * coefficients;
  const Eigen::LDLT<MatrixXd> decomposed{MatrixXd{differences * covariance * differences.transpose()}};
  const double statistic = contrast.dot(decomposed.solve(contrast));
  if (!decomposed.isPositive() || !(statistic >= 0.0)) return Result::impossible("its covariance is singular");
  const auto df = static_cast<double>(contrast.size());
  return TestResult{"chi-squared", statistic, {df}, chi_squared_upper(statistic, df)};
}

TermTest ordinal_term_test(const Factor& response, std::span<const Factor> factors, const FactorDesign& design,
                           std::size_t term) {
  const auto fit = [&](const std::vector<std::vector<std::size_t>>& terms) -> std::optional<detail::SubFit> {
    const auto model = make_factor_design(response.codes.size(), factors, terms);
    if (!model) return std::nullopt;
    const auto fitted = fit_ordinal(ordinal_data(*model, response));
    if (!fitted) return std::nullopt;
    return detail::SubFit{fitted->log_likelihood, model->kept.size()};
  };
  return detail::type_two_test(design, term, fit, detail::likelihood_ratio_test);
}

}  // namespace

Estimable<CumulativeLogit> fit_cumulative_logit(const Factor& response, std::span<const Factor> factors,
                                                std::span<const std::vector<std::size_t>> terms, double confidence) {
  using Result = Estimable<CumulativeLogit>;
  require_confidence(confidence, "fit_cumulative_logit");
  const auto n = response.codes.size();
  require_codes(response, n, "fit_cumulative_logit");
  auto design = make_factor_design(n, factors, terms);
  if (!design) return Result::impossible(design.reason());
  const auto used = drop_unused(response);
  if (used.levels.size() < 2) return Result::impossible("all responses are " + used.levels.front());
  const auto data = ordinal_data(*design, used);
  const auto num_thresholds = data.counts.cols() - 1;
  const auto p = data.columns.cols();
  if (data.observations <= static_cast<double>(num_thresholds + p))
    return Result::impossible("there are no more observations than parameters");
  const auto fit = fit_ordinal(data);
  if (!fit) {
    return Result::impossible("some levels separate low from high responses, so that their odds ratio has no bound");
  }

  CumulativeLogit model;
  model.levels = used.levels;
  model.log_likelihood = fit->log_likelihood;
  model.observations = n;
  for (Index j = 0; j < num_thresholds; ++j) {
    const auto level = static_cast<std::size_t>(j);
    model.thresholds.push_back(
        {used.levels[level] + "|" + used.levels[level + 1], fit->parameters(j), std::sqrt(fit->covariance(j, j))});
  }
  // The intercept is minus the mean of the thresholds.
  MatrixXd latent = MatrixXd::Zero(p + 1, num_thresholds + p);
  latent.row(0).head(num_thresholds).setConstant(-1.0 / static_cast<double>(num_thresholds));
  latent.bottomRightCorner(p, p) = MatrixXd::Identity(p, p);
  const VectorXd coefficients = latent * fit->parameters;
  const MatrixXd covariance = latent * fit->covariance * latent.transpose();
  const double z_of_interval = normal_quantile(0.5 + confidence / 2.0);
  for (Index j = 1; j <= p; ++j) {
    const double standard_error = std::sqrt(covariance(j, j));
    const double z = coefficients(j) / standard_error;
    const double reach = z_of_interval * standard_error;
    model.odds_ratios.push_back(
        {design->columns[design->kept[static_cast<std::size_t>(j)]],
         {std::exp(coefficients(j)), std::exp(coefficients(j) - reach), std::exp(coefficients(j) + reach)},
         {"z", z, {}, 2.0 * normal_upper(std::abs(z))}});
  }
  for (std::size_t t = 0; t < design->terms.size(); ++t)
    model.term_tests.push_back(ordinal_term_test(used, factors, *design, t));
  model.proportional_odds = brant_test(data);
  model.fixed = make_fixed_effects(
      *design, {coefficients.data(), static_cast<std::size_t>(coefficients.size())},
      {covariance.data(), static_cast<std::size_t>(covariance.size())},
      [](std::span<const double>) { return std::numeric_limits<double>::infinity(); }, Link::kLogit);
  model.fixed.residual_sd = std::numbers::pi / std::sqrt(3.0);
  return model;
}

}  // namespace kith
