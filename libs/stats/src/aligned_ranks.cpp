#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/stats/resampling.hpp"
#include "kith/stats/tests.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostFactors = 4;
// Aligned values of a standardised response (largest size 1) that are this near to each other are tied: they differ
// by rounding.
constexpr double kTie = 1e-11;

// A table with one number per combination of levels, the first factor slowest.
struct CellTable {
  std::vector<std::size_t> num_levels;
  std::vector<double> values;
};

// Takes along one factor the means (`keep_means`), or the deviations from them.
CellTable along(const CellTable& table, std::size_t factor, bool keep_means) {
  const auto stride = std::accumulate(table.num_levels.begin() + static_cast<std::ptrdiff_t>(factor) + 1,
                                      table.num_levels.end(), std::size_t{1}, std::multiplies<>{});
  const auto num_levels = table.num_levels[factor];
  CellTable result = table;
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const auto first = i - (i / stride % num_levels) * stride;
    double sum = 0.0;
    for (std::size_t level = 0; level < num_levels; ++level) sum += table.values[first + level * stride];
    const double mean = sum / static_cast<double>(num_levels);
    result.values[i] = keep_means ? mean : table.values[i] - mean;
  }
  return result;
}

// The term's effect in each cell: deviations along its factors of the means over all others.
CellTable effect_of(const std::vector<std::size_t>& term, CellTable means) {
  for (std::size_t f = 0; f < means.num_levels.size(); ++f)
    means = along(means, f, !std::ranges::binary_search(term, f));
  return means;
}

// All sets of factors, by size and then by first factor.
std::vector<std::vector<std::size_t>> full_factorial(std::size_t num_factors) {
  std::vector<std::vector<std::size_t>> terms;
  for (std::size_t mask = 1; mask < (std::size_t{1} << num_factors); ++mask) {
    std::vector<std::size_t> term;
    for (std::size_t f = 0; f < num_factors; ++f) {
      if ((mask >> f & 1U) != 0) term.push_back(f);
    }
    terms.push_back(std::move(term));
  }
  std::ranges::sort(terms,
                    [](const auto& a, const auto& b) { return a.size() != b.size() ? a.size() < b.size() : a < b; });
  return terms;
}

// Gives values that differ by rounding only the smallest of them.
void unite_ties(std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  double previous = 0.0;  // as it was before
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double value = values[order[i]];
    if (i > 0 && value - previous <= kTie) values[order[i]] = values[order[i - 1]];
    previous = value;
  }
}

// A response apart: what the cells' means are, and what lies about them.
class Alignment {
 public:
  // Factors have no unused levels.
  Alignment(std::span<const double> response, std::span<const Factor> factors)
      : standardized_{standardize(response)}, cell_of_(response.size(), 0) {
    for (const auto& factor : factors) {
      means_.num_levels.push_back(factor.levels.size());
      for (std::size_t i = 0; i < cell_of_.size(); ++i)
        cell_of_[i] = cell_of_[i] * factor.levels.size() + factor.codes[i];
    }
    const auto cells =
        std::accumulate(means_.num_levels.begin(), means_.num_levels.end(), std::size_t{1}, std::multiplies<>{});
    std::vector<double> counts(cells, 0.0);
    means_.values.assign(cells, 0.0);
    for (std::size_t i = 0; i < cell_of_.size(); ++i) {
      counts[cell_of_[i]] += 1.0;
      means_.values[cell_of_[i]] += standardized_.values[i];
    }
    is_complete_ = !response.empty() && std::ranges::find(counts, 0.0) == counts.end();
    for (std::size_t c = 0; c < cells; ++c) means_.values[c] /= std::max(counts[c], 1.0);
  }

  [[nodiscard]] bool is_complete() const { return is_complete_; }  // No cell is empty.

  // The response with no effect but the term's. @pre is_complete().
  [[nodiscard]] std::vector<double> aligned_for(const std::vector<std::size_t>& term) const {
    const auto effect = effect_of(term, means_);
    std::vector<double> aligned;
    for (std::size_t i = 0; i < cell_of_.size(); ++i)
      aligned.push_back(standardized_.values[i] - means_.values[cell_of_[i]] + effect.values[cell_of_[i]]);
    unite_ties(aligned);
    for (auto& value : aligned) value = std::ldexp(value, standardized_.exponent);
    return aligned;
  }

 private:
  StandardizedResponse standardized_;
  std::vector<std::size_t> cell_of_;
  CellTable means_;
  bool is_complete_ = false;
};

std::vector<Factor> used_levels_of(const char* function, std::span<const double> response,
                                   std::span<const Factor> factors) {
  if (factors.empty() || factors.size() > kMostFactors)
    throw std::invalid_argument{std::string{function} + ": one to four factors are needed, not " +
                                std::to_string(factors.size())};
  require_finite(response, function);
  std::vector<Factor> used;
  for (const auto& factor : factors) {
    require_codes(factor, response.size(), function);
    used.push_back(drop_unused(factor));
  }
  return used;
}

// Puts the term's row of the analysis of the ranks into `row`.
void test_ranks(const CellModel& model, std::size_t term, std::span<const double> ranks, AnovaTerm& row) {
  const auto standardized = standardize(ranks);
  const auto cells = model.summarize(standardized.values);
  const double residual = cells.within + model.lack_of_fit(cells.weighted_means);
  auto reason = model.terms()[term].reason;
  if (reason.empty() && residual <= negligible_sum_of_squares(standardized.rounding, ranks.size()))
    reason = "no spread of the ranks within the cells";
  const double sum_of_squares = model.term_sum_of_squares(term, cells.weighted_means);
  row.sum_of_squares = std::ldexp(sum_of_squares, 2 * standardized.exponent);
  test_term(row, sum_of_squares, residual, model.residual_df(), reason);
}

constexpr auto kIncomplete = "a combination of levels has no observations, so that nothing can be aligned";

}  // namespace

Estimable<std::vector<double>> aligned_response(std::span<const double> response, std::span<const Factor> factors,
                                                std::vector<std::size_t> term) {
  const auto used = used_levels_of("aligned_response", response, factors);
  std::ranges::sort(term);
  term.erase(std::unique(term.begin(), term.end()), term.end());
  if (term.empty() || term.back() >= factors.size())
    throw std::invalid_argument{"aligned_response: the term must name one or more of the factors"};
  const Alignment alignment{response, used};
  if (!alignment.is_complete()) return Estimable<std::vector<double>>::impossible(kIncomplete);
  return alignment.aligned_for(term);
}

AnovaTable aligned_rank_anova(std::span<const double> response, std::span<const Factor> factors) {
  const auto used = used_levels_of("aligned_rank_anova", response, factors);
  const auto terms = full_factorial(factors.size());
  auto table = anova(response, used, terms, SumsOfSquares::kTypeIII);
  const Alignment alignment{response, used};
  const CellModel model{response.size(), used, terms, SumsOfSquares::kTypeIII};
  for (std::size_t t = 0; t < terms.size(); ++t) {
    auto& row = table.terms[t];
    if (!alignment.is_complete()) {
      test_term(row, 0.0, 0.0, 0, kIncomplete);
    } else if (model.reason().empty()) {
      test_ranks(model, t, mid_ranks(alignment.aligned_for(terms[t])), row);
    }
  }
  return table;
}

}  // namespace kith
