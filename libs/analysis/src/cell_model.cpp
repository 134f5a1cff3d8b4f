#include "cell_model.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include "checks.hpp"

namespace kith {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Pivots of design matrices, whose entries are -1, 0 and 1, below this part of the largest are rounding.
constexpr double kRankTolerance = 1e-9;
// Rows times squared columns of the largest matrix that is decomposed, about a second of work per term, and the sum
// over all terms, each of which keeps matrices of its own.
constexpr double kMostWork = 2e9;
constexpr double kMostWorkInAll = 7.0 * kMostWork;

Eigen::Index index_of(std::size_t i) { return static_cast<Eigen::Index>(i); }

// What the observed combinations of levels are, without the unused levels.
struct Cells {
  std::vector<std::size_t> cell_of;
  std::vector<std::vector<std::size_t>> levels;  // [cells][factors]
  std::vector<std::size_t> num_levels;           // [factors], those with observations
};

void append_factor(const Factor& factor, Cells& cells) {
  const auto used = drop_unused(factor);
  const auto num_levels = used.levels.size();
  std::unordered_map<std::size_t, std::size_t> cell_at;  // cell so far * levels + level -> new cell
  std::vector<std::vector<std::size_t>> levels;
  for (std::size_t i = 0; i < cells.cell_of.size(); ++i) {
    auto& cell = cells.cell_of[i];
    const auto [entry, is_new] = cell_at.emplace(cell * num_levels + used.codes[i], levels.size());
    if (is_new) {
      levels.push_back(cells.levels[cell]);
      levels.back().push_back(used.codes[i]);
    }
    cell = entry->second;
  }
  cells.levels = std::move(levels);
  cells.num_levels.push_back(num_levels);
}

// Cells of the factors that some term names; the others have no levels.
Cells find_cells(std::size_t observations, std::span<const Factor> factors,
                 const std::vector<std::vector<std::size_t>>& terms) {
  Cells cells{std::vector<std::size_t>(observations, 0), {{}}, {}};
  if (observations == 0) cells.levels.clear();
  for (std::size_t f = 0; f < factors.size(); ++f) {
    const bool named = std::any_of(terms.begin(), terms.end(), [f](const auto& term) {
      return std::find(term.begin(), term.end(), f) != term.end();
    });
    if (named) {
      append_factor(factors[f], cells);
    } else {
      cells.num_levels.push_back(1);
      for (auto& levels : cells.levels) levels.push_back(0);
    }
  }
  return cells;
}

// The columns of a factor: sum-to-zero contrasts, or an indicator of each level.
MatrixXd factor_columns(const Cells& cells, std::size_t factor, bool contrasts) {
  const auto num_levels = cells.num_levels[factor];
  MatrixXd columns = MatrixXd::Zero(index_of(cells.levels.size()), index_of(contrasts ? num_levels - 1 : num_levels));
  for (std::size_t c = 0; c < cells.levels.size(); ++c) {
    const auto level = cells.levels[c][factor];
    if (index_of(level) < columns.cols()) {
      columns(index_of(c), index_of(level)) = 1.0;
    } else {
      columns.row(index_of(c)).setConstant(-1.0);
    }
  }
  return columns;
}

// As R codes terms: a factor by contrasts if the model has the term without it, else by indicators.
bool needs_contrasts(const std::vector<std::size_t>& term, std::size_t factor,
                     const std::vector<std::vector<std::size_t>>& terms) {
  auto rest = term;
  std::erase(rest, factor);
  return rest.empty() || std::find(terms.begin(), terms.end(), rest) != terms.end();
}

MatrixXd term_columns(const Cells& cells, const std::vector<std::size_t>& term,
                      const std::vector<std::vector<std::size_t>>& terms) {
  MatrixXd columns = MatrixXd::Ones(index_of(cells.levels.size()), 1);
  for (const auto factor : term) {
    const MatrixXd next = factor_columns(cells, factor, needs_contrasts(term, factor, terms));
    MatrixXd product(columns.rows(), columns.cols() * next.cols());
    for (Eigen::Index j = 0; j < next.cols(); ++j) {
      for (Eigen::Index i = 0; i < columns.cols(); ++i)
        product.col(j * columns.cols() + i) = columns.col(i).cwiseProduct(next.col(j));
    }
    columns = std::move(product);
  }
  return columns;
}

double num_columns(const Cells& cells, const std::vector<std::vector<std::size_t>>& terms) {
  double count = 1.0;
  for (const auto& term : terms) {
    double product = 1.0;
    for (const auto factor : term) {
      const bool contrasts = needs_contrasts(term, factor, terms);
      product *= static_cast<double>(cells.num_levels[factor]) - (contrasts ? 1.0 : 0.0);
    }
    count += product;
  }
  return count;
}

std::size_t rank_of(const MatrixXd& columns) {
  if (columns.size() == 0) return 0;
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(kRankTolerance);
  qr.compute(columns);
  return static_cast<std::size_t>(qr.rank());
}

// The first `rank` pivots of the columns, made orthonormal.
MatrixXd orthonormal(const MatrixXd& columns, std::size_t rank) {
  if (rank == 0) return MatrixXd(columns.rows(), 0);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr{columns};
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), index_of(rank));
}

