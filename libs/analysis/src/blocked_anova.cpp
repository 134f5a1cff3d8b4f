#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/distributions.hpp"

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

Estimable<Blocks> blocks_of(std::span<const double> standardized, const Factor& levels, const Factor& groups,
                            const Factor& people) {
  using Result = Estimable<Blocks>;
  if (standardized.empty()) return Result::impossible("no observations");
  if (levels.levels.size() < 2) return Result::impossible("only one level of '" + levels.name + "' has observations");
  auto blocks = gather_blocks(standardized, levels, groups, people);
  if (!blocks.reason.empty()) return Result::impossible(blocks.reason);
  return blocks;
}

void require_blocks(std::span<const double> response, const Factor& within, const Factor& between, const Factor& block,
                    const char* function) {
  require_finite(response, function);
  for (const auto* factor : {&within, &between, &block}) require_codes(*factor, response.size(), function);
}

constexpr const char* kNoSpread = "no spread within the blocks beyond what their group has in common";
constexpr const char* kNoResidual = "no residual degrees of freedom: one block in every group";

// The chi-squared of Box's expansion to second order, as R's mauchly.test. `df` are those of the covariances.
TestResult mauchly_test(double w, double contrasts, double df) {
  const double p = contrasts;
  const double rho = 1.0 - (2.0 * p * p + p + 2.0) / (6.0 * p * df);
  const double second = (p + 2.0) * (p - 1.0) * (p - 2.0) * (2.0 * p * p * p + 6.0 * p * p + 3.0 * p + 2.0) /
                        (288.0 * (df * p * rho) * (df * p * rho));
  const double statistic = -df * rho * std::log(w);
  const double chi_df = p * (p + 1.0) / 2.0 - 1.0;
  const double first = chi_squared_upper(statistic, chi_df);
  const double corrected = first + second * (chi_squared_upper(statistic, chi_df + 4.0) - first);
  return {"chi-squared", statistic, {chi_df}, std::clamp(corrected, 0.0, 1.0)};
}

}  // namespace

Estimable<Sphericity> check_sphericity(std::span<const double> response, const Factor& within, const Factor& between,
                                       const Factor& block) {
  using Result = Estimable<Sphericity>;
  require_blocks(response, within, between, block, "check_sphericity");
  const auto levels = drop_unused(within);
  const auto groups = drop_unused(between);
  const auto standardized = standardize(response);
  const auto blocks = blocks_of(standardized.values, levels, groups, drop_unused(block));
  if (!blocks) return Result::impossible(blocks.reason());
  const auto split = split_spread(*blocks, groups.levels.size());
  const auto num_blocks = blocks->group.size();
  if (num_blocks == groups.levels.size()) return Result::impossible(kNoResidual);
  if (split.residual <= negligible_sum_of_squares(standardized.rounding, response.size()))
    return Result::impossible(kNoSpread);

  const auto k = static_cast<Eigen::Index>(levels.levels.size());
  const auto p = static_cast<double>(k - 1);
  const auto df = static_cast<double>(num_blocks - groups.levels.size());
  // Covariances of the levels less the blocks' means: of rank k - 1, with the eigenvalues that orthonormal contrasts
  // of the levels have.
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(k, k);
  for (std::size_t b = 0; b < num_blocks; ++b) {
    Eigen::VectorXd rest(k);
    for (Eigen::Index l = 0; l < k; ++l) {
      const auto level = static_cast<std::size_t>(l);
      rest(l) = blocks->differences[b][level] - split.expected[blocks->group[b]][level];
    }
    covariance += rest * rest.transpose() / df;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{covariance, Eigen::EigenvaluesOnly};
  const Eigen::VectorXd values = solver.eigenvalues().tail(k - 1).cwiseMax(0.0);
  const double mean = values.mean();
  Sphericity result;
  result.greenhouse_geisser = std::clamp(mean * mean * p / values.squaredNorm(), 1.0 / p, 1.0);
  const double shrunk = p * result.greenhouse_geisser;
  result.huynh_feldt =
      df > shrunk ? std::clamp(((df + 1.0) * shrunk - 2.0) / (p * (df - shrunk)), result.greenhouse_geisser, 1.0) : 1.0;
  if (k == 2) {
    result.mauchly = Estimable<TestResult>::impossible("two levels are always spherical");
    return result;
  }
  if (df < p) {
    result.mauchly_w = 0.0;
    result.mauchly = Estimable<TestResult>::impossible("fewer blocks than Mauchly's test needs for so many levels");
    return result;
  }
  result.mauchly_w = std::min(1.0, std::exp((values / mean).array().log().sum()));
  if (!(result.mauchly_w > 0.0)) {
    result.mauchly = Estimable<TestResult>::impossible("some levels have no spread within the blocks between them");
    return result;
  }
  result.mauchly = mauchly_test(result.mauchly_w, p, df);
  return result;
}

TestResult correct_for_sphericity(const TestResult& test, double epsilon) {
  if (test.statistic_name != "F" || test.df.size() != 2)
    throw std::invalid_argument{"correct_for_sphericity: an F test is needed"};
  if (!(epsilon > 0.0 && epsilon <= 1.0))
    throw std::invalid_argument{"correct_for_sphericity: epsilon must be in (0, 1]"};
  const double df1 = epsilon * test.df[0];
  const double df2 = epsilon * test.df[1];
  return {"F", test.statistic, {df1, df2}, f_upper(test.statistic, df1, df2)};
}

Estimable<AnovaTable> blocked_anova(std::span<const double> response, const Factor& within, const Factor& between,
                                    const Factor& block) {
  require_blocks(response, within, between, block, "blocked_anova");
  using Result = Estimable<AnovaTable>;
  const auto levels = drop_unused(within);
  const auto groups = drop_unused(between);
  const auto people = drop_unused(block);
  const auto standardized = standardize(response);
  const auto gathered = blocks_of(standardized.values, levels, groups, people);
  if (!gathered) return Result::impossible(gathered.reason());
  const auto& blocks = *gathered;
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
    reason = kNoResidual;
  } else if (split.residual <= negligible_sum_of_squares(standardized.rounding, response.size())) {
    reason = kNoSpread;
  }
  table.terms.push_back({within.name, df, in_units(split.of_within)});
  test_term(table.terms.back(), split.of_within, split.residual, table.residual_df, reason);
  const auto interaction_df = df * (groups.levels.size() - 1);
  if (interaction_df == 0) reason = "only one level of '" + between.name + "' has observations";
  table.terms.push_back({within.name + ":" + between.name, interaction_df, in_units(split.of_interaction)});
  test_term(table.terms.back(), split.of_interaction, split.residual, table.residual_df, reason);
  return table;
}

}  // namespace kith
