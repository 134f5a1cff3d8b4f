#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "kith/core/index.hpp"
#include "kith/core/integer_vector.hpp"

namespace kith {

using StateIndex = Index<struct StateTag>;
using ActionIndex = Index<struct ActionTag>;

/// One entry of a row of the transition kernel: p = T(next | state, action),
/// with the features phi(state, action, next) of that transition.
struct Outcome {
  StateIndex next;
  double probability = 1.0;
  std::uint32_t feature_row = 0;  ///< Row of the Mdp's feature table.
};

/// An action that is legal in a state: one that can change the state.
struct Choice {
  ActionIndex action;
  std::uint32_t first_outcome = 0;
  std::uint32_t num_outcomes = 0;
};

/// One way into a state: the other end of an Outcome.
struct Arrival {
  StateIndex from;
  std::uint32_t choice = 0;       ///< Position in choices(from).
  std::uint32_t feature_row = 0;  ///< Row of the Mdp's feature table.
};

/// A finite Markov decision process without a reward: states, legal actions,
/// transition probabilities and a feature vector phi(s, a, s') per transition.
/// A reward is added by weights w, R = w . phi.
///
/// States 0 .. num_states()-1 are the non-terminal ones; each of them can start
/// a demonstration. States num_states() .. num_states()+num_terminals()-1 are
/// terminal: they have no choices and value 0. An action that leaves the state
/// as it is ("self-loop") is not a choice.
///
/// Immutable; built by MdpBuilder.
class Mdp {
 public:
  [[nodiscard]] std::size_t num_states() const noexcept { return first_choice_.size() - 1; }
  [[nodiscard]] std::size_t num_terminals() const noexcept { return num_terminals_; }
  [[nodiscard]] std::size_t num_actions() const noexcept { return num_actions_; }
  /// d, the length of a feature vector.
  [[nodiscard]] std::size_t num_features() const noexcept { return num_features_; }
  /// In (0, 1].
  [[nodiscard]] double discount() const noexcept { return discount_; }
  [[nodiscard]] bool is_terminal(StateIndex s) const noexcept { return s.value() >= num_states(); }

  /// Legal actions of a non-terminal state, in the canonical action order.
  /// @throws std::invalid_argument if s is terminal.
  [[nodiscard]] std::span<const Choice> choices(StateIndex s) const {
    const std::size_t first = first_choice(s);
    return {choices_.data() + first, first_choice_[s.value() + 1] - first};
  }
  /// The number of choices of the states before s: choices are numbered through, state by state.
  /// @throws std::invalid_argument if s is terminal.
  [[nodiscard]] std::size_t first_choice(StateIndex s) const {
    if (s.value() >= num_states()) reject("Mdp::choices: terminal states have no choices");
    return first_choice_[s.value()];
  }
  /// Of all states together.
  [[nodiscard]] std::size_t num_choices() const noexcept { return choices_.size(); }
  [[nodiscard]] std::span<const Outcome> outcomes(const Choice& choice) const noexcept {
    return {outcomes_.data() + choice.first_outcome, choice.num_outcomes};
  }
  /// phi of an outcome, shape [num_features].
  [[nodiscard]] std::span<const double> features(const Outcome& outcome) const {
    return feature_row(outcome.feature_row);
  }
  /// The same as integers. @pre is_integral().
  [[nodiscard]] const IntegerVector& integer_features(const Outcome& outcome) const {
    return integer_feature_row(outcome.feature_row);
  }

  /// Number of distinct feature vectors, the rows of the feature table.
  [[nodiscard]] std::size_t num_feature_rows() const noexcept { return num_rows_; }
  /// phi of a row, shape [num_features].
  [[nodiscard]] std::span<const double> feature_row(std::size_t row) const {
    return std::span{feature_table_}.subspan(row * num_features_, num_features_);
  }
  /// The same as integers. @pre is_integral().
  [[nodiscard]] const IntegerVector& integer_feature_row(std::size_t row) const {
    if (row >= integer_table_.size()) {
      reject("Mdp::integer_feature_row: the process must be integral and the row exist");
    }
    return integer_table_[row];
  }
  /// The largest size |phi_k| of any feature of any outcome.
  [[nodiscard]] double largest_feature() const noexcept;

