#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith::detail {

// Longest paths in the transition graph of a deterministic Mdp whose edges earn
// a fixed whole reward per feature row: Bellman-Ford with a first-in-first-out
// worklist that runs against the edges.
//
// A positive cycle keeps improving values for ever; exactly then the graph of
// last improvements ("where did this value come from?") gets a cycle, which is
// looked for once per |S| steps [cherkassky1999negative].
class LongestPaths {
 public:
  // Below every value of a path; never added to.
  static constexpr std::int64_t kUnreached = std::numeric_limits<std::int64_t>::lowest();

  LongestPaths(const Mdp& mdp, std::vector<std::int64_t> row_rewards)
      : mdp_{mdp}, row_rewards_{std::move(row_rewards)} {}

  // Values of the best paths to a terminal state. False if there is a positive cycle.
  [[nodiscard]] bool solve_to_terminals() {
    start(kUnreached);
    for (std::size_t t = 0; t < mdp_.num_terminals(); ++t) {
      values_[mdp_.num_states() + t] = 0;
      push(mdp_.num_states() + t);
    }
    return drain();
  }

  // Values of the best walks to anywhere: whether there is no positive cycle.
  [[nodiscard]] bool solve_to_anywhere() {
    start(0);
    for (std::size_t s = values_.size(); s-- > 0;) push(s);
    return drain();
  }

  // After a failed solve: the states of a simple cycle that earns a positive reward, in order.
  [[nodiscard]] const std::vector<StateIndex>& cycle() const noexcept { return cycle_; }
  // The sum of the features along it.
  [[nodiscard]] IntegerVector cycle_features() const {
    IntegerVector sum(mdp_.num_features());
    for (const StateIndex s : cycle_) sum += mdp_.integer_features(outcome_of(s.value()));
    return sum;
  }

  [[nodiscard]] std::vector<std::int64_t>& values() noexcept { return values_; }
  [[nodiscard]] std::int64_t reward(std::size_t row) const { return row_rewards_[row]; }

 private:
  static constexpr std::uint32_t kNoChoice = std::numeric_limits<std::uint32_t>::max();

  void start(std::int64_t value) {
    const std::size_t n = mdp_.num_states() + mdp_.num_terminals();
    values_.assign(n, value);
    origin_.assign(mdp_.num_states(), kNoChoice);
    queued_.assign(n, 0);
    queue_.resize(n);
    head_ = 0;
    waiting_ = 0;
    cycle_.clear();
  }

  void push(std::size_t s) {
    if (queued_[s] != 0) return;
    queued_[s] = 1;
    std::size_t tail = head_ + waiting_;
    if (tail >= queue_.size()) tail -= queue_.size();
    queue_[tail] = static_cast<std::uint32_t>(s);
    ++waiting_;
  }

  std::size_t pop() {
    const std::size_t s = queue_[head_];
    if (++head_ == queue_.size()) head_ = 0;
    --waiting_;
    queued_[s] = 0;
    return s;
  }

  bool drain() {
    std::size_t until_check = queue_.size();
    while (waiting_ > 0) {
      const std::size_t next = pop();
      for (const Arrival& arrival : mdp_.arrivals(StateIndex{next})) {
        const std::int64_t candidate = row_rewards_[arrival.feature_row] + values_[next];
        const std::size_t from = arrival.from.value();
        if (!(candidate > values_[from])) continue;
        values_[from] = candidate;
        origin_[from] = arrival.choice;
        push(from);
      }
      if (--until_check == 0) {
        if (find_cycle()) return false;
        until_check = queue_.size();
      }
    }
    return true;
  }

  [[nodiscard]] const Outcome& outcome_of(std::size_t s) const {
    return mdp_.outcomes(mdp_.choices(StateIndex{s})[origin_[s]]).front();
  }

  // Walks along the origins; a walk that meets itself has found a cycle.
  bool find_cycle() {
    walk_of_.assign(mdp_.num_states(), 0);
    for (std::uint32_t start = 0; start < mdp_.num_states(); ++start) {
      std::size_t s = start;
      while (s < mdp_.num_states() && walk_of_[s] == 0 && origin_[s] != kNoChoice) {
        walk_of_[s] = start + 1;
        s = outcome_of(s).next.value();
      }
      if (s >= mdp_.num_states() || walk_of_[s] != start + 1) continue;
      const std::size_t first = s;
      do {
        cycle_.push_back(StateIndex{s});
        s = outcome_of(s).next.value();
      } while (s != first);
      return true;
    }
    return false;
  }

  const Mdp& mdp_;
  std::vector<std::int64_t> row_rewards_;
  std::vector<std::int64_t> values_;
  std::vector<std::uint32_t> origin_;  // position of the choice that gave a state its value
  std::vector<std::uint32_t> queue_;   // a ring
  std::vector<unsigned char> queued_;
  std::vector<std::uint32_t> walk_of_;
  std::vector<StateIndex> cycle_;
  std::size_t head_ = 0;
  std::size_t waiting_ = 0;
};

// The states in an order in which every tight edge leads backwards (to a state
// listed before, or a terminal one), by Kahn's algorithm. If there is a cycle
// of tight edges, `cycle` holds one instead.
struct TightOrder {
  std::vector<StateIndex> states;
  std::vector<StateIndex> cycle;
};

// `is_tight(from, next, feature_row)` tells whether an edge keeps an optimal path optimal.
template <typename IsTight>
[[nodiscard]] TightOrder order_tight_edges(const Mdp& mdp, const IsTight& is_tight) {
  TightOrder order;
  std::vector<std::uint32_t> open(mdp.num_states(), 0);  // tight edges to states not yet listed
  const auto tight_next = [&](std::size_t s, const Choice& choice) -> std::optional<std::size_t> {
    const Outcome& outcome = mdp.outcomes(choice).front();
    if (!is_tight(s, outcome.next.value(), outcome.feature_row)) return std::nullopt;
    return outcome.next.value();
  };
  for (std::size_t s = 0; s < open.size(); ++s) {
    for (const Choice& choice : mdp.choices(StateIndex{s})) open[s] += tight_next(s, choice).has_value() ? 1u : 0u;
  }
  const auto close_arrivals = [&](StateIndex next) {
    for (const Arrival& arrival : mdp.arrivals(next)) {
      const std::size_t from = arrival.from.value();
      if (is_tight(from, next.value(), arrival.feature_row) && --open[from] == 0) order.states.push_back(arrival.from);
    }
  };
  order.states.reserve(mdp.num_states());
  for (std::size_t t = 0; t < mdp.num_terminals(); ++t) close_arrivals(StateIndex{mdp.num_states() + t});
  for (std::size_t i = 0; i < order.states.size(); ++i) close_arrivals(order.states[i]);
  if (order.states.size() == mdp.num_states()) return order;

  // Every state left out has a tight edge to another such state: walk until the walk meets itself.
  std::size_t s = 0;
  while (open[s] == 0) ++s;
  std::vector<std::size_t> position(mdp.num_states(), 0);
  std::vector<StateIndex> walk;
  while (position[s] == 0) {
    walk.push_back(StateIndex{s});
    position[s] = walk.size();
    for (const Choice& choice : mdp.choices(StateIndex{s})) {
      const auto next = tight_next(s, choice);
      if (!next || *next >= mdp.num_states() || open[*next] == 0) continue;
      s = *next;
      break;
    }
  }
  order.cycle.assign(walk.begin() + static_cast<std::ptrdiff_t>(position[s]) - 1, walk.end());
  return order;
}

}  // namespace kith::detail
