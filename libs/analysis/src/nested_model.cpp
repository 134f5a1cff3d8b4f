#include "kith/analysis/nested_model.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/analysis/distributions.hpp"
#include "root.hpp"

namespace kith {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Above it the variance of rows is rounding.
constexpr double kLargestRatio = 1e11;

// The rows of a level of groups.
struct Level {
  Factor groups;
  double size = 1.0;  // rows in each
};

// A stratum: what differs between the groups of a level and not between those of the level before.
struct Stratum {
  double df = 0.0;  // of its residual
  double sum_of_squares = 0.0;
};

// Strata that have one variance.
struct Pool {
  std::size_t begin = 0, end = 0;  // strata
  double df = 0.0;
  double sum_of_squares = 0.0;
  [[nodiscard]] double mean_square() const { return sum_of_squares / df; }
  void take(const Pool& next) {
    end = next.end;
    df += next.df;
    sum_of_squares += next.sum_of_squares;
  }
};

// REML's variances of the strata: their mean squares, of which a stratum's is at least that of every later one.
std::vector<Pool> pooled(const std::vector<Stratum>& strata, std::optional<std::size_t> without = std::nullopt) {
  std::vector<Pool> pools;
  for (std::size_t s = 0; s < strata.size(); ++s) {
    pools.push_back({s, s + 1, strata[s].df, strata[s].sum_of_squares});
    const auto is_out_of_order = [&] {
      const auto& last = pools.back();
      const auto& before = pools[pools.size() - 2];
      return before.mean_square() <= last.mean_square() || (without && last.begin == *without + 1);
    };
    while (pools.size() > 1 && is_out_of_order()) {
      const auto last = pools.back();
      pools.pop_back();
      pools.back().take(last);
    }
  }
  return pools;
}

// -2 log restricted likelihood, but for a constant.
double deviance(const std::vector<Pool>& pools) {
  double sum = 0.0;
  for (const auto& pool : pools) sum += pool.df * std::log(pool.mean_square());
  return sum;
}

std::string fault_of(const std::vector<Level>& levels, std::size_t rows) {
  const Factor* outer = nullptr;
  for (const auto& [groups, size] : levels) {
    if (groups.levels.size() == 1) return "all rows have the same " + groups.name;
    if (groups.levels.size() == rows) return "every row has a " + groups.name + " of its own";
    std::vector<std::size_t> counts(groups.levels.size(), 0), within(groups.levels.size());
    for (std::size_t i = 0; i < rows; ++i) {
      const auto group = groups.codes[i];
      const auto at = outer == nullptr ? 0 : outer->codes[i];
      if (counts[group]++ > 0 && within[group] != at) return groups.name + " is not nested in " + outer->name;
      within[group] = at;
    }
    if (std::any_of(counts.begin(), counts.end(), [&](auto count) { return static_cast<double>(count) != size; }))
      return "the design is unbalanced: not every " + groups.name + " has as many rows as the others";
    outer = &groups;
  }
  return {};
}

// Squared length of what the values say in each stratum.
std::vector<double> squares_of(const VectorXd& values, const std::vector<Level>& levels) {
  std::vector<double> squares;
  double before = 0.0;
  for (const auto& [groups, size] : levels) {
    std::vector<double> sums(groups.levels.size(), 0.0);
    for (Eigen::Index i = 0; i < values.size(); ++i) sums[groups.codes[static_cast<std::size_t>(i)]] += values(i);
    const double all = std::inner_product(sums.begin(), sums.end(), sums.begin(), 0.0) / size;
    squares.push_back(all - before);
    before = all;
  }
  squares.push_back(values.squaredNorm() - before);
  return squares;
}

// How the variance of a combination depends on those of the strata, which gives its degrees of freedom.
struct SatterthwaiteOfStrata {
  MatrixXd inverse;                  // of R, [columns, columns]
  std::vector<std::size_t> pool_of;  // [columns]
  std::vector<Pool> pools;

