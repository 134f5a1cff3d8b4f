#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>

#include "kith/stats/anova.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/term_test.hpp"

namespace kith::detail {

// "strategy:composition"
[[nodiscard]] std::string term_name(const FactorDesign& design, std::size_t term);

// Rows of the observed cells and the kept columns.
[[nodiscard]] Eigen::MatrixXd observed_columns(const FactorDesign& design);

// What a test of a term sets to zero: combinations of the kept columns' coefficients, one a row. Type II: the term's
// effects in the model of all terms that do not contain it. Type III: SAS's estimable functions, which for designs
// without empty cells are the term's sum-to-zero contrasts. As lmerTest's.
[[nodiscard]] Eigen::MatrixXd term_hypothesis(const FactorDesign& design, std::size_t term, SumsOfSquares type);

// F test that L beta = 0, with the denominator df that lmerTest finds from the df of the independent combinations that
// L V L' has as eigenvectors: their t^2 / q must have the mean of F.
[[nodiscard]] TermTest satterthwaite_test(std::string name, const Eigen::MatrixXd& hypothesis,
                                          const Eigen::VectorXd& coefficients, const Eigen::MatrixXd& covariance,
                                          const std::function<double(const Eigen::VectorXd&)>& df);

}  // namespace kith::detail
