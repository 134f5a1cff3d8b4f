#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <cstddef>
#include <span>
#include <vector>

#include "kith/stats/factor.hpp"
#include "kith/stats/fixed_effects.hpp"

namespace kith::detail {

// What a mixed model asks of the data, and its deviance at given ratios of variances.
//
// Notation of lme4: y = X beta + sum_k Z_k b_k + e, tau_k = var(b_k) / var(e), Lambda = diag(sqrt(tau_k)),
// A = Lambda Z'Z Lambda + I. H = I + Z Lambda^2 Z' is the covariance of y over var(e), C = inverse(X'inverse(H)X) and
// P = inverse(H) - inverse(H) X C X'inverse(H).
class MixedDeviance {
 public:
  struct Row {  // Observations that share cell and groups.
    Eigen::Index cell = 0;
    double count = 0.0;
    double mean = 0.0;  // of the standardised response
  };
  struct Value {
    double deviance = 0.0;                // -2 log-likelihood with var(e) profiled out, of the standardised response
    double sum_of_squares = 0.0;          // y'Py
    double variance = 0.0;                // of e
    Eigen::VectorXd coefficients;         // of the standardised response
    Eigen::MatrixXd unscaled_covariance;  // C
  };
  struct Derivatives {
    Eigen::VectorXd traces;               // tr(Z_k'PZ_k); with maximum likelihood tr(Z_k'inverse(H)Z_k)
    Eigen::VectorXd squares;              // |Z_k'Py|^2
    Eigen::MatrixXd average_information;  // y'P V_k P V_l P y, V_k = Z_k Z_k'
    std::vector<Eigen::MatrixXd> cross;   // X'inverse(H) V_k inverse(H) X
  };

  // Groups have no unused levels. `values` are the response.
  MixedDeviance(const FactorDesign& design, std::span<const double> values, std::span<const Factor> groups, bool reml);

  [[nodiscard]] std::size_t num_groupings() const noexcept { return first_.size() - 1; }
  [[nodiscard]] double degrees_of_freedom() const noexcept { return degrees_of_freedom_; }
  // Whether the decomposition is small enough to be computed again and again.
  [[nodiscard]] bool is_feasible() const { return solver_.work() <= kMostWork; }

  // Whether the fixed effects already tell the groups of a grouping apart: the columns of Z_k are in the span of X.
  [[nodiscard]] bool is_confounded(std::size_t k) const;

  // tau >= 0, one per grouping.
  [[nodiscard]] Value evaluate(const Eigen::VectorXd& tau);
  // At the tau of the latest evaluate(). Entries of groupings with tau = 0 are 0.
  [[nodiscard]] Derivatives differentiate(const Value& value) const;

 private:
  // Sum of squared lengths of the columns of the decomposition: some seconds per step.
  static constexpr double kMostWork = 1e9;

  class Solver : public Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
   public:
    [[nodiscard]] double work() const { return m_nonZerosPerCol.cast<double>().squaredNorm(); }
  };

  [[nodiscard]] Eigen::VectorXd inverse_diagonal() const;
  [[nodiscard]] auto of_grouping(const Eigen::VectorXd& x, std::size_t k) const {
    return x.segment(first_[k], first_[k + 1] - first_[k]);
  }

  bool reml_;
  double observations_ = 0.0;
  double degrees_of_freedom_ = 0.0;
  double within_ = 0.0;  // sum of squares about the rows' means
  std::vector<Row> rows_;
  std::vector<Eigen::Index> groups_of_;   // [rows, groupings]: index of the random effect
  std::vector<Eigen::Index> first_;       // [groupings + 1]: of each grouping's random effects
  Eigen::MatrixXd columns_;               // [cells, p]: rows of X
  Eigen::SparseMatrix<double> products_;  // Z'Z, lower triangle
  Eigen::MatrixXd cross_products_;        // Z'X
  Eigen::MatrixXd fixed_products_;        // X'X
  Eigen::VectorXd sums_;                  // Z'y
  Eigen::VectorXd fixed_sums_;            // X'y

  // At the latest tau.
  Eigen::VectorXd tau_;
  Eigen::VectorXd scale_;  // diagonal of Lambda
  Solver solver_;
  Eigen::SparseMatrix<double> system_;  // A, lower triangle
  Eigen::MatrixXd solved_columns_;      // inverse(A) Lambda Z'X
  Eigen::VectorXd effects_;             // u = inverse(A) Lambda Z'(y - X beta)
};

}  // namespace kith::detail
