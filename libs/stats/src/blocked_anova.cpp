#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/stats/anova.hpp"

namespace kith {
namespace {

// Responses by block and level of the factor within blocks, less the block's mean.
struct Blocks {
  std::vector<std::vector<double>> differences;  // [blocks][levels]
  std::vector<std::size_t> group;                // [blocks], level of the factor between blocks
  std::string reason;                            // Why the blocks cannot be used; empty if they can.
};

void subtract_mean(std::vector<double>& row) {
  const double origin = row.front();  // Equal values differ from their mean by exactly 0.
  double mean = 0.0;
  for (auto& value : row) mean += (value -= origin) / static_cast<double>(row.size());
  for (auto& value : row) value -= mean;
}

Blocks gather_blocks(std::span<const double> values, const Factor& within, const Factor& between, const Factor& block) {
  const auto num_levels = within.levels.size();
  const auto unknown = between.levels.size();
  Blocks blocks{std::vector(block.levels.size(), std::vector<double>(num_levels, 0.0)),
                std::vector(block.levels.size(), unknown),
                {}};
  std::vector<std::vector<bool>> seen(block.levels.size(), std::vector<bool>(num_levels, false));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto b = block.codes[i];
    const auto level = within.codes[i];
    if (blocks.group[b] == unknown) blocks.group[b] = between.codes[i];
    if (blocks.group[b] != between.codes[i]) {
      blocks.reason = "block '" + block.levels[b] + "' has more than one level of '" + between.name + "'";
      return blocks;
    }
    if (seen[b][level]) {
      blocks.reason = "block '" + block.levels[b] + "' has level '" + within.levels[level] + "' of '" + within.name +
                      "' more than once";
      return blocks;
    }
    seen[b][level] = true;
    blocks.differences[b][level] = values[i];
  }
  for (std::size_t b = 0; b < seen.size(); ++b) {
    const auto missing = std::find(seen[b].begin(), seen[b].end(), false);
    if (missing != seen[b].end()) {
      const auto& level = within.levels[static_cast<std::size_t>(missing - seen[b].begin())];
      blocks.reason = "block '" + block.levels[b] + "' lacks level '" + level + "' of '" + within.name + "'";
      return blocks;
    }
    subtract_mean(blocks.differences[b]);
  }
  return blocks;
}

// Means of the rows that `chosen` picks; the means of the levels.
template <typename Chosen>
std::vector<double> mean_row(const Blocks& blocks, std::size_t num_rows, Chosen chosen) {
  std::vector<double> mean(blocks.differences.front().size(), 0.0);
  for (std::size_t b = 0; b < blocks.differences.size(); ++b) {
    if (!chosen(b)) continue;
    for (std::size_t l = 0; l < mean.size(); ++l) mean[l] += blocks.differences[b][l];
  }
  for (auto& value : mean) value /= static_cast<double>(num_rows);
  return mean;
}

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// What the blocks' means leave, split into the factor, its interaction with the groups, and the rest.
struct Split {
  double of_within = 0.0;
  double of_interaction = 0.0;
  double residual = 0.0;
  std::vector<std::vector<double>> expected;  // [groups][levels]
  std::vector<std::size_t> sizes;             // [groups], blocks in each
};

Split split_spread(const Blocks& blocks, std::size_t num_groups) {
  const auto num_blocks = blocks.group.size();
  const auto overall = mean_row(blocks, num_blocks, [](std::size_t) { return true; });
  Split split;
  split.of_within = static_cast<double>(num_blocks) * squared_distance(overall, std::vector(overall.size(), 0.0));
  for (std::size_t g = 0; g < num_groups; ++g) {
    const auto size = static_cast<std::size_t>(std::count(blocks.group.begin(), blocks.group.end(), g));
    split.sizes.push_back(size);
    split.expected.push_back(mean_row(blocks, size, [&](std::size_t b) { return blocks.group[b] == g; }));
    split.of_interaction += static_cast<double>(size) * squared_distance(split.expected[g], overall);
  }
  for (std::size_t b = 0; b < num_blocks; ++b)
    split.residual += squared_distance(blocks.differences[b], split.expected[blocks.group[b]]);
  return split;
}

}  // namespace

Estimable<AnovaTable> blocked_anova(std::span<const double> response, const Factor& within, const Factor& between,
                                    const Factor& block) {
  require_finite(response, "blocked_anova");
  for (const auto* factor : {&within, &between, &block}) require_codes(*factor, response.size(), "blocked_anova");
  using Result = Estimable<AnovaTable>;
  const auto levels = drop_unused(within);
  const auto groups = drop_unused(between);
  const auto people = drop_unused(block);
  const auto only_one_level = [](const Factor& factor) {
    return "only one level of '" + factor.name + "' has observations";
  };
  if (response.empty()) return Result::impossible("no observations");
  if (levels.levels.size() < 2) return Result::impossible(only_one_level(within));
  const auto standardized = standardize(response);
  const auto blocks = gather_blocks(standardized.values, levels, groups, people);
  if (!blocks.reason.empty()) return Result::impossible(blocks.reason);
  const auto split = split_spread(blocks, groups.levels.size());

  const auto df = levels.levels.size() - 1;
  const auto in_units = [&](double square) { return std::ldexp(square, 2 * standardized.exponent); };
  AnovaTable table;
  table.observations = response.size();
  table.balanced = std::all_of(split.sizes.begin(), split.sizes.end(),
                               [&](std::size_t size) { return size == split.sizes.front(); });
  table.residual_df = df * (people.levels.size() - groups.levels.size());
  table.residual_sum_of_squares = in_units(split.residual);
  for (std::size_t i = 0; i < response.size(); ++i) {
    const auto b = people.codes[i];
    const auto level = levels.codes[i];
    const double rest = blocks.differences[b][level] - split.expected[blocks.group[b]][level];
    table.residuals.push_back(std::ldexp(rest, standardized.exponent));
  }
  std::string reason;
  if (table.residual_df == 0) {
    reason = "no residual degrees of freedom: one block in every group";
  } else if (split.residual <= negligible_sum_of_squares(standardized.rounding, response.size())) {
    reason = "no spread within the blocks beyond what their group has in common";
  }
  table.terms.push_back({within.name, df, in_units(split.of_within)});
  test_term(table.terms.back(), split.of_within, split.residual, table.residual_df, reason);
  const auto interaction_df = df * (groups.levels.size() - 1);
  if (interaction_df == 0) reason = only_one_level(between);
  table.terms.push_back({within.name + ":" + between.name, interaction_df, in_units(split.of_interaction)});
  test_term(table.terms.back(), split.of_interaction, split.residual, table.residual_df, reason);
  return table;
}

}  // namespace kith
