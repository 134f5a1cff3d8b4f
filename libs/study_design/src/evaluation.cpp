#include "evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/stats/moments.hpp"
#include "kith/study_design/power.hpp"
#include "study_tests.hpp"

namespace kith {
namespace {

// A figure of all teams and without each replicate; both with their own number of them.
struct Figures {
  double all = 0.0;
  std::vector<double> without;  // [replicates]
};

Figures pooled_figures(const Target& target, const TeamPool& pool) {
  PowerSums all;
  std::vector<PowerSums> by_replicate(pool.replicates());
  double shift = 0.0;  // the first value: sums of squares do not cancel
  for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
    for (std::size_t c = 0; c < pool.compositions().size(); ++c) {
      if (!is_selected(pool, target.teams, s, c)) continue;
      const auto cell = pool.cell(target.quantity, s, c);
      if (all.n == 0.0) shift = cell.front();
      for (std::size_t r = 0; r < cell.size(); ++r) {
        all.add(cell[r] - shift);
        by_replicate[r].add(cell[r] - shift);
      }
    }
  }
  const auto figure = [&](const PowerSums& some) {
    return target.statistic == Statistic::kMean ? shift + some.mean() : std::sqrt(some.variance());
  };
  Figures figures{figure(all), {}};
  for (const auto& replicate : by_replicate) figures.without.push_back(figure(all.without(replicate)));
  return figures;
}

// The F expected at the published degrees of freedom if the effect is as large as in the pool.
Figures term_figures(const Target& target, const TeamPool& pool) {
  const auto cells = cells_of(pool, *target.effect);
  const auto num_cells = static_cast<double>(cells.groups.size() * cells.compositions.size());
  std::vector<std::vector<PowerSums>> all;
  for (const auto s : cells.groups) {
    all.emplace_back();
    for (const auto c : cells.compositions) {
      PowerSums moments;
      for (const double value : pool.cell(target.quantity, s, c)) moments.add(value);
      all.back().push_back(moments);
    }
  }
  const auto expected = [&](std::optional<std::size_t> left_out) {
    std::vector<std::vector<double>> means;
    double variance = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      means.emplace_back();
      for (std::size_t j = 0; j < all[i].size(); ++j) {
        auto moments = all[i][j];
        if (left_out) {
          PowerSums one;
          one.add(pool.cell(target.quantity, cells.groups[i], cells.compositions[j])[*left_out]);
          moments = moments.without(one);
        }
        means.back().push_back(moments.mean());
        variance += moments.variance() / num_cells;
      }
    }
    const double eta = eta_squared(means, variance, pool.replicates() - (left_out ? 1 : 0), *target.effect);
    const double non_centrality = eta < 1.0 ? eta / (1.0 - eta) * (target.df2 + num_cells) : 0.0;
    return f_moments(target.df1, target.df2, non_centrality).mean;
  };
  Figures figures{expected({}), {}};
  for (std::size_t r = 0; r < pool.replicates(); ++r) figures.without.push_back(expected(r));
  return figures;
}

}  // namespace

Evaluation evaluate(std::span<const Target> targets, const TeamPool& pool) {
  Evaluation result;
  result.without.assign(pool.replicates(), {});
  for (const auto& target : targets) {
    const auto figures = target.effect ? term_figures(target, pool) : pooled_figures(target, pool);
    result.figures.push_back(figures.all);
    for (std::size_t r = 0; r < pool.replicates(); ++r) result.without[r].push_back(figures.without[r]);
  }
  return result;
}

Eigen::MatrixXd covariance_of(std::span<const Target> targets, const Evaluation& evaluation) {
  const auto n = static_cast<Eigen::Index>(evaluation.without.size());
  Eigen::MatrixXd values(n, static_cast<Eigen::Index>(targets.size()));
  for (Eigen::Index r = 0; r < n; ++r) {
    for (Eigen::Index t = 0; t < values.cols(); ++t) {
      const auto& target = targets[static_cast<std::size_t>(t)];
      const double figure = evaluation.without[static_cast<std::size_t>(r)][static_cast<std::size_t>(t)];
      values(r, t) = compared(target, figure) / published_error(target);
    }
  }
  const Eigen::RowVectorXd mean = values.colwise().mean();
  values.rowwise() -= mean;
  return values.transpose() * values * (static_cast<double>(n) - 1.0) / static_cast<double>(n);
}

std::vector<double> misses_of(std::span<const Target> targets, std::span<const double> figures) {
  std::vector<double> misses;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    misses.push_back((compared(targets[i], figures[i]) - compared(targets[i], targets[i].value)) /
                     published_error(targets[i]));
  }
  return misses;
}

CalibrationPoint point_of(std::span<const Target> targets, const Evaluation& evaluation, std::vector<double> values,
                          std::string label) {
  CalibrationPoint point;
  point.label = std::move(label);
  point.values = std::move(values);
  point.teams_per_cell = evaluation.without.size();
  const auto misses = misses_of(targets, evaluation.figures);
  const auto covariance = covariance_of(targets, evaluation);
  std::vector<double> without(evaluation.without.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    for (std::size_t r = 0; r < without.size(); ++r) without[r] = evaluation.without[r][i];
    const auto place = static_cast<Eigen::Index>(i);
    point.targets.push_back({.model = evaluation.figures[i],
                             .standard_error = jackknife_error(without),
                             .misfit = misses[i] / std::sqrt(1.0 + covariance(place, place)),
                             .miss = miss(targets[i], evaluation.figures[i])});
  }
  return point;
}

Laboratory::Laboratory(const Atlas& atlas, const StudyMaker& make_study, const TargetSet& set,
                       const CalibrationOptions& options)
    : atlas_{atlas}, make_study_{make_study}, set_{set}, options_{options} {
  const auto reading = make_study_({});
  if (!reading.study) throw Error{reading.diagnostics};
  const auto& spec = reading.study->variants.front();
  cells_ = spec.strategies.size() * spec.compositions.size();
  // The largest batch, which may be the last: refuse it now and not after hours.
  const auto largest = std::max({cost(options_.points, options_.teams), cost(3, options_.confirm_teams),
                                 cost(options_.frontier_points, options_.confirm_teams / 2)});
  for (const auto& target : set_.targets) quantities_.push_back(target.quantity);
  require_pool_memory(Study{{recording(spec, quantities_)}}, options_.threads, largest);
}

std::optional<std::vector<Evaluation>> Laboratory::run(const std::vector<std::vector<double>>& settings,
                                                       std::size_t teams, std::uint64_t seed) {
  Study study;
  for (const auto& values : settings) {
    const auto reading = make_study_(overrides_of(set_.parameters, values));
    if (!reading.study) throw Error{reading.diagnostics};
    auto spec = recording(reading.study->variants.front(), quantities_);
    spec.replicates = teams;
    spec.seed = seed;
    study.variants.push_back(std::move(spec));
  }
  RunOptions run{.threads = options_.threads, .on_progress = {}};
  if (options_.on_progress) {
    run.on_progress = [&](std::size_t done, std::size_t) {
      return options_.on_progress(done_ + done, std::max(total_, done_ + done));
    };
  }
  const auto pools = simulate_pools(atlas_, study, run);
  if (!pools) return std::nullopt;
  done_ += num_teams(study);
  std::vector<Evaluation> evaluations;
  for (const auto& pool : *pools) evaluations.push_back(evaluate(set_.targets, pool));
  return evaluations;
}

}  // namespace kith
