#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/anova.hpp"
#include "kith/analysis/factor.hpp"

namespace kith {

// A response that is centred and scaled by a power of two, so that sums of squares of any data neither overflow nor
// lose digits: original value = centre + ldexp(values[i], exponent).
struct StandardizedResponse {
  std::vector<double> values;  // Largest size in [1/2, 1], or all 0.
  double centre = 0.0;
  int exponent = 0;
  double rounding = 0.0;  // What a value may be off by, being a rounded number; in units of `values`.
};
// The values must be finite and may be none.
[[nodiscard]] StandardizedResponse standardize(std::span<const double> response);

// Means and spread of the cells, all that a model of factors asks of a response.
struct CellMoments {
  Eigen::VectorXd weighted_means;  // z: mean * sqrt(count) per cell, which is sum / sqrt(count)
  double within = 0.0;             // Sum of squares of the differences from the cells' means.
};

// A linear model whose terms are factors and their interactions.
//
// A cell is a combination of levels that some observation has. The model is fitted by weighted least squares to the
// cells' means; every sum of squares is the squared length of the projection of z onto an orthonormal basis.
class CellModel {
 public:
  struct Term {
    std::string name;       // "strategy:composition"
    std::size_t df = 0;     // Rank that the term adds to the model without it.
    std::string reason;     // Why the term cannot be tested whatever the response is; empty if it can.
    Eigen::MatrixXd basis;  // Of what the term adds: shape [cells, df], orthonormal columns.
  };

  // Levels without observations do not count. Throws std::invalid_argument for codes that are no levels, for factors
  // of other lengths than `observations`, and for terms that name no factor.
  CellModel(std::size_t observations, std::span<const Factor> factors, std::span<const std::vector<std::size_t>> terms,
            SumsOfSquares type);

  [[nodiscard]] const std::vector<Term>& terms() const noexcept { return terms_; }
  [[nodiscard]] std::size_t observations() const noexcept { return cell_of_.size(); }
  [[nodiscard]] std::size_t num_cells() const noexcept { return counts_.size(); }
  [[nodiscard]] const std::vector<std::size_t>& cell_of() const noexcept { return cell_of_; }  // [observations]
  [[nodiscard]] std::size_t empty_cells() const noexcept { return empty_cells_; }
  [[nodiscard]] bool balanced() const noexcept;
  [[nodiscard]] std::size_t residual_df() const noexcept { return residual_df_; }
  // The model fits every cell's mean: as many columns as cells.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }
  // Why nothing can be fitted: no observations, or too many cells and columns for dense matrices. Empty if it can.
  [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

  // Two passes that keep all digits of a standardised response.
  [[nodiscard]] CellMoments summarize(std::span<const double> values) const;

  [[nodiscard]] double term_sum_of_squares(std::size_t term, const Eigen::VectorXd& z) const {
    return (terms_[term].basis.transpose() * z).squaredNorm();
  }
  // What the cells' means vary beyond the model: with `within` it makes the residual sum of squares.
  [[nodiscard]] double lack_of_fit(const Eigen::VectorXd& z) const;
  // The cells' means that the model expects; shape [cells].
  [[nodiscard]] Eigen::VectorXd fitted(const Eigen::VectorXd& z) const;

 private:
  // Finds the bases of the model and of its terms. `columns` are those of each term, `sets` their factors.
  void decompose(const std::vector<Eigen::MatrixXd>& columns, const std::vector<std::vector<std::size_t>>& sets,
                 SumsOfSquares type);

  std::vector<Term> terms_;
  std::vector<std::size_t> cell_of_;
  std::vector<std::size_t> counts_;
  Eigen::VectorXd root_counts_;
  Eigen::MatrixXd basis_;  // Of the whole model: shape [cells, rank].
  std::size_t empty_cells_ = 0;
  std::size_t residual_df_ = 0;
  bool saturated_ = false;
  std::string reason_;
};

}  // namespace kith
