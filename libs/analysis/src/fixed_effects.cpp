#include "kith/analysis/fixed_effects.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "checks.hpp"
#include "inference.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

using Terms = std::vector<std::vector<std::size_t>>;

// A column whose part outside the earlier ones is smaller than this share of it depends on them; its entries are 0
// or 1.
constexpr double kDependent = 1e-9;
// A combination is estimable if its part in the null space is smaller than this share of it.
constexpr double kEstimable = 1e-8;
constexpr double kMostGridEntries = 1e7;

Eigen::Index place(std::size_t i) { return static_cast<Eigen::Index>(i); }

Terms checked(std::span<const std::vector<std::size_t>> terms, std::size_t num_factors) {
  Terms sets{terms.begin(), terms.end()};
  for (auto& term : sets) {
    std::sort(term.begin(), term.end());
    term.erase(std::unique(term.begin(), term.end()), term.end());
    if (term.empty() || term.back() >= num_factors)
      throw std::invalid_argument{"make_factor_design: every term must name one or more of the factors"};
  }
  return sets;
}

// As R codes terms: by contrasts if the model has the term without the factor, else by an indicator of every level.
bool is_contrast(const std::vector<std::size_t>& term, std::size_t factor, const Terms& terms) {
  auto margin = term;
  std::erase(margin, factor);
  return margin.empty() || std::find(terms.begin(), terms.end(), margin) != terms.end();
}

// A column is 1 where every factor has the level that it names.
struct DesignColumn {
  std::string name;
  std::size_t term = 0;
  std::vector<std::pair<std::size_t, std::size_t>> levels;  // factor, level
};

// Columns of a term; the level of the first factor varies fastest, as in R.
std::vector<DesignColumn> columns_of(std::size_t t, const Terms& terms, const std::vector<ModelFactor>& factors) {
  std::vector<DesignColumn> columns{{"", t, {}}};
  for (const auto factor : terms[t]) {
    std::vector<DesignColumn> product;
    const std::size_t first = is_contrast(terms[t], factor, terms) ? 1 : 0;
    for (std::size_t level = first; level < factors[factor].levels.size(); ++level) {
      for (const auto& column : columns) {
        auto next = column;
        next.name += (next.name.empty() ? "" : ":") + factors[factor].name + "[" + factors[factor].levels[level] + "]";
        next.levels.emplace_back(factor, level);
        product.push_back(std::move(next));
      }
    }
    columns = std::move(product);
  }
  return columns;
}

double num_columns(const Terms& terms, const std::vector<ModelFactor>& factors) {
  double count = 1.0;
  for (const auto& term : terms) {
    double product = 1.0;
    for (const auto factor : term)
      product *= static_cast<double>(factors[factor].levels.size()) - (is_contrast(term, factor, terms) ? 1.0 : 0.0);
    count += product;
  }
  return count;
}

// Finds the independent columns of the observed cells by Gram-Schmidt, and how the others depend on them.
void find_dependencies(FactorDesign& design) {
  const auto p = design.columns.size();
  std::vector<std::size_t> observed;
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    if (design.counts[c] > 0) observed.push_back(c);
  }
  Eigen::MatrixXd basis(place(observed.size()), place(std::min(p, observed.size())));
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(basis.cols(), basis.cols());  // kept columns = basis * triangle
  std::vector<Eigen::VectorXd> dependent;                                        // each: coordinates in `basis`
  std::vector<std::size_t> dropped;
  Eigen::Index rank = 0;
  for (std::size_t j = 0; j < p; ++j) {
    Eigen::VectorXd column(place(observed.size()));
    for (std::size_t i = 0; i < observed.size(); ++i) column(place(i)) = design.grid[observed[i] * p + j];
    const double length = column.norm();
    Eigen::VectorXd along = Eigen::VectorXd::Zero(rank);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd step = basis.leftCols(rank).transpose() * column;
      column -= basis.leftCols(rank) * step;
      along += step;
    }
    if (column.norm() <= kDependent * length) {
      dropped.push_back(j);
      dependent.push_back(std::move(along));
      continue;
    }
    triangle.col(rank).head(rank) = along;
    triangle(rank, rank) = column.norm();
    basis.col(rank) = column.normalized();
    design.kept.push_back(j);
    ++rank;
  }
  design.null_space.assign(dropped.size() * p, 0.0);
  for (std::size_t d = 0; d < dropped.size(); ++d) {
    const auto size = dependent[d].size();
    const Eigen::VectorXd weights =
        triangle.topLeftCorner(size, size).triangularView<Eigen::Upper>().solve(dependent[d]);
    for (Eigen::Index k = 0; k < size; ++k)
      design.null_space[d * p + design.kept[static_cast<std::size_t>(k)]] = -weights(k);
    design.null_space[d * p + dropped[d]] = 1.0;
  }
}

bool is_estimable(const FactorDesign& design, std::span<const double> combination) {
  const auto p = place(design.columns.size());
  const Eigen::Map<const Eigen::VectorXd> weights{combination.data(), p};
  for (std::size_t begin = 0; begin < design.null_space.size(); begin += design.columns.size()) {
    const Eigen::Map<const Eigen::VectorXd> direction{design.null_space.data() + begin, p};
    if (std::abs(weights.dot(direction)) > kEstimable * weights.norm() * direction.norm()) return false;
  }
  return true;
}

}  // namespace

