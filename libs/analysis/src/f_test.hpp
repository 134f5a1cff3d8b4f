#pragma once

#include <cstddef>
#include <string>

#include "kith/analysis/anova.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {

// The part of a sum of squares of `n` standardised values that their rounding explains: what is not above it is no
// spread at all, and a ratio to it says nothing.
[[nodiscard]] inline double negligible_sum_of_squares(double rounding, std::size_t n) {
  const double unit = 4.0 * rounding;
  return static_cast<double>(n) * unit * unit;
}

// F(df, residual_df) of two sums of squares; both df and the residual sum of squares are > 0.
[[nodiscard]] inline TestResult f_test(double sum_of_squares, double df, double residual, double residual_df) {
  const double f = (sum_of_squares / df) / (residual / residual_df);
  return {"F", f, {df, residual_df}, f_upper(f, df, residual_df)};
}

// Fills in the test and the effect size of a term whose name and df are known, or why there are none.
inline void test_term(AnovaTerm& term, double sum_of_squares, double residual, std::size_t residual_df,
                      const std::string& reason) {
  if (!reason.empty()) {
    term.test = Estimable<TestResult>::impossible(reason);
    term.partial_eta_squared = Estimable<double>::impossible(reason);
    return;
  }
  term.test = f_test(sum_of_squares, static_cast<double>(term.df), residual, static_cast<double>(residual_df));
  term.partial_eta_squared = sum_of_squares / (sum_of_squares + residual);
}

}  // namespace kith
