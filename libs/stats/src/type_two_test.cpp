#include "type_two_test.hpp"

#include <algorithm>

#include "kith/stats/distributions.hpp"
#include "term_hypotheses.hpp"

namespace kith::detail {

TermTest type_two_test(
    const FactorDesign& design, std::size_t term,
    const std::function<std::optional<SubFit>(const std::vector<std::vector<std::size_t>>& terms)>& fit,
    const std::function<TestResult(double statistic, double df)>& test) {
  const auto& own = design.terms[term];
  std::vector<std::vector<std::size_t>> with, without;
  for (const auto& other : design.terms) {
    const bool contains = std::includes(other.begin(), other.end(), own.begin(), own.end());
    if (!contains) without.push_back(other);
    if (!contains || other == own) with.push_back(other);
  }
  TermTest result{term_name(design, term)};
  const auto larger = fit(with), smaller = fit(without);
  if (!larger || !smaller) {
    result.test = Estimable<TestResult>::impossible("the model without it could not be fitted");
    return result;
  }
  result.df = larger->parameters - smaller->parameters;
  if (result.df == 0) {
    result.test = Estimable<TestResult>::impossible("its levels cannot be told apart from those of other terms");
    return result;
  }
  result.test =
      test(std::max(0.0, 2.0 * (larger->log_likelihood - smaller->log_likelihood)), static_cast<double>(result.df));
  return result;
}

TestResult likelihood_ratio_test(double statistic, double df) {
  return {"chi-squared", statistic, {df}, chi_squared_upper(statistic, df)};
}

}  // namespace kith::detail
