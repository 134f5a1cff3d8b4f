#include "kith/stats/mixed_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/stats/distributions.hpp"
#include "mixed_deviance.hpp"
#include "root.hpp"
#include "term_hypotheses.hpp"

namespace kith {
namespace {

using detail::MixedDeviance;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 200;
constexpr int kCheapSteps = 10;          // with the average information; then with the Hessian
constexpr double kLongestStep = 4.0;     // of log(tau)
constexpr double kSmallestStep = 1e-10;  // of log(tau)
// A ratio of variances below this times the number of groups per row is 0: it changes no digit of a result.
constexpr double kZeroRatio = 1e-9;
// Above it the residual variance is rounding.
constexpr double kLargestRatio = 1e11;
// How much a deviance may rise by rounding, as a part of it.
constexpr double kRoundingOfDeviance = 1e-13;

struct Optimum {
  VectorXd tau;
  MixedDeviance::Value value;
  bool converged = false;
};

// Gradient by log(tau) with the residual variance given.
VectorXd log_gradient(const MixedDeviance::Derivatives& at, const VectorXd& tau, double variance) {
  return tau.cwiseProduct(at.traces - at.squares / variance);
}

// The Hessian by log(tau) with the residual variance given, from differences of the gradient with errors of the fourth
// order; rows and columns of groupings with tau = 0 are 0.
MatrixXd log_hessian(MixedDeviance& data, const Optimum& optimum) {
  constexpr double kStep = 2e-3;
  const auto num = optimum.tau.size();
  const auto gradient_at = [&](Index k, double step) {
    VectorXd tau = optimum.tau;
    tau(k) *= std::exp(step);
    const auto value = data.evaluate(tau);
    return log_gradient(data.differentiate(value), tau, optimum.value.variance);
  };
  MatrixXd hessian = MatrixXd::Zero(num, num);
  for (Index k = 0; k < num; ++k) {
    if (optimum.tau(k) == 0.0) continue;
    const VectorXd near = gradient_at(k, kStep) - gradient_at(k, -kStep);
    const VectorXd far = gradient_at(k, 2.0 * kStep) - gradient_at(k, -2.0 * kStep);
    hessian.col(k) = (8.0 * near - far) / (12.0 * kStep);
  }
  static_cast<void>(data.evaluate(optimum.tau));  // back to where the caller is
  return (hessian + hessian.transpose()) / 2.0;
}

// What profiling the residual variance out takes from a Hessian.
MatrixXd profiled(const MatrixXd& hessian, const VectorXd& shares, double degrees_of_freedom) {
  return hessian - shares * shares.transpose() / degrees_of_freedom;
}

std::vector<Index> positive_entries(const VectorXd& tau) {
  std::vector<Index> positive;
  for (Index k = 0; k < tau.size(); ++k) {
    if (tau(k) > 0.0) positive.push_back(k);
  }
  return positive;
}

// The Newton step of log(tau), 0 where tau is 0.
VectorXd newton_step(MixedDeviance& data, const Optimum& at, bool exactly) {
  const auto derivatives = data.differentiate(at.value);
  const double variance = at.value.variance;
  const VectorXd gradient = log_gradient(derivatives, at.tau, variance);
  const VectorXd shares = at.tau.cwiseProduct(derivatives.squares) / variance;
  const auto positive = positive_entries(at.tau);
  const auto step_by = [&](const MatrixXd& hessian) -> std::optional<VectorXd> {
    const Eigen::LDLT<MatrixXd> decomposed{
        MatrixXd{profiled(hessian, shares, data.degrees_of_freedom())(positive, positive)}};
    if (!decomposed.isPositive() || !(decomposed.vectorD().minCoeff() > 0.0)) return std::nullopt;
    VectorXd step = VectorXd::Zero(at.tau.size());
    step(positive) = -decomposed.solve(VectorXd{gradient(positive)});
    return step;
  };
  std::optional<VectorXd> step;
  if (exactly) step = step_by(log_hessian(data, at));
  if (!step) step = step_by(at.tau.asDiagonal() * derivatives.average_information * at.tau.asDiagonal() / variance);
  // Where neither is positive definite: to the tau at which the squares are what they are expected to be.
  if (!step) step = -gradient.cwiseQuotient((at.tau.cwiseProduct(derivatives.traces) + shares).cwiseMax(1e-300));
  const double longest = step->cwiseAbs().maxCoeff();
  return longest > kLongestStep ? VectorXd{*step * (kLongestStep / longest)} : *step;
}

// Minimises the deviance over the tau that are positive at the start. A tau that tends to 0 becomes 0.
Optimum minimise(MixedDeviance& data, const VectorXd& start) {
  Optimum best{start, data.evaluate(start)};
  for (int count = 0; count < kMostSteps; ++count) {
    if (positive_entries(best.tau).empty()) {
      best.converged = true;
      break;
    }
    const VectorXd step = newton_step(data, best, count >= kCheapSteps);
    const double rounding = kRoundingOfDeviance * (std::abs(best.value.deviance) + data.degrees_of_freedom());
    std::optional<Optimum> next;
    double part = 2.0;
    while ((part /= 2.0) > 1e-6) {
      VectorXd tau = best.tau.cwiseProduct((part * step).array().exp().matrix());
      for (auto& ratio : tau) ratio = ratio < kZeroRatio ? 0.0 : ratio;
      auto value = data.evaluate(tau);
      if (!(value.deviance <= best.value.deviance + rounding)) continue;
      next = Optimum{std::move(tau), std::move(value)};
      break;
    }
    if (!next) {  // no step lowers it: as good as rounding lets it be, if the step is short
      best.value = data.evaluate(best.tau);
      best.converged = step.cwiseAbs().maxCoeff() < 1e-6;
      break;
    }
    best = std::move(*next);
    if (best.tau.maxCoeff() > kLargestRatio) break;
    if (step.cwiseAbs().maxCoeff() < kSmallestStep) {
      best.converged = true;
      break;
    }
  }
  return best;
}

// The same from tau = 1, where lme4 starts; groupings that are not free have tau = 0. What became 0 on the way is tried
// again.
Optimum find_optimum(MixedDeviance& data, const std::vector<bool>& is_free) {
  VectorXd start(static_cast<Index>(is_free.size()));
  for (std::size_t k = 0; k < is_free.size(); ++k) start(static_cast<Index>(k)) = is_free[k] ? 1.0 : 0.0;
  auto best = minimise(data, start);
  for (std::size_t k = 0; k < is_free.size(); ++k) {
    constexpr double kSmall = 1e-5;
    const auto index = static_cast<Index>(k);
    if (!is_free[k] || best.tau(index) > 0.0 || !best.converged) continue;
    VectorXd tau = best.tau;
    tau(index) = kSmall;
    const auto value = data.evaluate(tau);
    if (value.deviance < best.value.deviance) {
      auto again = minimise(data, tau);
      if (again.converged && again.value.deviance < best.value.deviance) best = std::move(again);
    }
  }
  best.value = data.evaluate(best.tau);
  return best;
}

// The asymptotic covariance of log(tau) and of the logarithm of the residual variance, which comes last: twice the
// inverse of the deviance's Hessian. Rows and columns of variances of 0 are 0.
MatrixXd covariance_of_variances(MixedDeviance& data, const Optimum& optimum, const VectorXd& shares) {
  const auto num = optimum.tau.size();
  MatrixXd hessian(num + 1, num + 1);
  hessian.topLeftCorner(num, num) = log_hessian(data, optimum);
  hessian.col(num).head(num) = shares;
  hessian.row(num).head(num) = shares.transpose();
  hessian(num, num) = data.degrees_of_freedom();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen{hessian};
  const double least = 1e-10 * eigen.eigenvalues().maxCoeff();
  VectorXd inverse(num + 1);
  for (Index i = 0; i <= num; ++i) inverse(i) = eigen.eigenvalues()(i) > least ? 2.0 / eigen.eigenvalues()(i) : 0.0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

// How the variance of a combination depends on the variances, and how uncertain these are.
struct Satterthwaite {
  MatrixXd covariance;             // of the coefficients, over the residual variance
  std::vector<MatrixXd> gradient;  // of it by log(tau)
  MatrixXd uncertainty;            // as covariance_of_variances()

  double operator()(std::span<const double> combination) const {
    const Eigen::Map<const VectorXd> weights{combination.data(), static_cast<Index>(combination.size())};
    const double variance = weights.dot(covariance * weights);
    VectorXd slopes(static_cast<Index>(gradient.size()) + 1);
    for (std::size_t k = 0; k < gradient.size(); ++k)
      slopes(static_cast<Index>(k)) = weights.dot(gradient[k] * weights);
    slopes(slopes.size() - 1) = variance;
    return 2.0 * variance * variance / slopes.dot(uncertainty * slopes);
  }
};

double share_of(const VectorXd& tau, Index k) { return tau(k) / (1.0 + tau.sum()); }

// Where the deviance of a single random intercept rises above its minimum by the quantile of chi-squared.
Interval profile_interval(MixedDeviance& data, const Optimum& optimum, double confidence) {
  const double z = normal_quantile(0.5 + confidence / 2.0);
  const double limit = optimum.value.deviance + z * z;
  const auto excess = [&](double log_tau) {
    return data.evaluate(VectorXd::Constant(1, std::exp(log_tau))).deviance - limit;
  };
  const auto root = [&](double inside, double outside) {
    return std::exp(detail::root_between(std::min(inside, outside), std::max(inside, outside), 32, excess));
  };

  const double tau = optimum.tau(0);
  Interval interval{tau / (1.0 + tau), 0.0, 1.0};
  const double middle = std::log(std::max(tau, kZeroRatio));
  const double low_end = std::log(kZeroRatio);
  if (tau > kZeroRatio && excess(low_end) > 0.0) {
    const double low = root(middle, low_end);
    interval.low = low / (1.0 + low);
  }

  // Outward until the deviance is too large.
  double inside = middle, outside = middle + 1.0;
  while (outside < std::log(kLargestRatio)) {
    if (excess(outside) <= 0.0) {
      inside = outside;
      outside += 1.0;
      continue;
    }
    const double high = root(inside, outside);
    interval.high = high / (1.0 + high);
    break;
  }
  return interval;
}

// Wald's interval of log(rho / (1 - rho)) for rho = tau_k / (1 + sum of tau).
Estimable<Interval> share_interval(const VectorXd& tau, const MatrixXd& uncertainty, Index k, double confidence) {
  if (tau(k) == 0.0) return Estimable<Interval>::impossible("its variance is zero");
  const double rest = 1.0 + tau.sum() - tau(k);
  VectorXd slopes = -tau / rest;
  slopes(k) = 1.0;
  const double variance = slopes.dot(uncertainty.topLeftCorner(tau.size(), tau.size()) * slopes);
  const double reach = normal_quantile(0.5 + confidence / 2.0) * std::sqrt(std::max(variance, 0.0));
  const double odds = std::log(tau(k) / rest);
  const auto share = [](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); };
  return Interval{share(odds), share(odds - reach), share(odds + reach)};
}

Estimable<TestResult> variance_test(MixedDeviance& data, const Optimum& optimum, std::size_t k) {
  std::vector<bool> is_free(data.num_groupings(), true);
  is_free[k] = false;
  const auto without = find_optimum(data, is_free);
  if (!without.converged) return Estimable<TestResult>::impossible("the model without it could not be fitted");
  const double statistic = std::max(0.0, without.value.deviance - optimum.value.deviance);
  return TestResult{"chi-squared", statistic, {1.0}, chi_squared_upper(statistic, 1.0)};
}

// Why these groupings define no model; empty if nothing is wrong.
std::string fault_of_groups(std::span<const Factor> groups, std::size_t observations) {
  for (const auto& group : groups) {
    if (group.levels.size() == 1) return "all rows have the same " + group.name;
    if (group.levels.size() == observations) {
      return "every row has a " + group.name +
             " of its own, so the variance between them cannot be told from that of single rows";
    }
  }
  for (std::size_t a = 0; a < groups.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const std::vector<Factor> both{groups[b], groups[a]};
      if (groups[a].levels.size() == groups[b].levels.size() &&
          group_factor(both).levels.size() == groups[a].levels.size())
        return groups[b].name + " and " + groups[a].name + " divide the rows into the same groups";
    }
  }
  return {};
}

std::vector<double> as_vector(const MatrixXd& symmetric) {
  return {symmetric.data(), symmetric.data() + symmetric.size()};
}

}  // namespace

