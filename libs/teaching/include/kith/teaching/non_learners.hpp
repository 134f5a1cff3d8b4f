#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/teaching/answer_fit.hpp"
#include "kith/teaching/credible_level.hpp"

namespace kith {

/// People whom lessons do not reach, as a bank of hypotheses weighs them beside people who learn: those who guess, or
/// give any path, from the first answer or from some period on; those who learn nothing and answer by the prior; and
/// those who stop learning before some period and answer by what they believe then.
///
/// Weights are probabilities, but those of people who learn are kept by the bank: all of them together sum to 1.
class NonLearners {
 public:
  static constexpr double kGuess = 0.05;  ///< Probability of guessing from the first answer, half of it either way.
  static constexpr double kLearnNothing = 0.05;  ///< Probability of learning nothing at all.
  static constexpr double kStop = 0.02;          ///< Probability per period, of who learns, of stopping to learn.
  static constexpr double kGuessOn = 0.005;      ///< Probability per period, of who learns, of guessing from now on.

  /// Nobody.
  NonLearners() = default;
  /// @param prior  what people believe before the first lesson.
  explicit NonLearners(const ParticleBelief& prior);

  [[nodiscard]] bool empty() const noexcept { return states_.empty(); }
  /// The probability of not learning (any more).
  /// @param stopping  see shares().
  [[nodiscard]] double weight(double stopping = 1.0) const noexcept;
  /// The probability of guessing.
  [[nodiscard]] double weight_of_guessing() const noexcept;

  /// A period begins, and some of those who learn stop.
  /// @param learn  the probability of learning so far, of which a share kStop + kGuessOn is taken over.
  /// @param belief  what they believe; null: those who stop are kept elsewhere, only kGuessOn is taken over.
  /// @param right  the distribution of their number of right answers so far.
  void begin_period(double learn, const ParticleBelief* belief, const std::vector<double>& right);
  /// Weighs by the answers of a period: weight() becomes the probability of the state and the answers.
  void see_answers(const AnswerFit& fit);
  /// Multiplies all weights, and drops states that have become negligible beside 1.
  void scale(double factor);

  /// How many times as probable the answers are from people who learn than from the likeliest of those who guess or
  /// learn nothing from the first period on. Of all such people at most a share of 1 / r ever gives answers for which
  /// this is r or more (Ville's inequality).
  /// @param learn  the probability of learning.
  [[nodiscard]] double odds_of_learning(double learn) const noexcept;

  /// The shares of these weights, those who guess with none; see MisconceptionBank::shares().
  /// @param stopping  as if it were so many times as probable to stop learning: for judges who have to be careful.
  [[nodiscard]] std::vector<WeightedShare> shares(std::span<const HalfSpace> half_spaces, double stopping = 1.0) const;
  /// Adds the mass of every policy cell. @pre behaviours are tabulated.
  void add_cell_masses(const Atlas& atlas, std::span<double> masses, double stopping = 1.0);

  struct State {
    double weight = 0.0;
    std::optional<ParticleBelief> belief{};  ///< None: guesses.
    AnswerFit::Guess guess = AnswerFit::Guess::kSensible;
    std::vector<double> right{1.0};  ///< Distribution of the number of right answers so far.
    double odds = 0.0;               ///< Of this against learning at first; 0: of who has learned before.
    PointCells cells{};
    friend bool operator==(const State& a, const State& b) {
      return a.weight == b.weight && a.belief == b.belief && a.guess == b.guess && a.right == b.right &&
             a.odds == b.odds;
    }
  };
  [[nodiscard]] std::span<const State> states() const noexcept { return states_; }

  friend bool operator==(const NonLearners&, const NonLearners&) = default;

 private:
  std::vector<State> states_;
};

}  // namespace kith
