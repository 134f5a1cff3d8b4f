#include "mixed_deviance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "term_hypotheses.hpp"

namespace kith::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::SparseMatrix;
using Eigen::VectorXd;

Index index_from(std::size_t i) { return static_cast<Index>(i); }

// Numbers of the combinations of a code so far and a level, in the order of first appearance.
std::size_t refine(std::vector<std::size_t>& codes, std::span<const std::size_t> levels, std::size_t num_levels) {
  std::unordered_map<std::size_t, std::size_t> number_of;
  number_of.reserve(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i)
    codes[i] = number_of.emplace(codes[i] * num_levels + levels[i], number_of.size()).first->second;
  return number_of.size();
}

}  // namespace

MixedDeviance::MixedDeviance(const FactorDesign& design, std::span<const double> values, std::span<const Factor> groups,
                             bool reml)
    : reml_{reml}, columns_{observed_columns(design)} {
  // Cells without observations have no row in `columns_`.
  std::vector<std::size_t> observed_cell(design.counts.size(), 0);
  std::size_t num_observed = 0;
  for (std::size_t c = 0; c < design.counts.size(); ++c) observed_cell[c] = design.counts[c] > 0 ? num_observed++ : 0;
  std::vector<std::size_t> row_of(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) row_of[i] = observed_cell[design.cell_of[i]];
  std::size_t num_rows = 0;
  first_.push_back(0);
  for (const auto& group : groups) {
    num_rows = refine(row_of, group.codes, group.levels.size());
    first_.push_back(first_.back() + index_from(group.levels.size()));
  }
  rows_.resize(num_rows);
  groups_of_.resize(num_rows * groups.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    auto& row = rows_[row_of[i]];
    if (row.count == 0.0) {
      row.cell = index_from(observed_cell[design.cell_of[i]]);
      for (std::size_t k = 0; k < groups.size(); ++k)
        groups_of_[row_of[i] * groups.size() + k] = first_[k] + index_from(groups[k].codes[i]);
    }
    row.count += 1.0;
    row.mean += values[i];
  }
  for (auto& row : rows_) row.mean /= row.count;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = values[i] - rows_[row_of[i]].mean;
    within_ += difference * difference;
  }
  observations_ = static_cast<double>(values.size());
  degrees_of_freedom_ = observations_ - (reml ? static_cast<double>(columns_.cols()) : 0.0);

  const auto q = first_.back();
  cross_products_ = MatrixXd::Zero(q, columns_.cols());
  VectorXd cell_counts = VectorXd::Zero(columns_.rows());
  VectorXd cell_sums = VectorXd::Zero(columns_.rows());
  sums_ = VectorXd::Zero(q);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(rows_.size() * groups.size() * (groups.size() + 1) / 2);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const auto& row = rows_[r];
    cell_counts(row.cell) += row.count;
    cell_sums(row.cell) += row.count * row.mean;
    for (std::size_t k = 0; k < groups.size(); ++k) {
      const auto g = groups_of_[r * groups.size() + k];
      cross_products_.row(g) += row.count * columns_.row(row.cell);
      sums_(g) += row.count * row.mean;
      for (std::size_t l = 0; l <= k; ++l)
        entries.emplace_back(static_cast<int>(g), static_cast<int>(groups_of_[r * groups.size() + l]), row.count);
    }
  }
  products_.resize(q, q);
  products_.setFromTriplets(entries.begin(), entries.end());
  fixed_products_ = columns_.transpose() * cell_counts.asDiagonal() * columns_;
  fixed_sums_ = columns_.transpose() * cell_sums;
  system_ = products_;
  solver_.analyzePattern(system_);
}

bool MixedDeviance::is_confounded(std::size_t k) const {
  constexpr double kRounding = 1e-9;
  const Eigen::LDLT<MatrixXd> decomposed{fixed_products_};
  for (auto g = first_[k]; g < first_[k + 1]; ++g) {
    const VectorXd products = cross_products_.row(g);  // X'z
    const double size = products_.coeff(g, g);
    if (size - products.dot(decomposed.solve(products)) > kRounding * size) return false;
  }
  return true;
}

MixedDeviance::Value MixedDeviance::evaluate(const VectorXd& tau) {
  tau_ = tau;
  scale_.resize(first_.back());
  for (std::size_t k = 0; k < num_groupings(); ++k)
    scale_.segment(first_[k], first_[k + 1] - first_[k]).setConstant(std::sqrt(tau(index_from(k))));
  for (Index column = 0; column < products_.outerSize(); ++column) {
    SparseMatrix<double>::InnerIterator source{products_, column};
    for (SparseMatrix<double>::InnerIterator entry{system_, column}; entry; ++entry, ++source)
      entry.valueRef() = scale_(entry.row()) * scale_(column) * source.value() + (entry.row() == column ? 1.0 : 0.0);
  }
  solver_.factorize(system_);

  const MatrixXd scaled_columns = scale_.asDiagonal() * cross_products_;
  solved_columns_ = solver_.solve(scaled_columns);
  const MatrixXd information = fixed_products_ - scaled_columns.transpose() * solved_columns_;
  const Eigen::LDLT<MatrixXd> decomposed{information};
  Value value;
  value.coefficients =
      decomposed.solve(fixed_sums_ - solved_columns_.transpose() * VectorXd{scale_.asDiagonal() * sums_});
  value.unscaled_covariance = decomposed.solve(MatrixXd::Identity(information.rows(), information.cols()));
  effects_ = solver_.solve(VectorXd{scale_.cwiseProduct(sums_ - cross_products_ * value.coefficients)});

  // Residuals row by row, as differences of sums of squares would lose digits.
  const VectorXd means = columns_ * value.coefficients;
  const VectorXd shifts = scale_.cwiseProduct(effects_);
  value.sum_of_squares = within_ + effects_.squaredNorm();
  const auto k = num_groupings();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    double residual = rows_[r].mean - means(rows_[r].cell);
    for (std::size_t i = 0; i < k; ++i) residual -= shifts(groups_of_[r * k + i]);
    value.sum_of_squares += rows_[r].count * residual * residual;
  }
  value.variance = value.sum_of_squares / degrees_of_freedom_;
  value.deviance = degrees_of_freedom_ * (1.0 + std::log(2.0 * std::numbers::pi * value.variance)) +
                   solver_.vectorD().array().log().sum();
  if (reml_) value.deviance += decomposed.vectorD().array().log().sum();
  return value;
}