Factor group_factor(std::span<const Factor> factors) {
  if (factors.empty()) throw std::invalid_argument{"group_factor: at least one factor is needed"};
  auto groups = drop_unused(factors.front());
  for (const auto& factor : factors.subspan(1)) {
    require_codes(factor, groups.codes.size(), "group_factor");
    groups.name += ":" + factor.name;
    std::vector<std::string> values;
    values.reserve(groups.codes.size());
    // Two numbers name a pair whatever the levels' names are.
    for (std::size_t i = 0; i < groups.codes.size(); ++i)
      values.push_back(std::to_string(groups.codes[i]) + ":" + std::to_string(factor.codes[i]));
    auto pairs = make_factor(groups.name, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      pairs.levels[pairs.codes[i]] = groups.levels[groups.codes[i]] + ":" + factor.levels[factor.codes[i]];
    groups = std::move(pairs);
  }
  return groups;
}

Estimable<MixedModel> fit_mixed_model(std::span<const double> response, std::span<const Factor> factors,
                                      std::span<const std::vector<std::size_t>> terms, std::span<const Factor> groups,
                                      const MixedModelOptions& options) {
  using Result = Estimable<MixedModel>;
  require_confidence(options.confidence, "fit_mixed_model");
  require_finite(response, "fit_mixed_model");
  if (groups.empty()) throw std::invalid_argument{"fit_mixed_model: at least one grouping factor is needed"};
  std::vector<Factor> used;
  for (const auto& group : groups) {
    require_codes(group, response.size(), "fit_mixed_model");
    used.push_back(drop_unused(group));
  }
  auto made = make_factor_design(response.size(), factors, terms);
  if (!made) return Result::impossible(made.reason());
  auto design = *made;
  if (response.size() <= design.kept.size())
    return Result::impossible("there are no more observations than coefficients");
  if (const auto fault = fault_of_groups(used, response.size()); !fault.empty()) return Result::impossible(fault);

  const auto standardized = standardize(response);
  MixedDeviance data{design, standardized.values, used, options.reml};
  if (!data.is_feasible()) return Result::impossible("too many groups are crossed with one another");
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (data.is_confounded(k))
      return Result::impossible("the factors of the model already tell every " + used[k].name +
                                " apart, so the variance between them cannot be estimated");
  }
  const auto num = static_cast<Index>(used.size());
  if (data.evaluate(VectorXd::Zero(num)).sum_of_squares <=
      negligible_sum_of_squares(standardized.rounding, response.size()))
    return Result::impossible("no spread around the model's values");
  const auto optimum = find_optimum(data, std::vector<bool>(used.size(), true));
  if (optimum.tau.maxCoeff() > kLargestRatio ||
      optimum.value.sum_of_squares <= negligible_sum_of_squares(standardized.rounding, response.size()))
    return Result::impossible("no spread of rows within their groups");
  if (!optimum.converged) return Result::impossible("the search for the largest likelihood did not end");

  const auto derivatives = data.differentiate(optimum.value);
  const VectorXd shares = optimum.tau.cwiseProduct(derivatives.squares) / optimum.value.variance;
  const MatrixXd uncertainty = covariance_of_variances(data, optimum, shares);
  const auto& covariance = optimum.value.unscaled_covariance;
  Satterthwaite satterthwaite{covariance, {}, uncertainty};
  for (Index k = 0; k < num; ++k) {
    satterthwaite.gradient.push_back(optimum.tau(k) * covariance * derivatives.cross[static_cast<std::size_t>(k)] *
                                     covariance);
  }

  MixedModel model;
  model.residual_variance = std::ldexp(optimum.value.variance, 2 * standardized.exponent);
  model.log_likelihood =
      -0.5 * optimum.value.deviance - standardized.exponent * std::log(2.0) * data.degrees_of_freedom();
  model.reml = options.reml;
  model.observations = response.size();
  model.singular = optimum.tau.minCoeff() == 0.0;
  for (Index k = 0; k < num; ++k) {
    const auto& group = used[static_cast<std::size_t>(k)];
    VarianceComponent component{group.name, group.levels.size(), optimum.tau(k) * model.residual_variance,
                                share_of(optimum.tau, k)};
    if (options.test_variances) {
      component.intraclass_interval = num == 1 ? profile_interval(data, optimum, options.confidence)
                                               : share_interval(optimum.tau, uncertainty, k, options.confidence);
      component.test = variance_test(data, optimum, static_cast<std::size_t>(k));
    }
    model.components.push_back(std::move(component));
  }

  std::vector<double> coefficients(design.kept.size());
  for (std::size_t j = 0; j < coefficients.size(); ++j)
    coefficients[j] = std::ldexp(optimum.value.coefficients(static_cast<Index>(j)), standardized.exponent);
  coefficients.front() += standardized.centre;  // the intercept comes first and is always kept
  const MatrixXd scaled = covariance * model.residual_variance;
  model.fixed = make_fixed_effects(std::move(design), coefficients, as_vector(scaled), std::move(satterthwaite));
  model.fixed.residual_sd = std::sqrt(model.residual_variance * (1.0 + optimum.tau.sum()));
  return model;
}

