#include "robot_plan.hpp"

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <utility>

#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

std::vector<double> as_reals(const IntegerVector& weights) {
  std::vector<double> result;
  for (const std::int64_t w : weights) result.push_back(static_cast<double>(w));
  return result;
}

// Exact domains: equal values are equal integers.
std::optional<RobotPlan> plan_exact(const Mdp& mdp, const IntegerVector& weights) {
  auto exact = plan_exactly(mdp, weights);
  if (!exact.solution) return std::nullopt;
  RobotPlan plan;
  plan.choice = std::move(exact.solution->canonical_choice);
  plan.counts = std::move(exact.solution->feature_counts);
  const auto& values = exact.solution->values;
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    std::uint32_t optimal = 0;
    for (const Choice& choice : mdp.choices(s)) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      const auto value = dot(weights, mdp.integer_features(outcome)) + values[outcome.next.value()];
      optimal += value == values[s.value()] ? 1u : 0u;
    }
    plan.optimal_choices.push_back(optimal);
    const Choice& chosen = mdp.choices(s)[plan.choice[s.value()]];
    plan.next.push_back(static_cast<std::uint32_t>(mdp.outcomes(chosen).front().next.value()));
  }
  return plan;
}

// The likeliest way to an end under the plan: from every state the outcome from which the product of probabilities
// along the best path is largest (Dijkstra from the terminal states); ties: the outcome listed first.
class LikeliestPaths {
 public:
  LikeliestPaths(const Mdp& mdp, const std::vector<std::uint32_t>& choice) : mdp_{mdp}, choice_{choice} {
    likelihood_.assign(mdp.num_states() + mdp.num_terminals(), 0.0);
    next_.assign(mdp.num_states(), 0);
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) add_ways_into(s);
  }

  std::vector<std::uint32_t> next() && {
    reach_back();
    follow_where_there_is_no_end();
    return std::move(next_);
  }

 private:
  struct Way {
    std::uint32_t from;
    double probability;
  };

  [[nodiscard]] std::span<const Outcome> outcomes(StateIndex s) const {
    return mdp_.outcomes(mdp_.choices(s)[choice_[s.value()]]);
  }

  void add_ways_into(StateIndex s) {
    ways_.resize(likelihood_.size());
    for (const Outcome& outcome : outcomes(s)) {
      ways_[outcome.next.value()].push_back({static_cast<std::uint32_t>(s.value()), outcome.probability});
    }
  }

  void reach_back() {
    using Entry = std::pair<double, std::uint32_t>;
    // The likeliest first; among equals the lowest state, so that the result does not depend on the heap.
    const auto later = [](const Entry& a, const Entry& b) {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> open{later};
    for (std::size_t t = mdp_.num_states(); t < likelihood_.size(); ++t) {
      likelihood_[t] = 1.0;
      open.emplace(1.0, static_cast<std::uint32_t>(t));
    }
    std::vector<bool> done(likelihood_.size(), false);
    while (!open.empty()) {
      const auto [likelihood, at] = open.top();
      open.pop();
      if (done[at]) continue;
      done[at] = true;
      for (const Way& way : ways_[at]) {
        if (done[way.from] || !(likelihood * way.probability > likelihood_[way.from])) continue;
        likelihood_[way.from] = likelihood * way.probability;
        next_[way.from] = at;
        open.emplace(likelihood_[way.from], way.from);
      }
    }
  }

  // States that never end. Of what an action does, that it changes nothing is never all.
  void follow_where_there_is_no_end() {
    for (StateIndex s{0}; s.value() < mdp_.num_states(); ++s) {
      if (likelihood_[s.value()] > 0.0) continue;
      const auto chance = [&](const Outcome& outcome) { return outcome.next == s ? 0.0 : outcome.probability; };
      next_[s.value()] = static_cast<std::uint32_t>(std::ranges::max_element(outcomes(s), {}, chance)->next.value());
    }
  }

  const Mdp& mdp_;
  const std::vector<std::uint32_t>& choice_;
  std::vector<std::vector<Way>> ways_;  // into each state
  std::vector<double> likelihood_;      // of reaching an end along the best path
  std::vector<std::uint32_t> next_;
};

std::optional<RobotPlan> plan_expected(const Mdp& mdp, const RewardWeights& robot, std::int64_t scale) {
  const auto weights = as_reals(robot.integer);
  auto behaviour = behave(mdp, weights, {.scale = scale});
  if (!behaviour) return std::nullopt;
  RobotPlan plan;
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    std::uint32_t optimal = 0;
    for (std::size_t c = 0; c < mdp.choices(s).size(); ++c) {
      optimal += is_optimal(mdp, *behaviour, weights, s, c) ? 1u : 0u;
    }
    plan.optimal_choices.push_back(optimal);
  }
  plan.choice = std::move(behaviour->choice);
  plan.counts = std::move(behaviour->counts);
  plan.next = LikeliestPaths{mdp, plan.choice}.next();
  return plan;
}

}  // namespace

std::optional<RobotPlan> plan_robot(const Domain& domain, MdpIndex m) {
  const Mdp& mdp = domain.mdp(m);
  if (domain.is_exact()) return plan_exact(mdp, domain.weights().integer);
  return plan_expected(mdp, domain.weights(), domain.count_scale());
}

std::vector<std::uint32_t> likeliest_next(const Mdp& mdp, const std::vector<std::uint32_t>& choice) {
  return LikeliestPaths{mdp, choice}.next();
}

Trajectory shown_path(const Mdp& mdp, std::span<const std::uint32_t> choice, std::span<const std::uint32_t> next,
                      StateIndex start) {
  Trajectory path{{start}, {}};
  std::unordered_map<std::size_t, std::size_t> step_of;
  for (auto s = start; !mdp.is_terminal(s); s = path.states.back()) {
    const auto [met, is_new] = step_of.try_emplace(s.value(), path.actions.size());
    if (!is_new) {
      path.repeats_from = met->second;
      break;
    }
    path.actions.push_back(mdp.choices(s)[choice[s.value()]].action);
    path.states.emplace_back(next[s.value()]);
  }
  return path;
}

PathOrder successors_first(const Mdp& mdp, const RobotPlan& plan) {
  PathOrder order;
  order.states.reserve(mdp.num_states());
  order.cycle_length.assign(mdp.num_states(), 0);
  constexpr std::uint32_t kNew = 0xFFFFFFFF;
  std::vector<std::uint32_t> walked_by(mdp.num_states(), kNew);
  std::vector<StateIndex> path;
  for (std::uint32_t start = 0; start < mdp.num_states(); ++start) {
    std::uint32_t s = start;
    for (; s < mdp.num_states() && walked_by[s] == kNew; s = plan.next[s]) {
      walked_by[s] = start;
      path.emplace_back(s);
    }
    if (s < mdp.num_states() && walked_by[s] == start) {  // it has met itself
      const auto first = std::ranges::find(path, StateIndex{s});
      const auto length = static_cast<std::uint32_t>(path.end() - first);
      for (auto at = first; at != path.end(); ++at) order.cycle_length[at->value()] = length;
      order.states.insert(order.states.end(), first, path.end());
      path.erase(first, path.end());
    }
    order.states.insert(order.states.end(), path.rbegin(), path.rend());
    path.clear();
  }
  return order;
}

}  // namespace kith
