#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith::detail {

// Whether a choice worth `candidate` counts as optimal where the best is worth `value`.
inline bool is_tight(double value, double candidate, double tolerance) {
  return candidate >= value - tolerance * std::max(1.0, std::abs(value));
}

enum class PathsFound {
  kAll,            // the best paths, and an order of the states along them
  kPositiveCycle,  // nothing
  kTightCycle,     // the values are right, but optimal choices can go round in a circle
};

// Best paths to the terminal states of a deterministic, undiscounted Mdp, one
// strongly connected component after the other: those that a component leads to
// are final before. Within one, Dijkstra's algorithm (label setting) if no
// transition earns; else label correcting as in LongestPaths.
// @pre every state can reach a terminal one.
class ComponentPaths {
 public:
  ComponentPaths(const Mdp& mdp, std::span<const double> row_rewards, double tolerance)
      : mdp_{mdp}, rewards_{row_rewards}, tolerance_{tolerance} {}

  [[nodiscard]] PathsFound solve();

  // Solves one component alone, given the values of the states outside it that its choices lead to: set_value(). On
  // success order() lists its states; after kPositiveCycle, cycle_features() sums up a cycle that earns.
  [[nodiscard]] PathsFound solve_component(std::size_t c);
  void set_value(StateIndex s, double value);
  [[nodiscard]] IntegerVector cycle_features() const;

  [[nodiscard]] std::vector<double>& values() noexcept { return values_; }
  // Every choice that is optimal within the tolerance leads to a state listed before, or a terminal one.
  // @pre solve() found all.
  [[nodiscard]] std::span<const std::uint32_t> order() const noexcept { return order_; }

 private:
  using States = std::span<const StateIndex>;
  enum class Stage : unsigned char {
    kLater,  // its component comes later
    kOpen,   // in the component that is being solved
    kFinal,
  };
  struct Label {
    double value;
    std::uint32_t state;
  };

  void begin(Stage stage);
  [[nodiscard]] States component(std::size_t c) const;
  [[nodiscard]] PathsFound solve(States component);
  double enter(States component);
  void set_labels(States component);
  bool correct_labels(States component);
  [[nodiscard]] bool has_cycle(States component);
  [[nodiscard]] const Outcome& best_step(std::uint32_t from, std::uint32_t next) const;
  bool order_tight(States component);
  [[nodiscard]] bool is_tight_into(const Arrival& arrival, double next_value) const {
    return is_tight(values_[arrival.from.value()], rewards_[arrival.feature_row] + next_value, tolerance_);
  }

  const Mdp& mdp_;
  std::span<const double> rewards_;
  double tolerance_;
  double largest_value_ = 0.0;
  std::vector<double> values_;  // shape [num_states + num_terminals]
  std::vector<Stage> stage_;    // the same; terminal states are final
  std::vector<std::uint32_t> order_;
  std::vector<Label> heap_;
  std::vector<std::uint32_t> origin_;  // the state that a corrected label came from
  std::vector<std::uint32_t> queue_;
  std::vector<unsigned char> queued_;
  std::uint32_t on_cycle_ = 0;       // a state of the cycle that was found
  std::vector<std::uint32_t> mark_;  // the walk that passed, or tight transitions to states not yet listed
};

}  // namespace kith::detail
