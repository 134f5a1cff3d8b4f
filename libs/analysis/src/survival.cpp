#include "kith/analysis/survival.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "checks.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

// Survival within this of 1/2 is taken as 1/2: products of fractions round. R uses the same.
constexpr double kHalfSlack = 1.4901161193847656e-8;

void check_observations(const std::string& function, std::span<const double> times, const std::vector<bool>& observed) {
  if (times.size() != observed.size())
    throw std::invalid_argument{function + ": one entry of observed per time is needed"};
  for (const double time : times) {
    if (!(time > 0.0) || !std::isfinite(time))
      throw std::invalid_argument{function + ": times must be positive and finite, not " + std::to_string(time)};
  }
}

std::vector<std::size_t> in_order_of_time(std::span<const double> times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return times[i]; });
  return order;
}

std::optional<double> median_of(const std::vector<SurvivalStep>& steps) {
  const auto half =
      std::ranges::find_if(steps, [](const SurvivalStep& step) { return step.survival < 0.5 + kHalfSlack; });
  if (half == steps.end()) return std::nullopt;
  if (std::abs(half->survival - 0.5) >= kHalfSlack) return half->time;
  const auto below =
      std::find_if(half, steps.end(), [&](const SurvivalStep& step) { return step.survival < half->survival; });
  return below == steps.end() ? half->time : (half->time + below->time) / 2.0;
}

// Groups are connected if some event compares them. The covariance matrix of the
// log-rank scores is a sum of Laplacians of complete graphs, so its rank is the number of groups less the number of
// connected parts: exact where a numerical rank would have to guess.
class ConnectedGroups {
 public:
  explicit ConnectedGroups(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  [[nodiscard]] std::size_t part_of(std::size_t group) const {
    while (parent_[group] != group) group = parent_[group];
    return group;
  }
  void connect(std::size_t a, std::size_t b) { parent_[part_of(a)] = part_of(b); }

 private:
  std::vector<std::size_t> parent_;
};

// What the log-rank test sums over event times and strata, one entry per group.
class LogRankSums {
 public:
  explicit LogRankSums(std::size_t groups)
      : excess_{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(groups))},
        expected_{excess_},
        covariance_{Eigen::MatrixXd::Zero(excess_.size(), excess_.size())},
        connected_{groups} {}

  // The observations of one stratum, ascending in time.
  void add_stratum(std::span<const std::size_t> order, std::span<const double> times, const std::vector<bool>& observed,
                   const std::vector<std::size_t>& groups) {
    Eigen::VectorXd at_risk = Eigen::VectorXd::Zero(excess_.size());
    for (const auto i : order) at_risk[static_cast<Eigen::Index>(groups[i])] += 1.0;
    for (std::size_t begin = 0; begin < order.size();) {
      Eigen::VectorXd leaving = Eigen::VectorXd::Zero(excess_.size());
      Eigen::VectorXd events = leaving;
      auto end = begin;
      for (; end < order.size() && times[order[end]] == times[order[begin]]; ++end) {
        const auto group = static_cast<Eigen::Index>(groups[order[end]]);
        leaving[group] += 1.0;
        if (observed[order[end]]) events[group] += 1.0;
      }
      if (events.sum() > 0.0) add_time(at_risk, events);
      at_risk -= leaving;
      begin = end;
    }
  }

  [[nodiscard]] Estimable<TestResult> test() const {
    using Result = Estimable<TestResult>;
    // As in R, a group that was gone before the first event takes no part.
    std::vector<Eigen::Index> compared;
    for (Eigen::Index group = 0; group < expected_.size(); ++group) {
      if (expected_[group] > 0.0) compared.push_back(group);
    }
    if (compared.empty()) return Result::impossible("no event was observed");
    if (compared.size() < 2) return Result::impossible("fewer than two groups were at risk when events happened");
    const auto part = connected_.part_of(static_cast<std::size_t>(compared.front()));
    const bool is_connected = std::ranges::all_of(
        compared, [&](Eigen::Index group) { return connected_.part_of(static_cast<std::size_t>(group)) == part; });
    if (!is_connected) return Result::impossible("no event compares some of the groups");
    compared.erase(compared.begin());  // the scores sum to zero, so one is redundant
    const Eigen::VectorXd excess = excess_(compared);
    const Eigen::MatrixXd covariance = covariance_(compared, compared);
    const double statistic = excess.dot(covariance.ldlt().solve(excess));
    const auto df = static_cast<double>(compared.size());
    return TestResult{"chi-squared", statistic, {df}, chi_squared_upper(std::max(statistic, 0.0), df)};
  }

