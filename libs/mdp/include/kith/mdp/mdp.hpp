#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
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
  [[nodiscard]] std::span<const Choice> choices(StateIndex s) const;
  [[nodiscard]] std::span<const Outcome> outcomes(const Choice& choice) const;
  /// phi of an outcome, shape [num_features].
  [[nodiscard]] std::span<const double> features(const Outcome& outcome) const;
  /// The same as integers. @pre is_integral().
  [[nodiscard]] const IntegerVector& integer_features(const Outcome& outcome) const;

  /// Whether every choice has exactly one outcome.
  [[nodiscard]] bool is_deterministic() const noexcept { return deterministic_; }
  /// Whether every feature of every transition is an integer.
  [[nodiscard]] bool is_integral() const noexcept { return integral_; }
  /// Whether feature k is non-zero on some transition.
  [[nodiscard]] bool has_feature(std::size_t k) const { return has_feature_[k]; }

 private:
  friend class MdpBuilder;
  Mdp() = default;

  std::size_t num_terminals_ = 0;
  std::size_t num_actions_ = 0;
  std::size_t num_features_ = 0;
  double discount_ = 1.0;
  bool deterministic_ = true;
  bool integral_ = true;
  std::vector<bool> has_feature_;
  std::vector<std::uint32_t> first_choice_;  // shape [num_states + 1]
  std::vector<Choice> choices_;
  std::vector<Outcome> outcomes_;
  std::vector<double> feature_table_;          // row-major, shape [rows, num_features]
  std::vector<IntegerVector> integer_table_;   // shape [rows]; empty unless integral
};

/// Collects states in order and makes an Mdp. Choices of state s are added after
/// those of all states before s.
class MdpBuilder {
 public:
  /// @throws std::invalid_argument unless discount in (0, 1] and 1 <= num_features <= IntegerVector::kMaxDimension.
  MdpBuilder(std::size_t num_states, std::size_t num_terminals, std::size_t num_actions, std::size_t num_features,
             double discount);

  struct Transition {
    StateIndex next;
    double probability = 1.0;
    std::vector<double> features;  ///< phi(s, a, next), shape [num_features]
  };

  /// Adds a legal action of state `s`. Probabilities must sum to 1 within 1e-9.
  /// @throws std::invalid_argument if s or an index is out of range, s or the action comes out of order, the
  /// features have the wrong length or are not finite, or the probabilities do not sum to 1.
  void add_choice(StateIndex s, ActionIndex action, std::span<const Transition> transitions);

  [[nodiscard]] Mdp build() &&;

 private:
  Mdp mdp_;
  std::vector<std::vector<double>> rows_;
  std::optional<std::size_t> last_state_;
  std::optional<std::size_t> last_action_;
};

}  // namespace kith
