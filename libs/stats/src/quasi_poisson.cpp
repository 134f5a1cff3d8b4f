#include "kith/stats/quasi_poisson.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "checks.hpp"
#include "count_fit.hpp"
#include "kith/stats/distributions.hpp"
#include "type_two_test.hpp"

namespace kith {
namespace {

// Pearson's chi-squared of a Poisson model over its degrees of freedom.
double pearson_dispersion(const detail::CountData& data, const detail::CountFit& poisson, double residual_df) {
  const Eigen::VectorXd mu = (data.columns * poisson.coefficients).array().exp();
  double chi_squared = 0.0;
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    const double mu_c = mu[static_cast<Eigen::Index>(c)];
    const double off = cell.sum / cell.observed - mu_c;
    chi_squared += (cell.squares + cell.observed * off * off) / mu_c;
  }
  return chi_squared / residual_df;
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
  const auto data = detail::count_data(counts, {}, *design);
  if (data.mean == 0.0) return Result::impossible("all counts are zero");
  if (detail::is_separated(data))
    return Result::impossible("combinations of levels with only zeros leave some ratios without a bound");
  const auto fit = detail::fit_poisson(data);
  if (!fit) return Result::impossible("the search for the largest likelihood did not end");

  QuasiPoissonModel result;
  result.observations = counts.size();
  result.residual_df = counts.size() - design->kept.size();
  const auto residual_df = static_cast<double>(result.residual_df);
  result.dispersion = pearson_dispersion(data, *fit, residual_df);
  constexpr double kLeastDispersion = 1e-20;
  if (result.dispersion <= kLeastDispersion) return Result::impossible("no spread around the model's values");
  const auto sub_fit = [&](const std::vector<std::vector<std::size_t>>& some) -> std::optional<detail::SubFit> {
    const auto part = make_factor_design(counts.size(), factors, some);
    if (!part) return std::nullopt;
    const auto fitted = detail::fit_poisson(detail::count_data(counts, {}, *part));
    if (!fitted) return std::nullopt;
    return detail::SubFit{fitted->log_likelihood, part->kept.size()};
  };
  const auto f_test_of = [&](double statistic, double df) {
    const double f = statistic / df / result.dispersion;
    return TestResult{"F", f, {df, residual_df}, f_upper(f, df, residual_df)};
  };
  for (std::size_t t = 0; t < design->terms.size(); ++t)
    result.term_tests.push_back(detail::type_two_test(*design, t, sub_fit, f_test_of));
  const Eigen::MatrixXd covariance = result.dispersion * detail::covariance_of(data, *fit);
  result.fixed = make_fixed_effects(
      *design, {fit->coefficients.data(), static_cast<std::size_t>(fit->coefficients.size())},
      {covariance.data(), static_cast<std::size_t>(covariance.size())},
      [residual_df](std::span<const double>) { return residual_df; }, Link::kLog);
  return result;
}

}  // namespace kith