  double operator()(std::span<const double> combination) const {
    const Eigen::Map<const VectorXd> weights{combination.data(), static_cast<Eigen::Index>(combination.size())};
    const VectorXd along = inverse.transpose() * weights;
    std::vector<double> parts(pools.size(), 0.0);
    for (Eigen::Index j = 0; j < along.size(); ++j) parts[pool_of[static_cast<std::size_t>(j)]] += along(j) * along(j);
    double variance = 0.0, uncertainty = 0.0;
    for (std::size_t p = 0; p < pools.size(); ++p) {
      const double part = parts[p] * pools[p].mean_square();
      variance += part;
      uncertainty += part * part / pools[p].df;
    }
    return variance * variance / uncertainty;
  }
};

// Where the deviance of a single kind of group rises above its minimum by the quantile of chi-squared.
Interval profile_interval(const std::vector<Stratum>& strata, double size, double tau, double confidence) {
  constexpr double kSmallest = 1e-9;
  const double df = strata[0].df + strata[1].df;
  const auto at = [&](double ratio) {
    const double factor = 1.0 + size * ratio;
    return strata[0].df * std::log(factor) +
           df * std::log(strata[0].sum_of_squares / factor + strata[1].sum_of_squares);
  };
  const double z = normal_quantile(0.5 + confidence / 2.0), limit = at(tau) + z * z;
  const auto excess = [&](double log_ratio) { return at(std::exp(log_ratio)) - limit; };
  const double middle = std::log(std::max(tau, kSmallest)), low_end = std::log(kSmallest),
               high_end = std::log(10.0 * kLargestRatio);
  const auto share = [](double log_ratio) { return 1.0 / (1.0 + std::exp(-log_ratio)); };
  Interval interval{tau / (1.0 + tau), 0.0, 1.0};
  if (tau > kSmallest && excess(low_end) > 0.0) interval.low = share(detail::root_between(low_end, middle, 32, excess));
  if (excess(high_end) > 0.0) interval.high = share(detail::root_between(middle, high_end, 32, excess));
  return interval;
}

// Wald's interval of the log odds of a variance's share. `variances` are of the groups, then of rows; each is a
// difference of the variances of two strata over a number of rows.
Estimable<Interval> share_interval(const std::vector<double>& variances, const std::vector<Level>& levels,
                                   const std::vector<Pool>& pools, std::size_t k, double confidence) {
  if (variances[k] == 0.0) return Estimable<Interval>::impossible("its variance is zero");
  const double total = std::accumulate(variances.begin(), variances.end(), 0.0), rest = total - variances[k];
  double uncertainty = 0.0;
  for (const auto& pool : pools) {
    double slope = 0.0;
    for (std::size_t s = pool.begin; s < pool.end; ++s) {
      for (std::size_t v = 0; v < variances.size(); ++v) {
        const double size = v < levels.size() ? levels[v].size : 1.0;
        const double part = (v == s ? 1.0 / size : 0.0) - (v + 1 == s && v < levels.size() ? 1.0 / size : 0.0);
        slope += part * (v == k ? 1.0 / variances[k] : -1.0 / rest);
      }
    }
    uncertainty += slope * slope * 2.0 * pool.mean_square() * pool.mean_square() / pool.df;
  }
  const double reach = normal_quantile(0.5 + confidence / 2.0) * std::sqrt(uncertainty);
  const double odds = std::log(variances[k] / rest);
  const auto share = [](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); };
  return Interval{share(odds), share(odds - reach), share(odds + reach)};
}

std::string name_of_term(const FactorDesign& design, std::size_t t) {
  std::string name;
  for (const auto factor : design.terms[t]) name += (name.empty() ? "" : ":") + design.factors[factor].name;
  return name;
}

}  // namespace

