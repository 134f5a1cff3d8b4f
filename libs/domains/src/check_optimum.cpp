#include <algorithm>
#include <optional>

#include "family.hpp"
#include "kith/mdp/planner.hpp"
#include "state_layout.hpp"

namespace kith::detail {
namespace {

// Plans every MDP under the robot's weights and looks at the result.
class OptimumChecker {
 public:
  OptimumChecker(const FamilyMap& family_map, const Dynamics& dynamics, const Reward& reward, TomlReport& report)
      : family_map_{family_map}, dynamics_{dynamics}, reward_{reward}, report_{report}, layout_{family_map} {}

  void check(std::size_t number, const DomainMember& member) {
    const ExactPlan plan = plan_exactly(member.mdp, reward_.weights.integer);
    if (plan.solution) {
      num_ties_ += count_ties(member.mdp, *plan.solution, reward_.weights.integer);
      check_lengths(number, member, *plan.solution);
      return;
    }
    ++num_failures_;
    if (num_failures_ > 1) return;
    positive_ = plan.failure == PlanFailure::kPositiveCycle;
    cycle_text_ = cycle_text(member, plan.cycle);
    failing_world_ = world_text(family_map_, number);
  }

  void report(std::size_t num_mdps) {
    if (num_failures_ > 0) report_cycle(num_mdps);
    warn_of_ties(num_ties_, reward_.weights_place, report_);
    if (longest_ > dynamics_.max_steps) {
      report_.warning("W0303", reward_.weights_place,
                      "the longest optimal path has " + std::to_string(longest_) + " steps, but max_steps is " +
                          std::to_string(dynamics_.max_steps),
                      family_map_.groups.empty() ? "" : "the first: world " + world_text(family_map_, longest_world_));
    }
  }

 private:
  void report_cycle(std::size_t num_mdps) {
    std::string where;
    if (num_mdps > 1) {
      where = "; in " + std::to_string(num_failures_) + " of " + std::to_string(num_mdps) +
              " worlds, first in: " + failing_world_;
    }
    if (positive_) {
      report_.infeasible("E0321", reward_.weights_place,
                         "the robot can collect unlimited reward by going in circles: " + cycle_text_ + where,
                         "make the total reward of this cycle negative, for instance with a cost per action");
    } else {
      report_.infeasible("E0322", reward_.weights_place,
                         "the robot can go in circles at no cost: " + cycle_text_ + where,
                         "give every action a cost, so that finishing is better than wandering");
    }
  }

  // "(1,1) right (2,1) left (1,1)".
  [[nodiscard]] std::string cycle_text(const DomainMember& member, const std::vector<StateIndex>& cycle) const {
    constexpr std::size_t kShown = 12;
    std::string text;
    for (std::size_t i = 0; i < std::min(cycle.size(), kShown); ++i) {
      const StateIndex s = cycle[i];
      const StateIndex next = cycle[(i + 1) % cycle.size()];
      text +=
          cell_text(family_map_, layout_.robot(member.states[s.value()])) + ' ' + action_between(member, s, next) + ' ';
    }
    if (cycle.size() > kShown) return text + "...";
    return cycle.empty() ? "" : text + cell_text(family_map_, layout_.robot(member.states[cycle[0].value()]));
  }

  // The best action that leads from `s` to `next`.
  [[nodiscard]] std::string action_between(const DomainMember& member, StateIndex s, StateIndex next) const {
    std::optional<Int128> best;
    std::string name = "...";
    for (const Choice& choice : member.mdp.choices(s)) {
      const Outcome& outcome = member.mdp.outcomes(choice).front();
      if (outcome.next != next) continue;
      const Int128 reward = dot(reward_.weights.integer, member.mdp.integer_features(outcome));
      if (best && reward <= *best) continue;
      best = reward;
      name = all_action_names()[static_cast<std::size_t>(dynamics_.actions[choice.action.value()])];
    }
    return name;
  }

  void check_lengths(std::size_t number, const DomainMember& member, const ExactSolution& solution) {
    const std::size_t n = member.mdp.num_states();
    std::vector<std::size_t> length(n + member.mdp.num_terminals(), 0);
    std::vector<std::size_t> path;
    for (std::size_t start = 0; start < n; ++start) {
      std::size_t s = start;
      for (; s < n && length[s] == 0; s = next_on_path(member, solution, s)) path.push_back(s);
      std::size_t steps = length[s];
      for (; !path.empty(); path.pop_back()) length[path.back()] = ++steps;
      if (length[start] > longest_) {
        longest_ = length[start];
        longest_world_ = number;
      }
    }
  }

  static std::size_t next_on_path(const DomainMember& member, const ExactSolution& solution, std::size_t s) {
    const Choice& choice = member.mdp.choices(StateIndex{s})[solution.canonical_choice[s]];
    return member.mdp.outcomes(choice).front().next.value();
  }

  const FamilyMap& family_map_;
  const Dynamics& dynamics_;
  const Reward& reward_;
  TomlReport& report_;
  StateLayout layout_;
  std::size_t num_failures_ = 0;
  bool positive_ = false;
  std::string cycle_text_;
  std::string failing_world_;
  std::size_t num_ties_ = 0;
  std::size_t longest_ = 0;
  std::size_t longest_world_ = 0;
};

}  // namespace

// If at every state all optimal choices count the same, so do all optimal paths.
std::size_t count_ties(const Mdp& mdp, const ExactSolution& solution, const IntegerVector& weights) {
  std::size_t ties = 0;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    const auto choices = mdp.choices(StateIndex{s});
    ties += std::any_of(choices.begin(), choices.end(), [&](const Choice& choice) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      const IntegerVector counts = mdp.integer_features(outcome) + solution.feature_counts[outcome.next.value()];
      return counts != solution.feature_counts[s] && dot(weights, counts) == solution.values[s];
    });
  }
  return ties;
}

void warn_of_ties(std::size_t num_ties, const TomlPlace& weights_place, TomlReport& report) {
  if (num_ties == 0) return;
  report.warning("W0302", weights_place,
                 "from " + std::to_string(num_ties) + (num_ties == 1 ? " state" : " states") +
                     " there are equally good paths with different feature counts",
                 "people may answer with either; the path that the robot takes is taught as at least as good, unless "
                 "its choices between equally good paths contradict each other");
}

void check_optimum(const FamilyMap& family_map, const Dynamics& dynamics, const Reward& reward,
                   const std::vector<DomainMember>& members, TomlReport& report) {
  if (dynamics.discount < 1.0) return;  // every discounted optimum is finite
  OptimumChecker checker{family_map, dynamics, reward, report};
  for (std::size_t mdp = 0; mdp < members.size(); ++mdp) checker.check(mdp, members[mdp]);
  checker.report(members.size());
}

}  // namespace kith::detail
