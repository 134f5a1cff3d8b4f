#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/term_test.hpp"

namespace kith::detail {

// What a test of type II needs of a fitted model.
struct SubFit {
  double log_likelihood = 0.0;
  std::size_t parameters = 0;
};

// Compares the models of all terms that do not contain `term`, with it and without it.
// @param fit   fits a model with these terms; nothing if it has no fit.
// @param test  of twice the difference of the log-likelihoods, and the term's degrees of freedom.
[[nodiscard]] TermTest type_two_test(
    const FactorDesign& design, std::size_t term,
    const std::function<std::optional<SubFit>(const std::vector<std::vector<std::size_t>>& terms)>& fit,
    const std::function<TestResult(double statistic, double df)>& test);

// The likelihood-ratio test: chi-squared.
[[nodiscard]] TestResult likelihood_ratio_test(double statistic, double df);

}  // namespace kith::detail
