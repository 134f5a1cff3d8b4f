#include "kith/stats/resampling.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "cell_model.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

// Sums of squares are known to about this part of the total one: permutations that deal the same values to the cells
// are ties, whatever the order in which the values were added.
constexpr double kRounding = 1e-12;

// A term's residuals of the model without it, and what its F is made of.
struct PermutedTerm {
  std::size_t term = 0;  // in CellModel::terms
  double total = 0.0;    // sum of squares of the residuals, which no permutation changes
  double effect = 0.0;   // of the term, in the data
  double error = 0.0;    // of the residuals of the whole model, in the data
  std::size_t at_least = 0;

  // F* >= F without division: effect* / error* >= effect / error.
  void count(double permuted_effect, double permuted_error) {
    if (permuted_effect * error >= effect * permuted_error - kRounding * total * total) ++at_least;
  }
};

class Permutations {
 public:
  Permutations(const CellModel& model, std::span<const double> values, const std::vector<std::size_t>& terms)
      : model_{model}, labels_(model.cell_of().begin(), model.cell_of().end()) {
    const auto z = model.summarize(values).weighted_means;
    residuals_.resize(static_cast<Eigen::Index>(terms.size()), static_cast<Eigen::Index>(values.size()));
    for (std::size_t t = 0; t < terms.size(); ++t) {
      const Eigen::VectorXd fitted = model.fitted_without(terms[t], z);
      for (std::size_t i = 0; i < values.size(); ++i)
        residuals_(row_of(t), row_of(i)) = values[i] - fitted[row_of(model.cell_of()[i])];
      terms_.push_back({terms[t], residuals_.row(row_of(t)).squaredNorm()});
    }
    visit([](PermutedTerm& term, double effect, double error) {
      term.effect = effect;
      term.error = error;
    });
  }

  // Shuffling the cells among the residuals is shuffling the residuals among the cells (Fisher and Yates).
  void permute(RandomStream& random) {
    for (std::size_t left = labels_.size(); left > 1; --left)
      std::swap(labels_[left - 1], labels_[uniform_index(left, random)]);
    visit([](PermutedTerm& term, double effect, double error) { term.count(effect, error); });
  }

  [[nodiscard]] const std::vector<PermutedTerm>& terms() const { return terms_; }

 private:
  static Eigen::Index row_of(std::size_t i) { return static_cast<Eigen::Index>(i); }

  // Sums of squares of each term's residuals as they are dealt to the cells now. What the model without
  // the term fits is left out: it lies in the space of the whole model but not in that of the term, so it
  // changes neither sum.
  template <typename Visitor>
  void visit(Visitor visitor) {
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(residuals_.rows(), row_of(model_.num_cells()));
    for (std::size_t i = 0; i < labels_.size(); ++i) sums.col(row_of(labels_[i])) += residuals_.col(row_of(i));
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      const Eigen::VectorXd of_term = sums.row(row_of(t));
      const auto z = model_.weighted_means({of_term.data(), model_.num_cells()});
      visitor(terms_[t], model_.term_sum_of_squares(terms_[t].term, z),
              std::max(0.0, terms_[t].total - model_.model_sum_of_squares(z)));
    }
  }

  const CellModel& model_;
  Eigen::MatrixXd residuals_;          // [terms, observations]
  std::vector<std::uint32_t> labels_;  // the cell of each residual
  std::vector<PermutedTerm> terms_;
};

}  // namespace

AnovaTable permutation_anova(std::span<const double> response, std::span<const Factor> factors,
                             std::span<const std::vector<std::size_t>> terms, SumsOfSquares type,
                             std::size_t permutations, RandomStream random) {
  if (permutations == 0) throw std::invalid_argument{"permutation_anova: at least one permutation is needed"};
  auto table = anova(response, factors, terms, type);
  std::vector<std::size_t> tested;
  for (std::size_t t = 0; t < table.terms.size(); ++t) {
    if (table.terms[t].test) tested.push_back(t);
  }
  if (tested.empty()) return table;
  const CellModel model{response.size(), factors, terms, type};
  Permutations permuted{model, standardize(response).values, tested};
  for (std::size_t i = 0; i < permutations; ++i) permuted.permute(random);
  for (const auto& term : permuted.terms()) {
    auto test = *table.terms[term.term].test;
    test.p = static_cast<double>(1 + term.at_least) / static_cast<double>(1 + permutations);
    table.terms[term.term].test = test;
  }
  return table;
}

}  // namespace kith
