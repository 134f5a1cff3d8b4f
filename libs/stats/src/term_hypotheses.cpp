#include "term_hypotheses.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "inference.hpp"
#include "kith/stats/distributions.hpp"

namespace kith::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index at(std::size_t i) { return static_cast<Index>(i); }

bool contains_other(const std::vector<std::size_t>& whole, const std::vector<std::size_t>& part) {
  return whole.size() > part.size() && std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

// Positions among the kept columns for whose term `take` holds; the intercept's is terms.size().
template <typename Take>
std::vector<Index> kept_of(const FactorDesign& design, Take take) {
  std::vector<Index> positions;
  for (std::size_t k = 0; k < design.kept.size(); ++k) {
    if (take(design.term_of[design.kept[k]])) positions.push_back(at(k));
  }
  return positions;
}

std::vector<Index> columns_of_term(const FactorDesign& design, std::size_t term) {
  return kept_of(design, [term](std::size_t other) { return other == term; });
}

std::vector<Index> columns_containing(const FactorDesign& design, std::size_t term) {
  return kept_of(design, [&](std::size_t other) {
    return other < design.terms.size() && contains_other(design.terms[other], design.terms[term]);
  });
}

// Which combination of the levels of a term's factors a cell has.
std::size_t combination_of(const FactorDesign& design, std::size_t term, std::size_t cell) {
  const auto levels = levels_of_cell(design, cell);
  std::size_t combination = 0;
  for (const auto factor : design.terms[term])
    combination = combination * design.factors[factor].levels.size() + levels[factor];
  return combination;
}

std::size_t num_combinations_of(const FactorDesign& design, std::size_t term) {
  std::size_t product = 1;
  for (const auto factor : design.terms[term]) product *= design.factors[factor].levels.size();
  return product;
}

// SAS's type III functions of all terms: row k, column j is the weight of the kept coefficient k in the j-th function;
// those of a term are its columns.
MatrixXd type_three_functions(const FactorDesign& design) {
  const auto p = design.columns.size();
  // The indicators of the intercept and of every combination of levels of every term, in the observed cells.
  std::vector<Index> first{1};
  for (std::size_t t = 0; t < design.terms.size(); ++t)
    first.push_back(first.back() + at(num_combinations_of(design, t)));
  const MatrixXd columns = observed_columns(design);
  MatrixXd indicators = MatrixXd::Zero(columns.rows(), first.back());
  Index row = 0;
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    if (design.counts[c] == 0) continue;
    indicators(row, 0) = 1.0;
    for (std::size_t t = 0; t < design.terms.size(); ++t)
      indicators(row, first[t] + at(combination_of(design, t, c))) = 1.0;
    ++row;
  }
  // Coefficients of the indicators' parametrisation as functions of the kept ones: columns * map = indicators.
  MatrixXd functions = columns.householderQr().solve(indicators).transpose();

  std::vector<std::size_t> by_order(design.terms.size());
  for (std::size_t t = 0; t < by_order.size(); ++t) by_order[t] = t;
  std::stable_sort(by_order.begin(), by_order.end(),
                   [&](std::size_t a, std::size_t b) { return design.terms[a].size() > design.terms[b].size(); });
  for (const auto term : by_order) {
    const auto own = columns_of_term(design, term);
    const auto above = columns_containing(design, term);
    if (own.empty() || above.empty()) continue;
    const MatrixXd basis = functions(Eigen::all, above);
    const MatrixXd rest = functions(Eigen::all, own);
    functions(Eigen::all, own) = rest - basis * basis.colPivHouseholderQr().solve(rest);
  }

  // Only the rows of indicators that are kept columns as well.
  MatrixXd weights(at(design.kept.size()), at(design.kept.size()));
  for (std::size_t k = 0; k < design.kept.size(); ++k) {
    const auto column = design.kept[k];
    const auto term = design.term_of[column];
    Index indicator = 0;
    if (term < design.terms.size()) {
      std::size_t cell = 0;
      while (design.grid[cell * p + column] != 1.0) ++cell;
      indicator = first[term] + at(combination_of(design, term, cell));
    }
    weights.row(at(k)) = functions.row(indicator);
  }
  return weights;
}

}  // namespace

std::string term_name(const FactorDesign& design, std::size_t term) {
  std::string name;
  for (const auto factor : design.terms[term]) name += (name.empty() ? "" : ":") + design.factors[factor].name;
  return name;
}