std::vector<TermTest> term_tests(const FixedEffects& model, SumsOfSquares type) {
  const auto& design = model.design;
  const auto p = static_cast<Index>(design.columns.size());
  const auto kept = static_cast<Index>(design.kept.size());

  VectorXd coefficients(kept);
  MatrixXd covariance(kept, kept);
  for (Index i = 0; i < kept; ++i) {
    const auto row = static_cast<Index>(design.kept[static_cast<std::size_t>(i)]);
    coefficients(i) = model.coefficients[static_cast<std::size_t>(row)];
    for (Index j = 0; j < kept; ++j) {
      const auto column = static_cast<Index>(design.kept[static_cast<std::size_t>(j)]);
      covariance(i, j) = model.covariance[static_cast<std::size_t>(row * p + column)];
    }
  }

  const auto df = [&](const VectorXd& combination) {
    std::vector<double> weights(static_cast<std::size_t>(p), 0.0);
    for (Index i = 0; i < kept; ++i) weights[design.kept[static_cast<std::size_t>(i)]] = combination(i);
    return model.df(weights);
  };

  std::vector<TermTest> tests;
  for (std::size_t t = 0; t < design.terms.size(); ++t) {
    const auto name = detail::term_name(design, t);
    if (!model.no_standard_errors.empty()) {
      tests.push_back({name, 0, Estimable<TestResult>::impossible(model.no_standard_errors)});
      continue;
    }
    tests.push_back(
        detail::satterthwaite_test(name, detail::term_hypothesis(design, t, type), coefficients, covariance, df));
  }
  return tests;
}

}  // namespace kith
