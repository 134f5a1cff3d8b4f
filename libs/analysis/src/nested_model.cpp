#include "kith/analysis/nested_model.hpp"

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

// Above it the variance of rows is rounding.
constexpr double kLargestRatio = 1e11;

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

std::string fault_of(std::span<const Factor> levels, std::size_t rows) {
  const Factor* outer = nullptr;
  for (const auto& groups : levels) {
    if (groups.levels.size() == 1) return "all rows have the same " + groups.name;
    if (groups.levels.size() == rows) return "every row has a " + groups.name + " of its own";
    std::vector<std::size_t> counts(groups.levels.size(), 0), within(groups.levels.size());
    for (std::size_t i = 0; i < rows; ++i) {
      const auto group = groups.codes[i];
      const auto at = outer == nullptr ? 0 : outer->codes[i];
      if (counts[group]++ > 0 && within[group] != at) return groups.name + " is not nested in " + outer->name;
      within[group] = at;
    }
    if (std::any_of(counts.begin(), counts.end(), [&](auto count) { return count * counts.size() != rows; }))
      return "the design is unbalanced: not every " + groups.name + " has as many rows as the others";
    outer = &groups;
  }
  return {};
}

// The stratum of what a term adds, whatever the values are; nothing if it is in several.
std::optional<std::size_t> stratum_of(const CellDesign& design, const std::vector<std::size_t>& term,
                                      std::span<const Factor> groups) {
  std::vector<double> parts(groups.size() + 1, 0.0);
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    std::vector<double> cell(design.counts.size(), 0.0), rows;
    cell[c] = 1.0;
    const auto effect = design.effect(term, std::move(cell));
    for (const auto of_row : design.cell_of) rows.push_back(effect[of_row]);
    const auto squares = squares_in_strata(rows, groups);
    for (std::size_t s = 0; s < parts.size(); ++s) parts[s] += squares[s];
  }
  const auto largest = std::max_element(parts.begin(), parts.end());
  if (*largest < (1.0 - 1e-9) * std::accumulate(parts.begin(), parts.end(), 0.0)) return std::nullopt;
  return static_cast<std::size_t>(largest - parts.begin());
}

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
Estimable<Interval> share_interval(const std::vector<double>& variances, const std::vector<double>& sizes,
                                   const std::vector<Pool>& pools, std::size_t k, double confidence) {
  if (variances[k] == 0.0) return Estimable<Interval>::impossible("its variance is zero");
  const double total = std::accumulate(variances.begin(), variances.end(), 0.0), rest = total - variances[k];
  double uncertainty = 0.0;
  for (const auto& pool : pools) {
    double slope = 0.0;
    for (std::size_t s = pool.begin; s < pool.end; ++s) {
      for (std::size_t v = 0; v < variances.size(); ++v) {
        const bool is_of_rows = v == sizes.size();
        const double size = is_of_rows ? 1.0 : sizes[v];
        const double part = (v == s ? 1.0 / size : 0.0) - (v + 1 == s && !is_of_rows ? 1.0 / size : 0.0);
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

}  // namespace

Estimable<NestedModel> fit_nested_model(std::span<const double> response, std::span<const Factor> factors,
                                        std::span<const std::vector<std::size_t>> terms, std::span<const Factor> groups,
                                        double confidence) {
  using Result = Estimable<NestedModel>;
  require_confidence(confidence, "fit_nested_model");
  require_finite(response, "fit_nested_model");
  if (groups.empty()) throw std::invalid_argument{"fit_nested_model: at least one level of groups is needed"};
  std::vector<Factor> levels;
  for (const auto& group : groups) {
    require_codes(group, response.size(), "fit_nested_model");
    levels.push_back(drop_unused(group));
  }
  const auto made = make_cell_design(response.size(), factors, terms);
  if (const auto fault = fault_of(levels, response.size()); !response.empty() && !fault.empty())
    return Result::impossible(fault);
  if (!made) return Result::impossible(made.reason());
  const auto& design = *made;

  const auto standardized = standardize(response);
  const auto squares = squares_in_strata(standardized.values, levels);
  std::vector<Stratum> strata;
  double before = 0.0;
  for (std::size_t s = 0; s < squares.size(); ++s) {
    const auto count = static_cast<double>(s < levels.size() ? levels[s].levels.size() : response.size());
    strata.push_back({count - before, squares[s]});
    before = count;
  }

  // What the mean and every term take of their strata.
  const auto cells = moments_of(standardized.values, design);
  const auto take = [&](Stratum& stratum, double df, double sum_of_squares) {
    stratum.df -= df;
    stratum.sum_of_squares = std::max(0.0, stratum.sum_of_squares - sum_of_squares);
  };
  const double mean = design.effect({}, cells.means).front();
  take(strata.front(), 1.0, static_cast<double>(response.size()) * mean * mean);
  std::vector<std::size_t> stratum_of_term;
  for (std::size_t t = 0; t < design.terms.size(); ++t) {
    const auto stratum = stratum_of(design, design.terms[t], levels);
    if (!stratum)
      return Result::impossible("the design is unbalanced, so that " + term_name(design.terms[t], design.factors) +
                                " is compared between groups and within them");
    stratum_of_term.push_back(*stratum);
    take(strata[*stratum], static_cast<double>(design.df(t)), term_sum_of_squares(design, t, cells.means));
  }
  for (std::size_t s = 0; s < strata.size(); ++s) {
    if (strata[s].df > 0.5) continue;
    return Result::impossible(s < levels.size() ? "the factors of the model already tell every " + levels[s].name +
                                                      " apart, so the variance between them cannot be estimated"
                                                : "there are no more observations than coefficients");
  }
  const double nothing = negligible_sum_of_squares(standardized.rounding, response.size());
  if (strata.back().sum_of_squares <= nothing) return Result::impossible("no spread of rows within their groups");

  const auto pools = pooled(strata);
  std::vector<double> mean_squares;
  for (const auto& pool : pools) mean_squares.resize(pool.end, pool.mean_square());
  const auto unit = [&](double variance) { return std::ldexp(variance, 2 * standardized.exponent); };

  NestedModel model;
  std::vector<double> variances, sizes;
  for (std::size_t s = 0; s < levels.size(); ++s) {
    sizes.push_back(static_cast<double>(response.size()) / static_cast<double>(levels[s].levels.size()));
    variances.push_back((mean_squares[s] - mean_squares[s + 1]) / sizes[s]);
  }
  variances.push_back(mean_squares.back());
  const double total = std::accumulate(variances.begin(), variances.end(), 0.0);
  if (total > kLargestRatio * variances.back()) return Result::impossible("no spread of rows within their groups");
  for (std::size_t s = 0; s < levels.size(); ++s) {
    GroupVariance group{levels[s].name, levels[s].levels.size(), unit(variances[s]), variances[s] / total};
    group.design_effect = 1.0 + (sizes[s] - 1.0) * group.intraclass_correlation;
    group.intraclass_interval =
        levels.size() == 1
            ? Estimable<Interval>{profile_interval(strata, sizes[0], variances[0] / variances[1], confidence)}
            : share_interval(variances, sizes, pools, s, confidence);
    const double chi = std::max(0.0, deviance(pooled(strata, s)) - deviance(pools));
    group.test = TestResult{"chi-squared", chi, {1.0}, chi_squared_upper(chi, 1.0)};
    model.groups.push_back(std::move(group));
  }
  model.residual_variance = unit(variances.back());

  for (std::size_t t = 0; t < design.terms.size(); ++t) {
    TermTest test{term_name(design.terms[t], design.factors), design.df(t)};
    const auto pool =
        std::find_if(pools.begin(), pools.end(), [&](const Pool& one) { return stratum_of_term[t] < one.end; });
    test.test = test.df > 0
                    ? Estimable<TestResult>{f_test(term_sum_of_squares(design, t, cells.means),
                                                   static_cast<double>(test.df), pool->sum_of_squares, pool->df)}
                    : Estimable<TestResult>::impossible("it has one level only");
    model.tests.push_back(std::move(test));
  }

  model.fixed = {.design = design, .centre = standardized.centre, .means = cells.means, .groups = std::move(levels)};
  for (auto& value : model.fixed.means) value = std::ldexp(value, standardized.exponent);
  for (const auto& pool : pools) model.fixed.pools.push_back({pool.begin, pool.end, pool.df, unit(pool.mean_square())});
  model.fixed.residual_sd = std::sqrt(unit(total));
  return model;
}

}  // namespace kith