MatrixXd observed_columns(const FactorDesign& design) {
  const auto cells =
      design.counts.size() - static_cast<std::size_t>(std::count(design.counts.begin(), design.counts.end(), 0u));
  MatrixXd columns(at(cells), at(design.kept.size()));
  Index row = 0;
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    if (design.counts[c] == 0) continue;
    for (std::size_t k = 0; k < design.kept.size(); ++k)
      columns(row, at(k)) = design.grid[c * design.columns.size() + design.kept[k]];
    ++row;
  }
  return columns;
}

MatrixXd term_hypothesis(const FactorDesign& design, std::size_t term, SumsOfSquares type) {
  const auto own = columns_of_term(design, term);
  if (own.empty()) return MatrixXd(0, at(design.kept.size()));
  if (design.terms.size() > 1) {
    if (type == SumsOfSquares::kTypeIII) return type_three_functions(design)(Eigen::all, own).transpose();
    if (columns_containing(design, term).empty())
      return MatrixXd::Identity(at(design.kept.size()), at(design.kept.size()))(own, Eigen::all);
  }
  // The term's rows of the products of all columns, swept by those of the terms that do not contain it and by one
  // another, as lmerTest has them.
  const MatrixXd columns = observed_columns(design);
  VectorXd counts(columns.rows());
  Index row = 0;
  for (const auto count : design.counts) {
    if (count > 0) counts(row++) = static_cast<double>(count);
  }
  const MatrixXd products = columns.transpose() * counts.asDiagonal() * columns;
  const auto others = kept_of(design, [&](std::size_t other) {
    return other == design.terms.size() || (other != term && !contains_other(design.terms[other], design.terms[term]));
  });
  const MatrixXd among_others = products(others, others);
  const MatrixXd with_others = products(others, own);
  MatrixXd hypothesis = products(own, Eigen::all);
  hypothesis -= with_others.transpose() * among_others.ldlt().solve(MatrixXd{products(others, Eigen::all)});
  for (const auto other : others) hypothesis.col(other).setZero();
  for (Index i = 0; i < at(own.size()); ++i) {
    const auto pivot = own[static_cast<std::size_t>(i)];
    hypothesis.row(i) /= hypothesis(i, pivot);
    for (Index below = i + 1; below < at(own.size()); ++below)
      hypothesis.row(below) -= hypothesis(below, pivot) * hypothesis.row(i);
  }
  return hypothesis;
}

TermTest satterthwaite_test(std::string name, const MatrixXd& hypothesis, const VectorXd& coefficients,
                            const MatrixXd& covariance, const std::function<double(const VectorXd&)>& df) {
  constexpr double kNoVariance = 1.5e-8;  // lmerTest's
  constexpr double kEqual = 1e-8;         // lmerTest's
  TermTest result{std::move(name)};
  if (hypothesis.rows() == 0) {
    result.test = Estimable<TestResult>::impossible(
        "combinations of levels without observations leave nothing of it to estimate");
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen{hypothesis * covariance * hypothesis.transpose()};
  const double largest = eigen.eigenvalues().maxCoeff();
  std::vector<double> dfs;
  double sum = 0.0;
  for (Index i = 0; i < eigen.eigenvalues().size(); ++i) {
    if (eigen.eigenvalues()(i) <= kNoVariance * largest) continue;
    const VectorXd combination = hypothesis.transpose() * eigen.eigenvectors().col(i);
    const double estimate = combination.dot(coefficients);
    sum += estimate * estimate / eigen.eigenvalues()(i);
    dfs.push_back(df(combination));
  }
  result.df = dfs.size();
  if (dfs.empty()) {
    result.test = Estimable<TestResult>::impossible("its effects have no standard error");
    return result;
  }
  const auto q = static_cast<double>(dfs.size());
  const auto [least, most] = std::minmax_element(dfs.begin(), dfs.end());
  double denominator = dfs.front();
  if (*most - *least > kEqual) {
    double mean_of_f = 0.0;
    for (const double nu : dfs) mean_of_f += std::isinf(nu) ? 1.0 : nu / (nu - 2.0);
    denominator = *least <= 2.0 ? 2.0 : 2.0 * mean_of_f / (mean_of_f - q);
  }
  const double f = sum / q;
  result.test = TestResult{"F", f, {q, denominator}, f_upper(f, q, denominator)};
  return result;
}

}  // namespace kith::detail
