#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "component_paths.hpp"
#include "kith/core/integer_vector.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith::detail {

// What the robot, if it has a say, weighs among equally good choices; no weights: it has none.
using RobotWeights = std::optional<std::span<const double>>;

// Follows the best paths of an exact process, given the values of its states.
class PathFollower {
 public:
  // One choice of a state.
  struct Step {
    std::uint32_t choice = 0;
    std::uint32_t next = 0;
    std::uint32_t feature_row = 0;
    bool has_equals = false;  // later choices are optimal, too
  };

  PathFollower(const Mdp& mdp, std::span<const double> rewards, std::span<const double> values, double tolerance)
      : mdp_{mdp}, rewards_{rewards}, values_{values}, tolerance_{tolerance}, steps_(mdp.num_states()) {}

  // The first optimal choice of a state.
  void find_step(std::size_t s) {
    const auto choices = mdp_.choices(StateIndex{s});
    bool found = false;
    for (std::uint32_t c = 0; c < choices.size() && !steps_[s].has_equals; ++c) {
      const Outcome& outcome = mdp_.outcomes(choices[c]).front();
      if (!is_optimal(s, outcome)) continue;
      if (found) {
        steps_[s].has_equals = true;
      } else {
        steps_[s] = {c, static_cast<std::uint32_t>(outcome.next.value()), outcome.feature_row, false};
        found = true;
      }
    }
  }

  // Counts of a state, and its choice: the one that the robot prefers if it has a say, else the first that is optimal.
  // @pre find_step(s); `counts` has those of the states that optimal choices lead to.
  const Step& follow(std::uint32_t s, const RobotWeights& robot, std::vector<IntegerVector>& counts) {
    if (robot && steps_[s].has_equals) prefer(s, *robot, counts);
    const Step& step = steps_[s];
    counts[s] = mdp_.integer_feature_row(step.feature_row);
    counts[s] += counts[step.next];
    return step;
  }

 private:
  [[nodiscard]] bool is_optimal(std::size_t s, const Outcome& outcome) const {
    const double candidate = rewards_[outcome.feature_row] + values_[outcome.next.value()];
    return is_tight(values_[s], candidate, tolerance_);
  }

  void prefer(std::size_t s, std::span<const double> robot, std::span<const IntegerVector> counts) {
    const auto choices = mdp_.choices(StateIndex{s});
    const auto earned = [&](std::size_t row, std::size_t next) {
      return dot(mdp_.integer_feature_row(row) + counts[next], robot);
    };
    double best = earned(steps_[s].feature_row, steps_[s].next);
    for (std::uint32_t c = steps_[s].choice + 1; c < choices.size(); ++c) {
      const Outcome& outcome = mdp_.outcomes(choices[c]).front();
      if (!is_optimal(s, outcome)) continue;
      const double candidate = earned(outcome.feature_row, outcome.next.value());
      if (candidate <= best + tolerance_ * std::max(1.0, std::abs(best))) continue;
      best = candidate;
      steps_[s] = {c, static_cast<std::uint32_t>(outcome.next.value()), outcome.feature_row, true};
    }
  }

  const Mdp& mdp_;
  std::span<const double> rewards_;
  std::span<const double> values_;
  double tolerance_;
  std::vector<Step> steps_;  // shape [num_states]
};

}  // namespace kith::detail
