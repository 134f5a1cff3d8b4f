#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "blocks.hpp"
#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

// Blocks of standardised values, and the factors without what nobody has.
struct GatheredBlocks {
  Factor levels, groups, people;
  StandardizedResponse response;
  Blocks blocks{};
  BlockSpread spread{};
  std::string no_errors{};  // why no term has a test; empty if they have
};

template <typename Chosen>
std::vector<double> mean_row(const Blocks& blocks, std::size_t num_rows, Chosen chosen) {
  std::vector<double> mean(blocks.rows.front().size(), 0.0);
  for (std::size_t b = 0; b < blocks.rows.size(); ++b) {
    if (!chosen(b)) continue;
    for (std::size_t l = 0; l < mean.size(); ++l) mean[l] += blocks.rows[b][l];
  }
  for (auto& value : mean) value /= static_cast<double>(num_rows);
  return mean;
}

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// Puts the values into rows; returns what is wrong with the blocks, if anything is.
std::string fill_rows(GatheredBlocks& all) {
  const auto &levels = all.levels, &groups = all.groups, &people = all.people;
  const auto& response = all.response;
  const auto num_levels = levels.levels.size(), unknown = groups.levels.size();
  if (response.values.empty()) return "no observations";
  if (num_levels < 2) return "only one level of '" + levels.name + "' has observations";
  all.blocks = {std::vector(people.levels.size(), std::vector<double>(num_levels, 0.0)),
                std::vector(people.levels.size(), unknown)};
  std::vector<std::vector<bool>> seen(people.levels.size(), std::vector<bool>(num_levels, false));
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    const auto b = people.codes[i], level = levels.codes[i];
    auto& group = all.blocks.group[b];
    if (group == unknown) group = groups.codes[i];
    if (group != groups.codes[i])
      return "block '" + people.levels[b] + "' has more than one level of '" + groups.name + "'";
    if (seen[b][level])
      return "block '" + people.levels[b] + "' has level '" + levels.levels[level] + "' of '" + levels.name +
             "' more than once";
    seen[b][level] = true;
    all.blocks.rows[b][level] = response.values[i];
  }
  for (std::size_t b = 0; b < seen.size(); ++b) {
    const auto missing = std::find(seen[b].begin(), seen[b].end(), false);
    if (missing != seen[b].end())
      return "block '" + people.levels[b] + "' lacks level '" +
             levels.levels[static_cast<std::size_t>(missing - seen[b].begin())] + "' of '" + levels.name + "'";
    subtract_mean(all.blocks.rows[b]);
  }
  return "";
}

Estimable<GatheredBlocks> gather_blocks(std::span<const double> response, const Factor& within, const Factor& between,
                                        const Factor& block, const char* caller) {
  require_finite(response, caller);
  for (const auto* factor : {&within, &between, &block}) require_codes(*factor, response.size(), caller);
  GatheredBlocks all{drop_unused(within), drop_unused(between), drop_unused(block), standardize(response)};
  if (const auto fault = fill_rows(all); !fault.empty()) return Estimable<GatheredBlocks>::impossible(fault);
  all.spread = spread_of(all.blocks, all.groups.levels.size());
  if (all.people.levels.size() == all.groups.levels.size()) {
    all.no_errors = "no residual degrees of freedom: one block in every group";
  } else if (all.spread.residual <= negligible_sum_of_squares(all.response.rounding, response.size())) {
    all.no_errors = "no spread within the blocks beyond what their group has in common";
  }
  return all;
}

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

double subtract_mean(std::vector<double>& row) {
  const double origin = row.front();  // Equal values differ from their mean by exactly 0.
  double mean = 0.0;
  for (auto& value : row) mean += (value -= origin) / static_cast<double>(row.size());
  for (auto& value : row) value -= mean;
  return origin + mean;
}

