#include "evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/study/study_memory.hpp"

namespace kith {
namespace {

// Count, mean and sum of squared deviations, which can be merged and taken apart.
struct Moments {
  double n = 0.0;
  double sum = 0.0;      // of values less the shift
  double squares = 0.0;  // of values less the shift

  void add(double value) {
    n += 1.0;
    sum += value;
    squares += value * value;
  }
  [[nodiscard]] Moments less(const Moments& other) const {
    return {n - other.n, sum - other.sum, squares - other.squares};
  }
  [[nodiscard]] double mean() const { return n > 0.0 ? sum / n : 0.0; }
  [[nodiscard]] double sd() const {
    return n > 1.0 ? std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1.0))) : 0.0;
  }
};

}  // namespace

Evaluation evaluate(std::span<const Target> targets, std::span<const TeamRecord> teams, std::size_t replicates) {
  Evaluation result;
  result.without.assign(replicates, {});
  for (const auto& target : targets) {
    Moments all;
    std::vector<Moments> by_replicate(replicates);
    double shift = 0.0;  // the first value: sums of squares do not cancel
    for (const auto& team : teams) {
      if (!target.teams.contains(team.address)) continue;
      const double value = value_of(team, target.quantity);
      if (all.n == 0.0) shift = value;
      all.add(value - shift);
      by_replicate.at(team.address.replicate - 1).add(value - shift);
    }
    const auto figure = [&](const Moments& some) {
      return target.statistic == Statistic::kMean ? shift + some.mean() : some.sd();
    };
    result.figures.push_back(figure(all));
    for (std::size_t r = 0; r < replicates; ++r) result.without[r].push_back(figure(all.less(by_replicate[r])));
  }
  return result;
}

double jackknife_error(std::span<const double> without) {
  const auto n = static_cast<double>(without.size());
  double mean = 0.0;
  for (const double value : without) mean += value / n;
  double sum = 0.0;
  for (const double value : without) sum += (value - mean) * (value - mean);
  return std::sqrt((n - 1.0) / n * sum);
}

std::vector<double> misses_of(std::span<const Target> targets, std::span<const double> figures) {
  std::vector<double> misses;
  for (std::size_t i = 0; i < targets.size(); ++i) misses.push_back(miss(targets[i], figures[i]));
  return misses;
}

CalibrationPoint point_of(std::span<const Target> targets, const Evaluation& evaluation, std::vector<double> values,
                          std::string label) {
  CalibrationPoint point;
  point.label = std::move(label);
  point.values = std::move(values);
  point.teams_per_cell = evaluation.without.size();
  const auto misses = misses_of(targets, evaluation.figures);
  std::vector<double> without(evaluation.without.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    for (std::size_t r = 0; r < without.size(); ++r) without[r] = evaluation.without[r][i];
    point.targets.push_back({evaluation.figures[i], jackknife_error(without), misses[i]});
  }
  for (std::size_t r = 0; r < without.size(); ++r)
    without[r] = discrepancy(targets, misses_of(targets, evaluation.without[r]));
  point.discrepancy = discrepancy(targets, misses);
  point.standard_error = jackknife_error(without);
  return point;
}

double difference_error(std::span<const Target> targets, const Evaluation& a, const Evaluation& b) {
  std::vector<double> without;
  for (std::size_t r = 0; r < a.without.size(); ++r) {
    without.push_back(discrepancy(targets, misses_of(targets, a.without[r])) -
                      discrepancy(targets, misses_of(targets, b.without[r])));
  }
  return jackknife_error(without);
}

Laboratory::Laboratory(const Atlas& atlas, const StudyMaker& make_study, const TargetSet& set,
                       const CalibrationOptions& options)
    : atlas_{atlas}, make_study_{make_study}, set_{set}, options_{options} {
  const auto reading = make_study_({});
  if (!reading.study) throw Error{reading.diagnostics};
  const auto& spec = reading.study->variants.front();
  cells_ = spec.strategies.size() * spec.compositions.size();
  // The largest batch, which may be the last: nobody wants to learn after hours that it does not fit.
  const auto largest = std::max({cost(options_.points, options_.teams), cost(3, options_.confirm_teams),
                                 cost(options_.frontier_points, options_.confirm_teams / 2)});
  Study study{{spec}};
  study.variants.front().record = RecordLevel::kTeam;
  require_study_memory(study, options_.threads, largest);
}

std::optional<std::vector<Evaluation>> Laboratory::run(const std::vector<std::vector<double>>& settings,
                                                       std::size_t teams, std::uint64_t seed) {
  Study study;
  for (const auto& values : settings) {
    const auto reading = make_study_(overrides_of(set_.parameters, values));
    if (!reading.study) throw Error{reading.diagnostics};
    auto spec = reading.study->variants.front();
    spec.replicates = teams;
    spec.seed = seed;
    spec.record = RecordLevel::kTeam;
    study.variants.push_back(std::move(spec));
  }
  RunOptions run{.threads = options_.threads, .on_progress = {}};
  if (options_.on_progress) {
    run.on_progress = [&](std::size_t done, std::size_t) {
      return options_.on_progress(done_ + done, std::max(total_, done_ + done));
    };
  }
  const auto addresses = team_addresses(study);
  const auto result = run_teams(atlas_, study, addresses, run);
  if (result.teams.size() < addresses.size()) return std::nullopt;
  done_ += result.teams.size();
  const auto per_setting = addresses.size() / settings.size();
  std::vector<Evaluation> evaluations;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    evaluations.push_back(evaluate(set_.targets, std::span{result.teams}.subspan(i * per_setting, per_setting), teams));
  }
  return evaluations;
}

}  // namespace kith
