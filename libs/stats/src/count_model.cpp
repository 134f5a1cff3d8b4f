#include "kith/stats/count_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "count_fit.hpp"
#include "type_two_test.hpp"

namespace kith {
namespace {

bool is_count(double count) { return count >= 0.0 && std::isfinite(count) && count == std::floor(count); }

// Why these data define no model whatever the coefficients are; empty if nothing is wrong.
std::string fault_of(std::span<const double> counts, const std::vector<bool>& observed, const FactorDesign& design) {
  if (!std::ranges::all_of(counts, is_count)) return "counts must be whole numbers that are not negative";
  if (!observed.empty() && std::ranges::find(observed, true) == observed.end()) return "all counts are censored";
  if (std::ranges::all_of(counts, [](double count) { return count == 0.0; })) return "all counts are zero";
  if (counts.size() <= design.kept.size()) return "there are no more observations than coefficients";
  return {};
}

}  // namespace

Estimable<CountModel> fit_count_model(std::span<const double> counts, const std::vector<bool>& observed,
                                      std::span<const Factor> factors,
                                      std::span<const std::vector<std::size_t>> terms) {
  using Result = Estimable<CountModel>;
  if (!observed.empty() && counts.size() != observed.size())
    throw std::invalid_argument{"fit_count_model: one value per count that says whether it was observed"};
  const auto design = make_factor_design(counts.size(), factors, terms);
  if (!design) return Result::impossible(design.reason());
  if (const auto fault = fault_of(counts, observed, *design); !fault.empty()) return Result::impossible(fault);
  CountModel model;
  model.observations = counts.size();
  model.censored = static_cast<std::size_t>(std::ranges::count(observed, false));
  const auto data = detail::count_data(counts, observed, *design);
  if (detail::is_separated(data)) {
    return Result::impossible(std::string{"combinations of levels with only zeros"} +
                              (model.censored > 0 ? " or only censored counts" : "") +
                              " leave some ratios without a bound");
  }
  const auto fit = detail::fit_negative_binomial(data);
  if (!fit) return Result::impossible("the search for the largest likelihood did not end");
  if (std::isfinite(fit->theta)) model.theta = fit->theta;
  model.log_likelihood = fit->log_likelihood;
  const auto sub_fit = [&](const std::vector<std::vector<std::size_t>>& some) -> std::optional<detail::SubFit> {
    const auto part = make_factor_design(counts.size(), factors, some);
    if (!part) return std::nullopt;
    const auto fitted = detail::fit_negative_binomial(detail::count_data(counts, observed, *part));
    if (!fitted) return std::nullopt;
    return detail::SubFit{fitted->log_likelihood, part->kept.size()};
  };
  for (std::size_t t = 0; t < design->terms.size(); ++t)
    model.term_tests.push_back(detail::type_two_test(*design, t, sub_fit, detail::likelihood_ratio_test));
  const Eigen::MatrixXd covariance = detail::covariance_of(data, *fit);
  model.fixed = make_fixed_effects(
      *design, {fit->coefficients.data(), static_cast<std::size_t>(fit->coefficients.size())},
      {covariance.data(), static_cast<std::size_t>(covariance.size())},
      [](std::span<const double>) { return std::numeric_limits<double>::infinity(); }, Link::kLog);
  return model;
}

}  // namespace kith