BlockSpread spread_of(const Blocks& blocks, std::size_t num_groups) {
  const auto num_blocks = blocks.group.size();
  const auto overall = mean_row(blocks, num_blocks, [](std::size_t) { return true; });
  BlockSpread spread;
  spread.of_within = static_cast<double>(num_blocks) * squared_distance(overall, std::vector(overall.size(), 0.0));
  for (std::size_t g = 0; g < num_groups; ++g) {
    const auto size = static_cast<std::size_t>(std::count(blocks.group.begin(), blocks.group.end(), g));
    spread.sizes.push_back(size);
    spread.expected.push_back(mean_row(blocks, size, [&](std::size_t b) { return blocks.group[b] == g; }));
    spread.of_interaction += static_cast<double>(size) * squared_distance(spread.expected[g], overall);
  }
  for (std::size_t b = 0; b < num_blocks; ++b)
    spread.residual += squared_distance(blocks.rows[b], spread.expected[blocks.group[b]]);
  return spread;
}

Eigen::MatrixXd covariances_of(const Blocks& blocks, const BlockSpread& spread) {
  const auto k = static_cast<Eigen::Index>(blocks.rows.front().size());
  Eigen::MatrixXd covariances = Eigen::MatrixXd::Zero(k, k);
  for (std::size_t b = 0; b < blocks.rows.size(); ++b) {
    const Eigen::Map<const Eigen::VectorXd> row{blocks.rows[b].data(), k},
        expected{spread.expected[blocks.group[b]].data(), k};
    const Eigen::VectorXd rest = row - expected;
    covariances += rest * rest.transpose();
  }
  return covariances;
}

double greenhouse_geisser(const Eigen::MatrixXd& covariances) {
  const auto p = static_cast<double>(covariances.rows() - 1);
  const double trace = covariances.trace(), squares = covariances.squaredNorm();
  return squares > 0.0 ? std::clamp(trace * trace / (p * squares), 1.0 / p, 1.0) : 1.0;
}

Estimable<Sphericity> check_sphericity(std::span<const double> response, const Factor& within, const Factor& between,
                                       const Factor& block) {
  using Result = Estimable<Sphericity>;
  const auto gathered = gather_blocks(response, within, between, block, "check_sphericity");
  if (!gathered) return Result::impossible(gathered.reason());
  if (!gathered->no_errors.empty()) return Result::impossible(gathered->no_errors);
  const auto covariances = covariances_of(gathered->blocks, gathered->spread);
  const auto k = covariances.rows();
  const auto p = static_cast<double>(k - 1);
  const auto df = static_cast<double>(gathered->people.levels.size() - gathered->groups.levels.size());
  Sphericity result;
  result.greenhouse_geisser = greenhouse_geisser(covariances);
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
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{covariances, Eigen::EigenvaluesOnly};
  const Eigen::VectorXd values = solver.eigenvalues().tail(k - 1).cwiseMax(0.0);
  result.mauchly_w = std::min(1.0, std::exp((values / values.mean()).array().log().sum()));
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
  const auto gathered = gather_blocks(response, within, between, block, "blocked_anova");
  if (!gathered) return Estimable<AnovaTable>::impossible(gathered.reason());
  const auto &levels = gathered->levels, &groups = gathered->groups, &people = gathered->people;
  const auto& blocks = gathered->blocks;
  const auto& spread = gathered->spread;
  const auto df = levels.levels.size() - 1, interaction_df = df * (groups.levels.size() - 1);
  const auto in_units = [&](double square) { return std::ldexp(square, 2 * gathered->response.exponent); };
  AnovaTable table;
  table.observations = response.size();
  table.balanced = std::ranges::all_of(spread.sizes, [&](std::size_t size) { return size == spread.sizes.front(); });
  table.residual_df = df * (people.levels.size() - groups.levels.size());
  table.residual_sum_of_squares = in_units(spread.residual);
  for (std::size_t i = 0; i < response.size(); ++i) {
    const auto b = people.codes[i], level = levels.codes[i];
    table.residuals.push_back(
        std::ldexp(blocks.rows[b][level] - spread.expected[blocks.group[b]][level], gathered->response.exponent));
  }
  table.terms.push_back({within.name, df, in_units(spread.of_within)});
  test_term(table.terms.back(), spread.of_within, spread.residual, table.residual_df, gathered->no_errors);
  table.terms.push_back({within.name + ":" + between.name, interaction_df, in_units(spread.of_interaction)});
  test_term(table.terms.back(), spread.of_interaction, spread.residual, table.residual_df,
            interaction_df == 0 ? "only one level of '" + between.name + "' has observations" : gathered->no_errors);
  return table;
}

}  // namespace kith