Estimable<NestedModel> fit_nested_model(std::span<const double> response, std::span<const Factor> factors,
                                        std::span<const std::vector<std::size_t>> terms, std::span<const Factor> groups,
                                        double confidence) {
  using Result = Estimable<NestedModel>;
  require_confidence(confidence, "fit_nested_model");
  require_finite(response, "fit_nested_model");
  if (groups.empty()) throw std::invalid_argument{"fit_nested_model: at least one level of groups is needed"};
  const auto rows = static_cast<Eigen::Index>(response.size());
  std::vector<Level> levels;
  for (const auto& group : groups) {
    require_codes(group, response.size(), "fit_nested_model");
    auto used = drop_unused(group);
    const double size = static_cast<double>(response.size()) / static_cast<double>(used.levels.size());
    levels.push_back({std::move(used), size});
  }
  const auto made = make_factor_design(response.size(), factors, terms);
  if (!made) return Result::impossible(made.reason());
  auto design = *made;
  if (auto fault = fault_of(levels, response.size()); !fault.empty()) return Result::impossible(std::move(fault));

  // An orthonormal basis of the model in the cells, column by column.
  const auto p = design.columns.size();
  const auto k = static_cast<Eigen::Index>(design.kept.size());
  MatrixXd weighted(static_cast<Eigen::Index>(design.counts.size()), k);
  for (Eigen::Index c = 0; c < weighted.rows(); ++c) {
    const auto cell = static_cast<std::size_t>(c);
    for (Eigen::Index j = 0; j < k; ++j)
      weighted(c, j) = std::sqrt(static_cast<double>(design.counts[cell])) *
                       design.grid[cell * p + design.kept[static_cast<std::size_t>(j)]];
  }
  if (weighted.rows() < k) return Result::impossible("the design is unbalanced: combinations of levels have no rows");
  const Eigen::HouseholderQR<MatrixXd> qr{weighted};
  const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(weighted.rows(), k);
  const MatrixXd inverse = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>().solve(MatrixXd::Identity(k, k));

  const auto standardized = standardize(response);
  const Eigen::Map<const VectorXd> values{standardized.values.data(), rows};
  const auto squares = squares_of(values, levels);
  std::vector<Stratum> strata(levels.size() + 1);
  double before = 0.0;
  for (std::size_t s = 0; s < strata.size(); ++s) {
    const double count =
        s < levels.size() ? static_cast<double>(levels[s].groups.levels.size()) : static_cast<double>(response.size());
    strata[s] = {count - before, squares[s]};
    before = count;
  }

  // The stratum of every column, which takes its part of it.
  VectorXd along(k);
  std::vector<std::size_t> stratum_of;
  for (Eigen::Index j = 0; j < k; ++j) {
    VectorXd column(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto cell = design.cell_of[static_cast<std::size_t>(i)];
      column(i) = basis(static_cast<Eigen::Index>(cell), j) / std::sqrt(static_cast<double>(design.counts[cell]));
    }
    const auto parts = squares_of(column, levels);
    const auto largest = std::max_element(parts.begin(), parts.end());
    if (*largest < 1.0 - 1e-9) {
      const auto term = design.term_of[design.kept[static_cast<std::size_t>(j)]];
      return Result::impossible("the design is unbalanced, so that " +
                                (term < design.terms.size() ? name_of_term(design, term) : std::string{"the mean"}) +
                                " is compared between groups and within them");
    }
    stratum_of.push_back(static_cast<std::size_t>(largest - parts.begin()));
    along(j) = column.dot(values);
    auto& stratum = strata[stratum_of.back()];
    stratum.df -= 1.0;
    stratum.sum_of_squares = std::max(0.0, stratum.sum_of_squares - along(j) * along(j));
  }
  for (std::size_t s = 0; s < strata.size(); ++s) {
    if (strata[s].df > 0.5) continue;
    return Result::impossible(s < levels.size()
                                  ? "the factors of the model already tell every " + levels[s].groups.name +
                                        " apart, so the variance between them cannot be estimated"
                                  : "there are no more observations than coefficients");
  }
  const double nothing = negligible_sum_of_squares(standardized.rounding, response.size());
  if (strata.back().sum_of_squares <= nothing) return Result::impossible("no spread of rows within their groups");

  const auto pools = pooled(strata);
  std::vector<double> mean_squares;
  std::vector<std::size_t> pool_of_stratum;
  for (std::size_t q = 0; q < pools.size(); ++q) {
    mean_squares.resize(pools[q].end, pools[q].mean_square());
    pool_of_stratum.resize(pools[q].end, q);
  }
  const auto unit = [&](double variance) { return std::ldexp(variance, 2 * standardized.exponent); };

  NestedModel model;
  std::vector<double> variances;
  for (std::size_t s = 0; s < levels.size(); ++s)
    variances.push_back((mean_squares[s] - mean_squares[s + 1]) / levels[s].size);
  variances.push_back(mean_squares.back());
  const double total = std::accumulate(variances.begin(), variances.end(), 0.0);
  if (total > kLargestRatio * variances.back()) return Result::impossible("no spread of rows within their groups");
  for (std::size_t s = 0; s < levels.size(); ++s) {
    GroupVariance group{levels[s].groups.name, levels[s].groups.levels.size(), unit(variances[s]),
                        variances[s] / total};
    group.intraclass_interval =
        levels.size() == 1
            ? Estimable<Interval>{profile_interval(strata, levels[0].size, variances[0] / variances[1], confidence)}
            : share_interval(variances, levels, pools, s, confidence);
    const double chi = std::max(0.0, deviance(pooled(strata, s)) - deviance(pools));
    group.test = TestResult{"chi-squared", chi, {1.0}, chi_squared_upper(chi, 1.0)};
    model.groups.push_back(std::move(group));
  }
  model.residual_variance = unit(variances.back());

  VectorXd spread(k);
  SatterthwaiteOfStrata satterthwaite{inverse, {}, pools};
  for (Eigen::Index j = 0; j < k; ++j) {
    const auto stratum = stratum_of[static_cast<std::size_t>(j)];
    spread(j) = mean_squares[stratum];
    satterthwaite.pool_of.push_back(pool_of_stratum[stratum]);
  }
  for (std::size_t t = 0; t < design.terms.size(); ++t) {
    TermTest test{name_of_term(design, t), 0};
    double sum = 0.0;
    std::size_t pool = 0;
    for (Eigen::Index j = 0; j < k; ++j) {
      if (design.term_of[design.kept[static_cast<std::size_t>(j)]] != t) continue;
      ++test.df;
      sum += along(j) * along(j);
      pool = satterthwaite.pool_of[static_cast<std::size_t>(j)];
    }
    test.test = test.df > 0 ? Estimable<TestResult>{f_test(sum, static_cast<double>(test.df),
                                                           pools[pool].sum_of_squares, pools[pool].df)}
                            : Estimable<TestResult>::impossible("it has one level only");
    model.tests.push_back(std::move(test));
  }

  const VectorXd solved = inverse * along;
  std::vector<double> coefficients;
  for (const double value : solved) coefficients.push_back(std::ldexp(value, standardized.exponent));
  coefficients.front() += standardized.centre;  // the intercept comes first and is always kept
  const MatrixXd covariance = unit(1.0) * (inverse * spread.asDiagonal() * inverse.transpose());
  model.fixed =
      make_fixed_effects(std::move(design), coefficients,
                         {covariance.data(), static_cast<std::size_t>(covariance.size())}, std::move(satterthwaite));
  model.fixed.residual_sd = std::sqrt(unit(total));
  return model;
}

}  // namespace kith