// The entries of inverse(A) on the diagonal, from those where L has entries (Takahashi's equations): with A = LDL' and
// Z = inverse(A), column by column from the last, Z_ij = [i = j] / D_j - sum_{k > j} L_kj Z_ik.
VectorXd MixedDeviance::inverse_diagonal() const {
  const auto& lower = solver_.matrixL().nestedExpression();  // without the diagonal of ones
  const auto& pivots = solver_.vectorD();
  const auto q = lower.cols();
  const auto* starts = lower.outerIndexPtr();
  const auto* rows = lower.innerIndexPtr();
  const auto* values = lower.valuePtr();
  std::vector<double> inverse(static_cast<std::size_t>(starts[q]));
  VectorXd diagonal(q);
  std::vector<int> position(static_cast<std::size_t>(q), -1);  // of a row among those of the current column
  std::vector<double> column;
  for (Index j = q; j-- > 0;) {
    const Index begin = starts[j];
    const Index size = starts[j + 1] - begin;
    column.assign(static_cast<std::size_t>(size), 0.0);
    for (Index a = 0; a < size; ++a) position[static_cast<std::size_t>(rows[begin + a])] = static_cast<int>(a);
    for (Index a = 0; a < size; ++a) {
      const auto k = rows[begin + a];
      column[static_cast<std::size_t>(a)] -= values[begin + a] * diagonal(k);
      for (int entry = starts[k]; entry < starts[k + 1]; ++entry) {
        const int b = position[static_cast<std::size_t>(rows[entry])];
        if (b < 0) continue;
        const double z = inverse[static_cast<std::size_t>(entry)];
        column[static_cast<std::size_t>(b)] -= values[begin + a] * z;
        column[static_cast<std::size_t>(a)] -= values[begin + b] * z;
      }
    }
    diagonal(j) = 1.0 / pivots(j);
    for (Index a = 0; a < size; ++a) {
      diagonal(j) -= values[begin + a] * column[static_cast<std::size_t>(a)];
      inverse[static_cast<std::size_t>(begin + a)] = column[static_cast<std::size_t>(a)];
      position[static_cast<std::size_t>(rows[begin + a])] = -1;
    }
  }
  return solver_.permutationPinv() * diagonal;
}

MixedDeviance::Derivatives MixedDeviance::differentiate(const Value& value) const {
  const auto num = index_from(num_groupings());
  const auto p = columns_.cols();
  Derivatives derivatives{VectorXd::Zero(num), VectorXd::Zero(num), MatrixXd::Zero(num, num), {}};
  derivatives.cross.assign(num_groupings(), MatrixXd::Zero(p, p));
  const VectorXd diagonal = inverse_diagonal();
  std::vector<VectorXd> solved(num_groupings());   // inverse(A) Lambda Z'v_k, v_k = Z_k Z_k'Py
  std::vector<VectorXd> through(num_groupings());  // X'inverse(H) v_k
  std::vector<VectorXd> sums(num_groupings());     // Z_k'Py
  for (std::size_t k = 0; k < num_groupings(); ++k) {
    const double tau = tau_(index_from(k));
    if (tau == 0.0) continue;
    const auto size = first_[k + 1] - first_[k];
    // Lambda Z'inverse(H) = inverse(A) Lambda Z', so Z_k'Py and Z_k'inverse(H)X are parts of what was solved for, over
    // sqrt(tau).
    const auto rows = solved_columns_.middleRows(first_[k], size);
    derivatives.cross[k] = rows.transpose() * rows / tau;
    derivatives.traces(index_from(k)) = (static_cast<double>(size) - of_grouping(diagonal, k).sum()) / tau;
    if (reml_) derivatives.traces(index_from(k)) -= derivatives.cross[k].cwiseProduct(value.unscaled_covariance).sum();
    sums[k] = of_grouping(effects_, k) / std::sqrt(tau);
    derivatives.squares(index_from(k)) = sums[k].squaredNorm();
    VectorXd whole = VectorXd::Zero(first_.back());
    whole.segment(first_[k], size) = sums[k];
    const VectorXd products = products_.selfadjointView<Eigen::Lower>() * whole;
    solved[k] = solver_.solve(VectorXd{scale_.cwiseProduct(products)});
    through[k] = cross_products_.transpose() * (whole - scale_.cwiseProduct(solved[k]));
  }
  for (std::size_t k = 0; k < num_groupings(); ++k) {
    if (tau_(index_from(k)) == 0.0) continue;
    for (std::size_t l = 0; l <= k; ++l) {
      if (tau_(index_from(l)) == 0.0) continue;
      const double product = sums[k].dot(of_grouping(solved[l], k)) / std::sqrt(tau_(index_from(k))) -
                             through[k].dot(value.unscaled_covariance * through[l]);
      derivatives.average_information(index_from(k), index_from(l)) = product;
      derivatives.average_information(index_from(l), index_from(k)) = product;
    }
  }
  return derivatives;
}

}  // namespace kith::detail