// Twice is enough to leave nothing but rounding in the space of `basis`.
MatrixXd outside(const MatrixXd& basis, MatrixXd columns) {
  for (int pass = 0; pass < 2; ++pass) columns -= basis * (basis.transpose() * columns);
  return columns;
}

MatrixXd beside(const MatrixXd& left, const MatrixXd& right) {
  MatrixXd both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

bool contains(const std::vector<std::size_t>& whole, const std::vector<std::size_t>& part) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

std::string name_of(const std::vector<std::size_t>& term, std::span<const Factor> factors) {
  std::string name;
  for (const auto factor : term) name += (name.empty() ? "" : ":") + factors[factor].name;
  return name;
}

// As ascending sets, each of which names factors.
std::vector<std::vector<std::size_t>> checked_terms(std::span<const std::vector<std::size_t>> terms,
                                                    std::size_t num_factors) {
  std::vector<std::vector<std::size_t>> sets{terms.begin(), terms.end()};
  for (auto& term : sets) {
    std::sort(term.begin(), term.end());
    term.erase(std::unique(term.begin(), term.end()), term.end());
    if (term.empty() || term.back() >= num_factors)
      throw std::invalid_argument{"anova: every term must name one or more of the factors"};
  }
  return sets;
}

// Of levels that have observations; at most 2^53.
std::size_t num_combinations(const Cells& cells) {
  double combinations = cells.cell_of.empty() ? 0.0 : 1.0;
  for (const auto num_levels : cells.num_levels) combinations *= static_cast<double>(num_levels);
  return static_cast<std::size_t>(std::min(combinations, 0x1.0p53));
}

std::string reason_against_fitting(const Cells& cells, const std::vector<std::vector<std::size_t>>& terms) {
  if (cells.cell_of.empty()) return "no observations";
  const auto rows = static_cast<double>(cells.levels.size());
  const double width = num_columns(cells, terms);
  const double work = rows * width * std::min(rows, width);
  if (work > kMostWork) return "too many combinations of levels for an analysis of variance";
  if (work * static_cast<double>(terms.size()) > kMostWorkInAll)
    return "too many terms over too many combinations of levels for an analysis of variance";
  return "";
}

std::string reason_without_df(const std::vector<std::size_t>& term, const Cells& cells,
                              std::span<const Factor> factors) {
  for (const auto factor : term) {
    if (cells.num_levels[factor] < 2) return "only one level of '" + factors[factor].name + "' has observations";
  }
  return "combinations of levels without observations leave nothing of it to estimate";
}

double largest_size(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// The power of two that is just above.
int exponent_above(double size) { return size > 0.0 ? std::ilogb(size) + 1 : 0; }

}  // namespace

StandardizedResponse standardize(std::span<const double> response) {
  StandardizedResponse result;
  result.values.assign(response.begin(), response.end());
  if (response.empty()) return result;
  auto& values = result.values;

  const int size_exponent = exponent_above(largest_size(response));
  for (auto& value : values) value = std::ldexp(value, -size_exponent);
  // Differences from one of the values are exact where values are near each other, and exactly 0 where all are equal.
  const double origin = values.front();
  for (auto& value : values) value -= origin;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (auto& value : values) value -= mean;

  const int spread_exponent = exponent_above(largest_size(values));
  for (auto& value : values) value = std::ldexp(value, -spread_exponent);
  result.centre = std::ldexp(origin + mean, size_exponent);
  result.exponent = size_exponent + spread_exponent;
  result.rounding = std::ldexp(std::numeric_limits<double>::epsilon(), -spread_exponent);
  return result;
}

CellModel::CellModel(std::size_t observations, std::span<const Factor> factors,
                     std::span<const std::vector<std::size_t>> terms, SumsOfSquares type) {
  const auto sets = checked_terms(terms, factors.size());
  for (const auto& factor : factors) require_codes(factor, observations, "anova");
  for (const auto& set : sets) terms_.push_back({name_of(set, factors), 0, {}, {}});

  const auto cells = find_cells(observations, factors, sets);
  cell_of_ = cells.cell_of;
  counts_.assign(cells.levels.size(), 0);
  for (const auto cell : cell_of_) ++counts_[cell];
  root_counts_.resize(index_of(counts_.size()));
  for (std::size_t c = 0; c < counts_.size(); ++c)
    root_counts_(index_of(c)) = std::sqrt(static_cast<double>(counts_[c]));
  empty_cells_ = num_combinations(cells) - counts_.size();

  reason_ = reason_against_fitting(cells, sets);
  for (auto& term : terms_) term.reason = reason_;
  if (!reason_.empty()) return;
  std::vector<MatrixXd> columns;
  columns.reserve(sets.size());
  for (const auto& set : sets) columns.push_back(term_columns(cells, set, sets));
  decompose(columns, sets, type);
  for (std::size_t t = 0; t < sets.size(); ++t) {
    if (terms_[t].df == 0) {
      terms_[t].reason = reason_without_df(sets[t], cells, factors);
    } else if (residual_df_ == 0) {
      terms_[t].reason = "no residual degrees of freedom: as many parameters as observations";
    }
  }
}

void CellModel::decompose(const std::vector<MatrixXd>& columns, const std::vector<std::vector<std::size_t>>& sets,
                          SumsOfSquares type) {
  const MatrixXd intercept = MatrixXd::Ones(index_of(num_cells()), 1);
  const auto weighted = [this](const MatrixXd& design) -> MatrixXd { return root_counts_.asDiagonal() * design; };

  MatrixXd design = intercept;
  for (const auto& term : columns) design = beside(design, term);
  const auto rank = rank_of(design);
  basis_ = orthonormal(weighted(design), rank);
  saturated_ = rank == num_cells();
  residual_df_ = observations() - rank;

  for (std::size_t t = 0; t < sets.size(); ++t) {
    MatrixXd others = intercept;
    for (std::size_t other = 0; other < sets.size(); ++other) {
      if (other == t || (type == SumsOfSquares::kTypeII && contains(sets[other], sets[t]))) continue;
      others = beside(others, columns[other]);
    }
    const auto rank_of_others = rank_of(others);
    auto& term = terms_[t];
    term.df = rank_of(beside(others, columns[t])) - rank_of_others;
    term.basis = orthonormal(outside(orthonormal(weighted(others), rank_of_others), weighted(columns[t])), term.df);
  }
}

bool CellModel::balanced() const noexcept {
  return empty_cells_ == 0 &&
         std::all_of(counts_.begin(), counts_.end(), [this](std::size_t count) { return count == counts_.front(); });
}

CellMoments CellModel::summarize(std::span<const double> values) const {
  // Differences from a cell's first value: a cell whose values are all equal has exactly no spread.
  std::vector<double> first(num_cells(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> mean(num_cells(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto cell = cell_of_[i];
    if (std::isnan(first[cell])) first[cell] = values[i];
    mean[cell] += values[i] - first[cell];
  }
  CellMoments summary;
  summary.weighted_means.resize(index_of(num_cells()));
  for (std::size_t c = 0; c < num_cells(); ++c) {
    mean[c] = first[c] + mean[c] / static_cast<double>(counts_[c]);
    summary.weighted_means(index_of(c)) = mean[c] * root_counts_(index_of(c));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = values[i] - mean[cell_of_[i]];
    summary.within += difference * difference;
  }
  return summary;
}

double CellModel::lack_of_fit(const VectorXd& z) const {
  return saturated_ ? 0.0 : (z - basis_ * (basis_.transpose() * z)).squaredNorm();
}

VectorXd CellModel::fitted(const VectorXd& z) const {
  if (saturated_) return z.cwiseQuotient(root_counts_);
  return (basis_ * (basis_.transpose() * z)).cwiseQuotient(root_counts_);
}

}  // namespace kith
