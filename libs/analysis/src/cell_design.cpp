#include "kith/analysis/cell_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "kith/core/text.hpp"

#include "checks.hpp"

namespace kith {
namespace {

// As ascending sets, each of which names factors and has all of its parts beside it.
std::vector<std::vector<std::size_t>> checked_terms(std::span<const std::vector<std::size_t>> terms,
                                                    std::size_t num_factors) {
  std::vector<std::vector<std::size_t>> sets{terms.begin(), terms.end()};
  for (auto& term : sets) {
    std::sort(term.begin(), term.end());
    if (term.empty() || term.back() >= num_factors || std::adjacent_find(term.begin(), term.end()) != term.end())
      throw std::invalid_argument{"make_cell_design: every term must name one or more of the factors, none twice"};
  }
  for (const auto& term : sets) {
    for (const auto factor : term) {
      auto part = term;
      std::erase(part, factor);
      if (!part.empty() && std::find(sets.begin(), sets.end(), part) == sets.end())
        throw std::invalid_argument{"make_cell_design: the parts of every term must be terms"};
    }
  }
  return sets;
}

std::vector<double> shares_of(const Factor& factor) {
  std::vector<double> shares(factor.levels.size(), 0.0);
  for (const auto code : factor.codes) shares[code] += 1.0;
  for (auto& share : shares) share /= static_cast<double>(factor.codes.size());
  return shares;
}

// Replaces values by their weighted means over a factor, or by what is left of them without; transposed, weights of
// the results by those of the values.
void average(const CellDesign& design, std::size_t factor, bool rest, bool transposed, std::vector<double>& values) {
  const auto shares = shares_of(design.factors[factor]);
  std::size_t step = 1;
  for (auto f = factor + 1; f < design.factors.size(); ++f) step *= design.factors[f].levels.size();
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    if (design.level(cell, factor) != 0) continue;
    double sum = 0.0;
    for (std::size_t l = 0; l < shares.size(); ++l) sum += (transposed ? 1.0 : shares[l]) * values[cell + l * step];
    for (std::size_t l = 0; l < shares.size(); ++l) {
      auto& value = values[cell + l * step];
      const double mean = transposed ? shares[l] * sum : sum;
      value = rest ? value - mean : mean;
    }
  }
}

std::vector<double> projected(const CellDesign& design, const std::vector<std::size_t>& set, bool transposed,
                              std::vector<double> values) {
  for (std::size_t f = 0; f < design.factors.size(); ++f)
    average(design, f, std::find(set.begin(), set.end(), f) != set.end(), transposed, values);
  return values;
}

std::vector<double> through_model(const CellDesign& design, bool transposed, const std::vector<double>& values) {
  if (design.model_df() == design.counts.size()) return values;
  auto sum = projected(design, {}, transposed, values);
  for (const auto& term : design.terms) {
    const auto part = projected(design, term, transposed, values);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += part[c];
  }
  return sum;
}

}  // namespace

std::size_t CellDesign::level(std::size_t cell, std::size_t factor) const {
  for (auto f = factors.size(); --f > factor;) cell /= factors[f].levels.size();
  return cell % factors[factor].levels.size();
}

bool CellDesign::is_balanced() const {
  return std::all_of(counts.begin(), counts.end(), [&](std::size_t count) { return count == counts.front(); });
}

std::size_t CellDesign::df(std::size_t term) const {
  return std::accumulate(terms[term].begin(), terms[term].end(), std::size_t{1},
                         [&](std::size_t df, std::size_t factor) { return df * (factors[factor].levels.size() - 1); });
}

std::size_t CellDesign::model_df() const {
  std::size_t sum = 1;
  for (std::size_t t = 0; t < terms.size(); ++t) sum += df(t);
  return sum;
}

std::vector<double> CellDesign::effect(const std::vector<std::size_t>& set, std::vector<double> values) const {
  return projected(*this, set, false, std::move(values));
}

std::vector<double> CellDesign::fitted(const std::vector<double>& means) const {
  return through_model(*this, false, means);
}

std::vector<double> CellDesign::weights_of_observed(const std::vector<double>& weights) const {
  return through_model(*this, true, weights);
}

std::string term_name(const std::vector<std::size_t>& term, std::span<const Factor> factors) {
  return joined(term, ":", [&](std::size_t factor) { return factors[factor].name; });
}

Estimable<CellDesign> make_cell_design(std::size_t observations, std::span<const Factor> factors,
                                       std::span<const std::vector<std::size_t>> terms) {
  using Result = Estimable<CellDesign>;
  for (const auto& factor : factors) require_codes(factor, observations, "make_cell_design");
  CellDesign design{{}, checked_terms(terms, factors.size()), {}, std::vector<std::size_t>(observations, 0)};
  if (observations == 0) return Result::impossible("no observations");
  const std::string unbalanced = "the design is unbalanced: ";
  std::size_t cells = 1;
  for (const auto& factor : factors) {
    design.factors.push_back(drop_unused(factor));
    const auto& used = design.factors.back();
    cells *= used.levels.size();
    if (cells > observations) return Result::impossible(unbalanced + "combinations of levels have no observations");
    for (std::size_t i = 0; i < observations; ++i)
      design.cell_of[i] = design.cell_of[i] * used.levels.size() + used.codes[i];
  }

  design.counts.assign(cells, 0);
  for (const auto cell : design.cell_of) ++design.counts[cell];
  if (factors.size() < 2 || design.is_balanced()) return design;
  const auto [least, most] = std::minmax_element(design.counts.begin(), design.counts.end());
  return Result::impossible(unbalanced + (*least == 0 ? "combinations of levels have no observations"
                                                      : fmt::format("its cells have {} to {}", *least, *most)));
}

}  // namespace kith
