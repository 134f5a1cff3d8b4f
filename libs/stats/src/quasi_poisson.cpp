#include "kith/stats/quasi_poisson.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "checks.hpp"
#include "count_design.hpp"
#include "kith/stats/distributions.hpp"
#include "type_two_test.hpp"

namespace kith {
namespace {

// A Poisson fit of some terms.
struct LogLinearFit {
  detail::CountData data;
  detail::CountDesign design;
  detail::CountFit fit;
  std::string fault;  // Why there is no fit; empty if there is.
};

LogLinearFit fit_log_linear(std::span<const double> counts, const FactorDesign& design) {
  LogLinearFit result{detail::count_data_of(counts, design), detail::count_design_of(design), {}, {}};
  if (result.data.sum == 0.0) {
    result.fault = "all counts are zero";
  } else if (detail::zeros_separate(result.data, result.design)) {
    result.fault = "combinations of levels with only zeros leave some ratios without a bound";
  } else if (auto fit = detail::fit_poisson(result.data, result.design)) {
    result.fit = std::move(*fit);
  } else {
    result.fault = "the search for the largest likelihood did not end";
  }
  return result;
}

// What of the log-likelihood differs between models: the sum of y log(mu) - mu.
double log_likelihood_of(const LogLinearFit& model) {
  const Eigen::VectorXd eta = detail::linear_predictor(model.design, model.fit.coefficients);
  double sum = 0.0;
  for (std::size_t c = 0; c < model.data.cells.size(); ++c) {
    const auto& cell = model.data.cells[c];
    const double eta_c = eta[static_cast<Eigen::Index>(c)];
    sum += cell.sum * eta_c - cell.observations * std::exp(eta_c);
  }
  return sum;
}

TermTest f_test_of_term(std::span<const double> counts, std::span<const Factor> factors, const FactorDesign& design,
                        std::size_t term, double dispersion, double residual_df) {
  const auto fit = [&](const std::vector<std::vector<std::size_t>>& terms) -> std::optional<detail::SubFit> {
    const auto model = make_factor_design(counts.size(), factors, terms);
    if (!model) return std::nullopt;
    const auto fitted = fit_log_linear(counts, *model);
    if (!fitted.fault.empty()) return std::nullopt;
    return detail::SubFit{log_likelihood_of(fitted), model->kept.size()};
  };
  return detail::type_two_test(design, term, fit, [&](double statistic, double df) {
    const double f = statistic / df / dispersion;
    return TestResult{"F", f, {df, residual_df}, f_upper(f, df, residual_df)};
  });
}

}  // namespace

Estimable<QuasiPoissonModel> fit_quasi_poisson(std::span<const double> counts, std::span<const Factor> factors,
                                               std::span<const std::vector<std::size_t>> terms) {
  using Result = Estimable<QuasiPoissonModel>;
  require_finite(counts, "fit_quasi_poisson");
  const auto design = make_factor_design(counts.size(), factors, terms);
  if (!design) return Result::impossible(design.reason());
  if (std::ranges::any_of(counts, [](double count) { return count < 0.0; }))
    return Result::impossible("counts must not be negative");
  if (counts.size() <= design->kept.size())
    return Result::impossible("there are no more observations than coefficients");
  const auto model = fit_log_linear(counts, *design);
  if (!model.fault.empty()) return Result::impossible(model.fault);

  QuasiPoissonModel result;
  result.observations = counts.size();
  result.residual_df = counts.size() - design->kept.size();
  result.dispersion = detail::pearson_dispersion(model.data, model.design, model.fit);
  constexpr double kLeastDispersion = 1e-20;
  if (result.dispersion <= kLeastDispersion) return Result::impossible("no spread around the model's values");
  const auto size = model.design.size;
  const Eigen::MatrixXd covariance =
      result.dispersion * Eigen::MatrixXd{detail::expected_information(model.data, model.design, model.fit)
                                              .ldlt()
                                              .solve(Eigen::MatrixXd::Identity(size, size))};
  const auto residual_df = static_cast<double>(result.residual_df);
  for (std::size_t t = 0; t < design->terms.size(); ++t)
    result.term_tests.push_back(f_test_of_term(counts, factors, *design, t, result.dispersion, residual_df));
  const auto& coefficients = model.fit.coefficients;
  result.fixed = make_fixed_effects(
      *design, {coefficients.data(), static_cast<std::size_t>(coefficients.size())},
      {covariance.data(), static_cast<std::size_t>(covariance.size())},
      [residual_df](std::span<const double>) { return residual_df; }, Link::kLog);
  return result;
}

}  // namespace kith
