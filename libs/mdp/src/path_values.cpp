#include "path_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "component_paths.hpp"
#include "kith/core/error.hpp"

namespace kith::detail {
namespace {

constexpr int kMostRounds = 10'000;  // in practice a few
constexpr int kSweepsPerRound = 8;   // of improvements before paths are summed up again, which cycles need

}  // namespace

PathSteps steps_of_choices(const Mdp& mdp) {
  PathSteps steps;
  steps.next.reserve(mdp.num_choices());
  steps.row.reserve(mdp.num_choices());
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    for (const Choice& choice : mdp.choices(s)) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      steps.next.push_back(static_cast<std::uint32_t>(outcome.next.value()));
      steps.row.push_back(outcome.feature_row);
    }
  }
  return steps;
}

std::vector<std::uint32_t> states_by_distance(const Mdp& mdp) {
  std::vector<std::uint32_t> order;
  order.reserve(mdp.num_states());
  std::vector<bool> is_listed(mdp.num_states(), false);
  for (const StateIndex s : mdp.by_distance()) {
    order.push_back(static_cast<std::uint32_t>(s.value()));
    is_listed[s.value()] = true;
  }
  for (std::uint32_t s = 0; s < is_listed.size(); ++s) {
    if (!is_listed[s]) order.push_back(s);
  }
  return order;
}

PathValues::PathValues(const Mdp& mdp, const PathSteps& steps, std::span<const double> row_rewards, double tolerance,
                       const ChoiceMask& mask)
    : mdp_{mdp},
      steps_{steps},
      rewards_{row_rewards},
      tolerance_{tolerance},
      mask_{mask},
      policy_{std::vector<std::uint32_t>(mdp.num_states()), std::vector<std::uint32_t>(mdp.num_states())},
      values_(mdp.num_states() + mdp.num_terminals(), 0.0),
      is_open_(values_.size(), 0),
      walk_{mdp.num_states()} {}

void PathValues::take(std::size_t s, std::size_t choice) {
  policy_.next[s] = steps_.next[choice];
  policy_.row[s] = steps_.row[choice];
}

// Takes the best choice of a state among those to states that `admits`, if it is worth more than `least`.
template <typename Admits>
bool PathValues::choose(std::size_t s, double least, const Admits& admits) {
  const std::size_t first = mdp_.first_choice(StateIndex{s});
  const std::size_t last = first + mdp_.choices(StateIndex{s}).size();
  std::size_t best = last;
  for (std::size_t c = first; c < last; ++c) {
    if (!is_allowed(c) || !admits(steps_.next[c])) continue;
    const double candidate = worth(c);
    if (!(candidate > least)) continue;
    best = c;
    least = candidate;
  }
  if (best == last) return false;
  take(s, best);
  values_[s] = least;
  return true;
}

// Policy iteration. It begins with the best steps to states that come earlier, and improves in that order: what is
// better at the end of a path reaches its beginning in one pass if states come after those that they lead to. A state
// is looked at again when its value, or that of a state that it may lead to, has changed.
void PathValues::solve(std::span<const std::uint32_t> states) {
  for (const std::uint32_t s : states) is_open_[s] = 1;  // has no value yet
  for (const std::uint32_t s : states) {
    const bool found =
        choose(s, -std::numeric_limits<double>::infinity(), [&](std::uint32_t next) { return is_open_[next] == 0; });
    is_open_[s] = found ? 0 : 1;
    if (found) continue;
    std::size_t c = mdp_.first_choice(StateIndex{s});
    while (!is_allowed(c)) ++c;
    take(s, c);
  }

  for (const std::uint32_t s : states) is_open_[s] = 1;
  const double slack = std::max(1e-13, 0.01 * tolerance_);  // far within a tie, far above rounding
  const auto open_arrivals = [&](std::uint32_t s) {
    for (const Arrival& arrival : mdp_.arrivals(StateIndex{s})) is_open_[arrival.from.value()] = 1;
  };
  for (int i = 0; i < kMostRounds; ++i) {
    before_.clear();
    for (const std::uint32_t s : states) before_.push_back(values_[s]);
    sum_up(states, rewards_, 1, values_);
    for (std::size_t at = 0; at < states.size(); ++at) {
      if (values_[states[at]] == before_[at]) continue;
      is_open_[states[at]] = 1;
      open_arrivals(states[at]);
    }
    int sweeps = 0;
    for (bool improved = true; improved && sweeps < kSweepsPerRound; sweeps += improved ? 1 : 0) {
      improved = false;
      for (const std::uint32_t s : states) {
        if (is_open_[s] == 0) continue;
        is_open_[s] = 0;
        const double clearly = values_[s] + slack * std::max(1.0, std::abs(values_[s]));
        if (!choose(s, clearly, [](std::uint32_t) { return true; })) continue;
        improved = true;
        open_arrivals(s);
      }
    }
    if (sweeps == 0) {
      // Those that lead here are solved later.
      for (const std::uint32_t s : states) {
        for (const Arrival& arrival : mdp_.arrivals(StateIndex{s})) is_open_[arrival.from.value()] = 0;
      }
      return;
    }
  }
  throw Error{ErrorKind::kInfeasible, "policy iteration of paths does not converge"};
}

bool PathValues::is_tight_choice(std::size_t s, std::size_t c) const {
  return is_allowed(c) && is_tight(values_[s], worth(c), tolerance_);
}

void PathValues::take_first_tight(std::span<const std::uint32_t> states) {
  for (const std::uint32_t s : states) {
    std::size_t c = mdp_.first_choice(StateIndex{s});
    while (!is_tight_choice(s, c)) ++c;
    take(s, c);
  }
}

void PathValues::sum_up(std::span<const std::uint32_t> states, std::span<const double> row_counts, std::size_t kinds,
                        std::span<double> counts) {
  walk_.sum_up(states, policy_, row_counts, kinds, mdp_.discount(), counts);
}

}  // namespace kith::detail
