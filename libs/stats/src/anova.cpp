#include "kith/stats/anova.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"

namespace kith {
namespace {

std::vector<double> residuals_of(const CellModel& model, const StandardizedResponse& response,
                                 const Eigen::VectorXd& z) {
  const Eigen::VectorXd fitted = model.fitted(z);
  std::vector<double> residuals(response.values.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const auto cell = static_cast<Eigen::Index>(model.cell_of()[i]);
    residuals[i] = std::ldexp(response.values[i] - fitted(cell), response.exponent);
  }
  return residuals;
}

// Responses by block and level of the factor within blocks, less the block's mean.
struct Blocks {
  std::vector<std::vector<double>> differences;  // [blocks][levels]
  std::vector<std::size_t> group;                // [blocks], level of the factor between blocks
  std::string reason;                            // Why the blocks cannot be used; empty if they can.
};

Blocks gather_blocks(std::span<const double> values, const Factor& within, const Factor& between, const Factor& block) {
  const auto num_levels = within.levels.size();
  Blocks blocks;
  blocks.differences.assign(block.levels.size(), std::vector<double>(num_levels, 0.0));
  blocks.group.assign(block.levels.size(), between.levels.size());
  std::vector<std::vector<bool>> seen(block.levels.size(), std::vector<bool>(num_levels, false));
  std::vector<std::size_t> count(block.levels.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto b = block.codes[i];
    const auto level = within.codes[i];
    auto& group = blocks.group[b];
    if (group == between.levels.size()) group = between.codes[i];
    const auto name = "block '" + block.levels[b] + "' ";
    if (group != between.codes[i]) {
      blocks.reason = name + "has more than one level of '" + between.name + "'";
    } else if (seen[b][level]) {
      blocks.reason = name + "has level '" + within.levels[level] + "' of '" + within.name + "' more than once";
    }
    if (!blocks.reason.empty()) return blocks;
    seen[b][level] = true;
    ++count[b];
    blocks.differences[b][level] = values[i];
  }
  for (std::size_t b = 0; b < count.size(); ++b) {
    if (count[b] < num_levels) {
      blocks.reason = "block '" + block.levels[b] + "' lacks a level of '" + within.name + "'";
      return blocks;
    }
    auto& row = blocks.differences[b];
    const double origin = row.front();
    double mean = 0.0;
    for (auto& value : row) mean += (value -= origin) / static_cast<double>(num_levels);
    for (auto& value : row) value -= mean;
  }
  return blocks;
}

// Means of the rows that `chosen` picks.
template <typename Chosen>
std::vector<double> mean_row(const Blocks& blocks, std::size_t num_levels, std::size_t num_rows, Chosen chosen) {
  std::vector<double> mean(num_levels, 0.0);
  for (std::size_t b = 0; b < blocks.differences.size(); ++b) {
    if (!chosen(b)) continue;
    for (std::size_t l = 0; l < num_levels; ++l) mean[l] += blocks.differences[b][l];
  }
  for (auto& value : mean) value /= static_cast<double>(num_rows);
  return mean;
}

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

AnovaTable anova(std::span<const double> response, std::span<const Factor> factors,
                 std::span<const std::vector<std::size_t>> terms, SumsOfSquares type) {
  require_finite(response, "anova");
  const CellModel model{response.size(), factors, terms, type};
  const auto standardized = standardize(response);

  AnovaTable table;
  table.type = type;
  table.observations = response.size();
  table.balanced = model.balanced();
  table.empty_cells = model.empty_cells();
  for (const auto& term : model.terms()) {
    table.terms.push_back({term.name, term.df});
    if (!term.reason.empty()) test_term(table.terms.back(), 0.0, 0.0, 0, term.reason);
  }
  if (!model.reason().empty()) return table;

  const auto cells = model.summarize(standardized.values);
  const double residual = cells.within + model.lack_of_fit(cells.weighted_means);
  const bool no_spread = residual <= negligible_sum_of_squares(standardized.rounding, response.size());
  table.residual_df = model.residual_df();
  table.residual_sum_of_squares = std::ldexp(residual, 2 * standardized.exponent);
  table.residuals = residuals_of(model, standardized, cells.weighted_means);
  for (std::size_t t = 0; t < table.terms.size(); ++t) {
    auto reason = model.terms()[t].reason;
    if (reason.empty() && no_spread)
      reason = model.saturated() ? "no spread within the cells" : "no spread around the model's values";
    const double sum_of_squares = model.term_sum_of_squares(t, cells.weighted_means);
    table.terms[t].sum_of_squares = std::ldexp(sum_of_squares, 2 * standardized.exponent);
    test_term(table.terms[t], sum_of_squares, residual, table.residual_df, reason);
  }
  return table;
}

Estimable<AnovaTable> blocked_anova(std::span<const double> response, const Factor& within, const Factor& between,
                                    const Factor& block) {
  require_finite(response, "blocked_anova");
  for (const auto* factor : {&within, &between, &block}) require_codes(*factor, response.size(), "blocked_anova");
  using Result = Estimable<AnovaTable>;
  const auto levels = drop_unused(within);
  const auto groups = drop_unused(between);
  if (response.empty()) return Result::impossible("no observations");
  if (levels.levels.size() < 2) return Result::impossible("only one level of '" + within.name + "' has observations");
  const auto standardized = standardize(response);
  const auto blocks = gather_blocks(standardized.values, levels, groups, drop_unused(block));
  if (!blocks.reason.empty()) return Result::impossible(blocks.reason);

  const auto num_levels = levels.levels.size();
  const auto num_blocks = blocks.group.size();
  const auto num_groups = groups.levels.size();
  const auto overall = mean_row(blocks, num_levels, num_blocks, [](std::size_t) { return true; });
  const double of_within = static_cast<double>(num_blocks) * squared_distance(overall, std::vector(num_levels, 0.0));
  double of_interaction = 0.0;
  double residual = 0.0;
  std::vector<std::vector<double>> expected;
  std::vector<std::size_t> sizes;
  for (std::size_t g = 0; g < num_groups; ++g) {
    sizes.push_back(static_cast<std::size_t>(std::count(blocks.group.begin(), blocks.group.end(), g)));
    expected.push_back(mean_row(blocks, num_levels, sizes[g], [&](std::size_t b) { return blocks.group[b] == g; }));
    of_interaction += static_cast<double>(sizes[g]) * squared_distance(expected[g], overall);
  }
  for (std::size_t b = 0; b < num_blocks; ++b)
    residual += squared_distance(blocks.differences[b], expected[blocks.group[b]]);

  AnovaTable table;
  table.observations = response.size();
  table.balanced = std::all_of(sizes.begin(), sizes.end(), [&](std::size_t size) { return size == sizes.front(); });
  table.residual_df = (num_levels - 1) * (num_blocks - num_groups);
  table.residual_sum_of_squares = std::ldexp(residual, 2 * standardized.exponent);
  const auto blocks_of = drop_unused(block);
  for (std::size_t i = 0; i < response.size(); ++i) {
    const auto b = blocks_of.codes[i];
    const double rest = blocks.differences[b][levels.codes[i]] - expected[blocks.group[b]][levels.codes[i]];
    table.residuals.push_back(std::ldexp(rest, standardized.exponent));
  }
  std::string reason;
  if (table.residual_df == 0) {
    reason = "no residual degrees of freedom: one block in every group";
  } else if (residual <= negligible_sum_of_squares(standardized.rounding, response.size())) {
    reason = "no spread within the blocks beyond what the groups have in common";
  }
  const auto add = [&](std::string name, std::size_t df, double sum_of_squares, const std::string& why_not) {
    table.terms.push_back({std::move(name), df, std::ldexp(sum_of_squares, 2 * standardized.exponent)});
    test_term(table.terms.back(), sum_of_squares, residual, table.residual_df, why_not);
  };
  add(within.name, num_levels - 1, of_within, reason);
  add(within.name + ":" + between.name, (num_levels - 1) * (num_groups - 1), of_interaction,
      num_groups < 2 ? "only one level of '" + between.name + "' has observations" : reason);
  return table;
}

Estimable<NormalityCheck> check_normality(std::span<const double> residuals) {
  require_finite(residuals, "check_normality");
  using Result = Estimable<NormalityCheck>;
  if (residuals.size() < 3) return Result::impossible("fewer than three residuals");
  const auto standardized = standardize(residuals);
  const auto n = static_cast<double>(residuals.size());
  double second = 0.0;
  double third = 0.0;
  double fourth = 0.0;
  for (const double value : standardized.values) {
    const double square = value * value;
    second += square / n;
    third += square * value / n;
    fourth += square * square / n;
  }
  if (second * n <= negligible_sum_of_squares(standardized.rounding, residuals.size()))
    return Result::impossible("all residuals are equal");
  NormalityCheck check;
  check.skewness = third / (second * std::sqrt(second));
  check.excess_kurtosis = fourth / (second * second) - 3.0;
  const double statistic =
      n / 6.0 * (check.skewness * check.skewness + check.excess_kurtosis * check.excess_kurtosis / 4.0);
  check.test = {"chi-squared", statistic, {2.0}, chi_squared_upper(statistic, 2.0)};
  return check;
}

}  // namespace kith