Estimable<FactorDesign> make_factor_design(std::size_t observations, std::span<const Factor> factors,
                                           std::span<const std::vector<std::size_t>> terms) {
  using Result = Estimable<FactorDesign>;
  for (const auto& factor : factors) require_codes(factor, observations, "make_factor_design");
  FactorDesign design;
  design.terms = checked(terms, factors.size());
  if (observations == 0) return Result::impossible("no observations");
  design.cell_of.assign(observations, 0);
  double cells = 1.0;
  for (const auto& factor : factors) {
    const auto used = drop_unused(factor);
    design.factors.push_back({used.name, used.levels});
    cells *= static_cast<double>(used.levels.size());
    if (cells > kMostGridEntries) return Result::impossible("too many combinations of levels for a linear model");
    for (std::size_t i = 0; i < observations; ++i)
      design.cell_of[i] = design.cell_of[i] * used.levels.size() + used.codes[i];
  }
  if (cells * num_columns(design.terms, design.factors) > kMostGridEntries)
    return Result::impossible("too many combinations of levels for a linear model");

  std::vector<DesignColumn> columns{{"(Intercept)", design.terms.size(), {}}};
  for (std::size_t t = 0; t < design.terms.size(); ++t) {
    for (auto& column : columns_of(t, design.terms, design.factors)) columns.push_back(std::move(column));
  }
  for (const auto& column : columns) {
    design.columns.push_back(column.name);
    design.term_of.push_back(column.term);
  }
  design.counts.assign(static_cast<std::size_t>(cells), 0);
  for (const auto cell : design.cell_of) ++design.counts[cell];
  design.grid.assign(design.counts.size() * columns.size(), 0.0);
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    const auto levels = levels_of_cell(design, c);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const bool is_one = std::all_of(columns[j].levels.begin(), columns[j].levels.end(),
                                      [&](const auto& named) { return levels[named.first] == named.second; });
      design.grid[c * columns.size() + j] = is_one ? 1.0 : 0.0;
    }
  }
  find_dependencies(design);
  return design;
}

FixedEffects make_fixed_effects(FactorDesign design, std::span<const double> coefficients,
                                std::span<const double> covariance, std::function<double(std::span<const double>)> df) {
  const auto k = design.kept.size();
  const auto p = design.columns.size();
  if (coefficients.size() != k || covariance.size() != k * k)
    throw std::invalid_argument{"make_fixed_effects: one coefficient and one row of covariances per kept column"};
  FixedEffects model;
  model.coefficients.assign(p, 0.0);
  model.covariance.assign(p * p, 0.0);
  for (std::size_t i = 0; i < k; ++i) {
    model.coefficients[design.kept[i]] = coefficients[i];
    for (std::size_t j = 0; j < k; ++j) model.covariance[design.kept[i] * p + design.kept[j]] = covariance[i * k + j];
  }
  model.df = [kept = design.kept, df = std::move(df)](std::span<const double> combination) {
    std::vector<double> weights;
    weights.reserve(kept.size());
    for (const auto column : kept) weights.push_back(combination[column]);
    return df(weights);
  };
  model.design = std::move(design);
  return model;
}

std::vector<std::size_t> levels_of_cell(const FactorDesign& design, std::size_t cell) {
  std::vector<std::size_t> levels(design.factors.size());
  for (std::size_t f = levels.size(); f-- > 0;) {
    levels[f] = cell % design.factors[f].levels.size();
    cell /= design.factors[f].levels.size();
  }
  return levels;
}

namespace {

double variance_of(const FixedEffects& model, std::span<const double> combination) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto p = place(combination.size());
  const Eigen::Map<const Matrix> covariance{model.covariance.data(), p, p};
  const Eigen::Map<const Eigen::VectorXd> weights{combination.data(), p};
  return weights.dot(covariance * weights);
}

// sum_j weight_j coefficient_j; what is no more than the rounding of its parts is 0.
double combined(std::span<const double> weights, std::span<const double> coefficients) {
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  double sum = 0.0, size = 0.0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    const double part = weights[j] * coefficients[j];
    sum += part;
    size += std::abs(part);
  }
  return std::abs(sum) <= kRounding * size ? 0.0 : sum;
}

}  // namespace

LinearEstimate estimate_combination(const FixedEffects& model, std::string name, std::vector<double> combination,
                                    double confidence) {
  require_confidence(confidence, "estimate_combination");
  require_finite(combination, "estimate_combination");
  if (combination.size() != model.coefficients.size())
    throw std::invalid_argument{"estimate_combination: one weight per column of the design"};
  LinearEstimate result;
  result.name = std::move(name);
  result.combination = std::move(combination);
  if (!is_estimable(model.design, result.combination)) {
    const std::string reason = "it depends on combinations of levels without observations";
    result.estimate = Estimable<double>::impossible(reason);
    result.inference = Estimable<Inference>::impossible(reason);
    return result;
  }
  const double estimate = combined(result.combination, model.coefficients);
  result.estimate = estimate;
  if (!model.no_standard_errors.empty()) {
    result.inference = Estimable<Inference>::impossible(model.no_standard_errors);
    return result;
  }
  const double variance = variance_of(model, result.combination);
  if (!(variance > 0.0)) {
    result.inference = Estimable<Inference>::impossible("its standard error is zero");
    return result;
  }
  Inference inference;
  inference.standard_error = std::sqrt(variance);
  inference.df = model.df(result.combination);
  inference.statistic = estimate / inference.standard_error;
  inference.p = inference.p_unadjusted = student_t_two_sided(inference.statistic, inference.df);
  const double reach = student_t_quantile(0.5 + confidence / 2.0, inference.df) * inference.standard_error;
  inference.low = estimate - reach;
  inference.high = estimate + reach;
  result.inference = inference;
  return result;
}

}  // namespace kith