  /// All ways into a state, terminal or not, ordered by the state they come from.
  [[nodiscard]] std::span<const Arrival> arrivals(StateIndex s) const {
    if (s.value() + 1 >= first_arrival_.size()) reject("Mdp::arrivals: the state is out of range");
    const std::size_t first = first_arrival_[s.value()];
    return {arrivals_.data() + first, first_arrival_[s.value() + 1] - first};
  }
  /// The non-terminal states from which some terminal state can be reached, by
  /// increasing number of steps to the nearest one: the order for backward sweeps.
  [[nodiscard]] std::span<const StateIndex> by_distance() const noexcept { return by_distance_; }

  /// The non-terminal states by strongly connected component, so that every
  /// transition stays in its component or leads to one listed before (or to a
  /// terminal state) [tarjan1972]. In order of their numbers within a component.
  [[nodiscard]] std::span<const StateIndex> by_component() const noexcept { return by_component_; }
  /// Where the components begin in by_component(); one entry more than there are components.
  [[nodiscard]] std::span<const std::uint32_t> component_starts() const noexcept { return component_starts_; }

  /// Whether every choice has exactly one outcome.
  [[nodiscard]] bool is_deterministic() const noexcept { return deterministic_; }
  /// Whether every feature of every transition is an integer below 2^31 in size.
  [[nodiscard]] bool is_integral() const noexcept { return integral_; }
  /// Whether feature k is non-zero on some transition.
  [[nodiscard]] bool has_feature(std::size_t k) const { return has_feature_[k]; }

 private:
  friend class MdpBuilder;
  Mdp() = default;
  void index_arrivals();
  void order_by_distance();
  void group_by_component();
  [[noreturn]] static void reject(const char* rule);

  std::size_t num_terminals_ = 0;
  std::size_t num_actions_ = 0;
  std::size_t num_features_ = 0;
  std::size_t num_rows_ = 0;
  double discount_ = 1.0;
  bool deterministic_ = true;
  bool integral_ = true;
  std::vector<bool> has_feature_;
  std::vector<std::uint32_t> first_choice_;  // shape [num_states + 1]
  std::vector<Choice> choices_;
  std::vector<Outcome> outcomes_;
  std::vector<double> feature_table_;         // row-major, shape [rows, num_features]
  std::vector<IntegerVector> integer_table_;  // shape [rows]; empty unless integral
  std::vector<std::uint32_t> first_arrival_;  // shape [num_states + num_terminals + 1]
  std::vector<Arrival> arrivals_;
  std::vector<StateIndex> by_distance_;
  std::vector<StateIndex> by_component_;
  std::vector<std::uint32_t> component_starts_;
};

/// Collects states in order and makes an Mdp. Choices of state s are added after
/// those of all states before s.
class MdpBuilder {
 public:
  /// @throws std::invalid_argument unless discount in (0, 1], 1 <= num_features <= IntegerVector::kMaxDimension
  /// and there are fewer than 2^32 states.
  MdpBuilder(std::size_t num_states, std::size_t num_terminals, std::size_t num_actions, std::size_t num_features,
             double discount);

  struct Transition {
    StateIndex next;
    double probability = 1.0;
    std::vector<double> features;  ///< phi(s, a, next), shape [num_features]
  };

  /// Adds a legal action of state `s`. Probabilities are positive and sum to 1 within 1e-9. A state may stay
  /// without choices: a dead end.
  /// @throws std::invalid_argument if s or an index is out of range, s or the action comes out of order, the
  /// features have the wrong length or are not finite, a probability is not positive, they do not sum to 1,
  /// or no transition leaves `s`.
  void add_choice(StateIndex s, ActionIndex action, std::span<const Transition> transitions);

  /// The process with the choices added so far; the builder is used up.
  [[nodiscard]] Mdp build() &&;

 private:
  std::uint32_t row_of(const std::vector<double>& features);

  Mdp mdp_;
  std::map<std::vector<double>, std::uint32_t> rows_;
  std::optional<std::size_t> last_state_;
  std::optional<std::size_t> last_action_;
};

}  // namespace kith
