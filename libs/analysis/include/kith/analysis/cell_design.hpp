#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"

namespace kith {

/// The cells of a design with one factor, or with several crossed ones whose combinations of levels all have the same
/// number of observations. Then all terms are orthogonal, and sums of squares of all types are the same.
///
/// Cells are numbered by their levels, the last factor fastest.
struct CellDesign {
  std::vector<Factor> factors;                  ///< With the levels that have observations.
  std::vector<std::vector<std::size_t>> terms;  ///< Ascending indices of `factors`.
  std::vector<std::size_t> counts;              ///< [cells]: observations.
  std::vector<std::size_t> cell_of;             ///< [observations]

  [[nodiscard]] std::size_t level(std::size_t cell, std::size_t factor) const;
  [[nodiscard]] bool is_balanced() const;
  /// Degrees of freedom of a term, and of the mean and all terms together.
  [[nodiscard]] std::size_t df(std::size_t term) const;
  [[nodiscard]] std::size_t model_df() const;
  /// What the factors of `set` together add to values of the cells: weighted means over the levels of all others, less
  /// what parts of the set add. The mean for an empty set. @param values  [cells]
  [[nodiscard]] std::vector<double> effect(const std::vector<std::size_t>& set, std::vector<double> values) const;
  /// The cells' means that the model expects, by those that were observed.
  [[nodiscard]] std::vector<double> fitted(const std::vector<double>& means) const;
  /// The weights of observed means that make the same sum as these weights of fitted ones.
  [[nodiscard]] std::vector<double> weights_of_observed(const std::vector<double>& weights) const;
};

/// "strategy:composition"
[[nodiscard]] std::string term_name(const std::vector<std::size_t>& term, std::span<const Factor> factors);

/// Not estimable without observations, or if combinations of levels have different numbers of them.
/// @param factors  one code per observation each. @param terms  sets of indices of `factors`.
/// @throws std::invalid_argument if a factor has another number of codes, a code is no level, a term names no factor,
/// or a part of it is no term.
[[nodiscard]] Estimable<CellDesign> make_cell_design(std::size_t observations, std::span<const Factor> factors,
                                                     std::span<const std::vector<std::size_t>> terms);

}  // namespace kith
