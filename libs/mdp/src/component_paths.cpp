#include "component_paths.hpp"

#include <limits>

#include "kith/core/assert.hpp"

namespace kith::detail {
namespace {

constexpr double kUnreached = -std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

std::uint32_t number(StateIndex s) { return static_cast<std::uint32_t>(s.value()); }

}  // namespace

void ComponentPaths::begin(Stage stage) {
  const std::size_t n = mdp_.num_states();
  values_.assign(n + mdp_.num_terminals(), 0.0);
  stage_.assign(n + mdp_.num_terminals(), Stage::kFinal);
  std::fill_n(stage_.begin(), n, stage);
  largest_value_ = 0.0;
  order_.clear();
  order_.reserve(n);
}

ComponentPaths::States ComponentPaths::component(std::size_t c) const {
  const auto starts = mdp_.component_starts();
  return mdp_.by_component().subspan(starts[c], starts[c + 1] - starts[c]);
}

PathsFound ComponentPaths::solve() {
  begin(Stage::kLater);
  PathsFound found = PathsFound::kAll;
  for (std::size_t c = 0; c + 1 < mdp_.component_starts().size(); ++c) {
    const auto here = solve(component(c));
    if (here == PathsFound::kPositiveCycle) return here;
    if (here == PathsFound::kTightCycle) found = here;
  }
  return found;
}

void ComponentPaths::set_value(StateIndex s, double value) {
  if (stage_.empty()) begin(Stage::kFinal);
  values_[s.value()] = value;
}

PathsFound ComponentPaths::solve_component(std::size_t c) {
  if (stage_.empty()) begin(Stage::kFinal);
  for (const StateIndex s : component(c)) stage_[s.value()] = Stage::kLater;
  order_.clear();
  largest_value_ = 0.0;
  return solve(component(c));
}

PathsFound ComponentPaths::solve(States component) {
  const std::size_t first = order_.size();
  PathsFound found = PathsFound::kAll;
  const double largest_reward = enter(component);
  if (component.size() == 1) {
    order_.push_back(number(component.front()));
  } else if (largest_reward <= 0.0) {
    set_labels(component);
  } else if (!correct_labels(component)) {
    return PathsFound::kPositiveCycle;
  }
  for (const StateIndex s : component) largest_value_ = std::max(largest_value_, std::abs(values_[s.value()]));
  // Where every step loses more than the tolerance, optimal choices lead to labels that were set before.
  if (component.size() > 1 && largest_reward >= -2.0 * tolerance_ * std::max(1.0, largest_value_)) {
    order_.resize(first);
    if (!order_tight(component)) found = PathsFound::kTightCycle;
  }
  for (const StateIndex s : component) stage_[s.value()] = Stage::kFinal;
  return found;
}

// First labels, by the choices that leave the component; returns the largest reward of those that do not.
double ComponentPaths::enter(States component) {
  double largest_inside = kUnreached;
  for (const StateIndex s : component) {
    double best = kUnreached;
    for (const Choice& choice : mdp_.choices(s)) {
      const Outcome& outcome = mdp_.outcomes(choice).front();
      const double reward = rewards_[outcome.feature_row];
      if (stage_[outcome.next.value()] == Stage::kFinal) {
        best = std::max(best, reward + values_[outcome.next.value()]);
      } else {
        largest_inside = std::max(largest_inside, reward);
      }
    }
    values_[s.value()] = best;
  }
  for (const StateIndex s : component) stage_[s.value()] = Stage::kOpen;
  return largest_inside;
}

// @pre no transition within the component earns: the best label left is final.
void ComponentPaths::set_labels(States component) {
  heap_.clear();
  for (const StateIndex s : component) {
    if (values_[s.value()] > kUnreached) heap_.push_back({values_[s.value()], number(s)});
  }
  std::ranges::make_heap(heap_, {}, &Label::value);
  while (!heap_.empty()) {
    std::ranges::pop_heap(heap_, {}, &Label::value);
    const Label label = heap_.back();
    heap_.pop_back();
    if (stage_[label.state] != Stage::kOpen) continue;  // it had a better label
    stage_[label.state] = Stage::kFinal;
    order_.push_back(label.state);
    for (const Arrival& arrival : mdp_.arrivals(StateIndex{label.state})) {
      const std::size_t from = arrival.from.value();
      const double candidate = rewards_[arrival.feature_row] + label.value;
      if (stage_[from] != Stage::kOpen || !(candidate > values_[from])) continue;
      values_[from] = candidate;
      heap_.push_back({candidate, number(arrival.from)});
      std::ranges::push_heap(heap_, {}, &Label::value);
    }
  }
}

// First in, first out; false if there is a positive cycle, which is looked for once per |component| steps.
bool ComponentPaths::correct_labels(States component) {
  if (origin_.empty()) {
    origin_.resize(mdp_.num_states());
    queued_.assign(mdp_.num_states(), 0);
    mark_.resize(mdp_.num_states());
  }

  queue_.resize(component.size());  // a ring
  std::size_t head = 0;
  std::size_t waiting = 0;
  const auto push = [&](std::uint32_t s) {
    if (queued_[s] != 0) return;
    queued_[s] = 1;
    const std::size_t tail = head + waiting++;
    queue_[tail < queue_.size() ? tail : tail - queue_.size()] = s;
  };

  for (const StateIndex s : component) {
    origin_[s.value()] = kNone;
    if (values_[s.value()] > kUnreached) push(number(s));
  }
  for (std::size_t until_check = component.size(); waiting > 0;) {
    const std::uint32_t next = queue_[head];
    if (++head == queue_.size()) head = 0;
    --waiting;
    queued_[next] = 0;
    for (const Arrival& arrival : mdp_.arrivals(StateIndex{next})) {
      const std::size_t from = arrival.from.value();
      const double candidate = rewards_[arrival.feature_row] + values_[next];
      if (stage_[from] != Stage::kOpen || !(candidate > values_[from])) continue;
      values_[from] = candidate;
      origin_[from] = next;
      push(number(arrival.from));
    }
    if (--until_check > 0) continue;
    if (has_cycle(component)) return false;
    until_check = component.size();
  }
  return true;
}

// Walks along the origins; a walk that meets itself has found a cycle.
bool ComponentPaths::has_cycle(States component) {
  for (const StateIndex s : component) mark_[s.value()] = 0;
  std::uint32_t walk = 0;
  for (const StateIndex start : component) {
    ++walk;
    std::uint32_t s = number(start);
    while (s != kNone && mark_[s] == 0) {
      mark_[s] = walk;
      s = origin_[s];
    }
    if (s == kNone || mark_[s] != walk) continue;
    on_cycle_ = s;
    return true;
  }
  return false;
}

// The transition by which the label of `from` was corrected: the best of those to its origin.
const Outcome& ComponentPaths::best_step(std::uint32_t from, std::uint32_t next) const {
  const Outcome* best = nullptr;
  for (const Choice& choice : mdp_.choices(StateIndex{from})) {
    const Outcome& outcome = mdp_.outcomes(choice).front();
    if (outcome.next.value() != next) continue;
    if (best == nullptr || rewards_[outcome.feature_row] > rewards_[best->feature_row]) best = &outcome;
  }
  KITH_ASSERT(best != nullptr);
  return *best;
}

// @pre the last component has a positive cycle.
IntegerVector ComponentPaths::cycle_features() const {
  IntegerVector sum(mdp_.num_features());
  std::uint32_t s = on_cycle_;
  do {
    sum += mdp_.integer_features(best_step(s, origin_[s]));
    s = origin_[s];
  } while (s != on_cycle_);
  return sum;
}

// Lists a state when all states that its optimal choices lead to are listed (Kahn's algorithm). False if some never
// are.
bool ComponentPaths::order_tight(States component) {
  if (mark_.empty()) mark_.resize(mdp_.num_states());
  const std::size_t first = order_.size();
  for (const StateIndex s : component) stage_[s.value()] = Stage::kOpen;

  // How many tight steps of a state lead to states that have no place yet; those without any come first.
  for (const StateIndex s : component) {
    std::uint32_t left = 0;
    for (const Choice& choice : mdp_.choices(s)) {
      const Outcome& outcome = mdp_.outcomes(choice).front();
      const std::size_t next = outcome.next.value();
      if (stage_[next] != Stage::kOpen) continue;
      const double candidate = rewards_[outcome.feature_row] + values_[next];
      left += is_tight(values_[s.value()], candidate, tolerance_) ? 1u : 0u;
    }
    mark_[s.value()] = left;
    if (left == 0) order_.push_back(number(s));
  }

  for (std::size_t i = first; i < order_.size(); ++i) {
    const std::uint32_t next = order_[i];
    for (const Arrival& arrival : mdp_.arrivals(StateIndex{next})) {
      const std::size_t from = arrival.from.value();
      if (stage_[from] != Stage::kOpen || !is_tight_into(arrival, values_[next])) continue;
      if (--mark_[from] == 0) order_.push_back(number(arrival.from));
    }
  }

  // A cycle of tight steps never gets a place.
  return order_.size() - first == component.size();
}

}  // namespace kith::detail