 private:
  // The events of one time as a draw without replacement from those at risk (hypergeometric).
  void add_time(const Eigen::VectorXd& at_risk, const Eigen::VectorXd& events) {
    const double total = at_risk.sum();
    const double num_events = events.sum();
    const Eigen::VectorXd share = at_risk / total;
    excess_ += events - num_events * share;
    expected_ += num_events * share;
    if (num_events == total) return;  // all at once: no order to explain
    const double scale = num_events * (total - num_events) / (total - 1.0);
    covariance_.diagonal() += scale * share;
    covariance_ -= scale * share * share.transpose();
    Eigen::Index first = -1;
    for (Eigen::Index group = 0; group < share.size(); ++group) {
      if (at_risk[group] == 0.0) continue;
      if (first >= 0) connected_.connect(static_cast<std::size_t>(first), static_cast<std::size_t>(group));
      first = group;
    }
  }

  Eigen::VectorXd excess_;  // observed less expected events
  Eigen::VectorXd expected_;
  Eigen::MatrixXd covariance_;
  ConnectedGroups connected_;
};

}  // namespace

SurvivalCurve kaplan_meier(std::span<const double> times, const std::vector<bool>& observed, double confidence) {
  check_observations("kaplan_meier", times, observed);
  require_confidence(confidence, "kaplan_meier");
  const double z = normal_quantile(0.5 + confidence / 2.0);
  const auto order = in_order_of_time(times);
  SurvivalCurve curve;
  curve.observations = times.size();
  double survival = 1.0;
  double variance = 0.0;  // Greenwood's, of log S
  for (std::size_t begin = 0; begin < order.size();) {
    SurvivalStep step{times[order[begin]], order.size() - begin, 0, 1.0, 0.0, 1.0};
    for (; begin < order.size() && times[order[begin]] == step.time; ++begin) step.events += observed[order[begin]];
    const auto at_risk = static_cast<double>(step.at_risk);
    const double staying = at_risk - static_cast<double>(step.events);
    if (step.events > 0) {
      survival *= staying / at_risk;
      variance += (at_risk - staying) / (at_risk * std::max(staying, 1.0));
    }
    step.survival = survival;
    const double factor = std::exp(z * std::sqrt(variance));
    step.low = survival / factor;
    step.high = survival == 0.0 ? 0.0 : std::min(1.0, survival * factor);
    curve.events += step.events;
    curve.steps.push_back(step);
  }
  curve.median = median_of(curve.steps);
  return curve;
}

Estimable<TestResult> log_rank(std::span<const double> times, const std::vector<bool>& observed, const Factor& groups) {
  return log_rank(times, observed, groups, Factor{"all", {"all"}, std::vector<std::size_t>(times.size(), 0)});
}

Estimable<TestResult> log_rank(std::span<const double> times, const std::vector<bool>& observed, const Factor& groups,
                               const Factor& strata) {
  check_observations("log_rank", times, observed);
  require_codes(groups, times.size(), "log_rank");
  require_codes(strata, times.size(), "log_rank");
  std::vector<std::vector<std::size_t>> order_within(strata.levels.size());
  for (const auto i : in_order_of_time(times)) order_within[strata.codes[i]].push_back(i);
  LogRankSums sums{groups.levels.size()};
  for (const auto& order : order_within) sums.add_stratum(order, times, observed, groups.codes);
  return sums.test();
}

}  // namespace kith
