#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/random/stream.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/credible_level.hpp"
#include "kith/teaching/learner_bank.hpp"
#include "kith/teaching/observed_period.hpp"

namespace kith {

/// The constraints of all knowledge components that somebody who knows the prior may get wrong; sorted.
[[nodiscard]] std::vector<HalfSpace> constraints_to_learn(const Atlas& atlas);

/// How the answers of a person agree with what was expected of the person before each of them was seen, under the
/// hypotheses as all answers weigh them: a posterior predictive check [gelman2013].
struct Agreement {
  std::size_t tests = 0;  ///< That were answered.
  std::size_t right = 0;
  double expected = 0.0;  ///< Right answers.
  double variance = 0.0;  ///< Of the number of right answers.
  /// Twice the smaller probability of so few, or so many, right answers (half that of exactly so many): in [0, 1]; 1
  /// without tests.
  double p = 1.0;
  friend bool operator==(const Agreement&, const Agreement&) = default;
};

/// What one person believes, judged by the person's answers: the hypotheses of a LearnerBank, misconceptions that
/// lessons do not mend, and people who do not learn or answer otherwise than they believe (NonLearners).
///
/// A person either learns from everything, as a LearnerBank has it, or holds one misconception: violates one
/// constraint c_j of constraints_to_learn() whatever is shown, and learns everything else. For each of these states s
/// (0: learns; j: violates c_j) and each hypothesis h about the ability there is a belief B_sh; B_jh starts uniform
/// over the prior beyond c_j and never leaves it. Answers weigh the states and hypotheses, after each period:
///
///   w_sh <- w_sh P_sh(answers),    then    w_0h <- w_0h + mended w_jh,    w_jh <- (1 - mended) w_jh,
///
/// with P as in LearnerBank. The second step says that the feedback of a period may mend a misconception. People of
/// state 0 may stop learning before any period but the first.
class MisconceptionBank {
 public:
  struct Options {
    FilterOptions filter{};
    LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
    std::vector<LearnerHypothesis> hypotheses = grid_of_hypotheses();
    /// Probability, before anything was observed, that the person holds a misconception, each as probable as any
    /// other; in [0, 1).
    double misconceived = 0.2;
    double mended = 0.1;  ///< Probability that the feedback of a period ends a misconception, in [0, 1].
  };

  /// @param cache  of the domain; only its covers are used later.
  /// @throws std::invalid_argument if an option is out of range.
  MisconceptionBank(TeachingCache& cache, const Options& options, const RandomStream& random);

  /// The next period of this person; periods come in order.
  void observe(const Atlas& atlas, const ObservedPeriod& period);
  /// Lets all beliefs blur as over one or more periods without lessons. @param angle  in radians, >= 0.
  void forget(double angle, const RandomStream& random);

  /// c_j, the constraints that the person may violate.
  [[nodiscard]] std::span<const HalfSpace> constraints() const noexcept { return constraints_; }
  /// Probability of holding misconception j. @pre j < constraints().size().
  [[nodiscard]] double probability_of_misconception(std::size_t j) const;
  /// The probability that the person learns (still), with or without a misconception, and that of guessing.
  [[nodiscard]] double probability_of_learning() const noexcept { return 1.0 - others_.weight(); }
  [[nodiscard]] double probability_of_guessing() const noexcept { return others_.weight_of_guessing(); }
  /// See NonLearners::odds_of_learning(); people with a misconception learn.
  [[nodiscard]] double odds_of_learning() const noexcept { return others_.odds_of_learning(probability_of_learning()); }
  /// How far the answers agree with the hypotheses.
  [[nodiscard]] Agreement agreement() const;
  /// The probability that the weights from which the person would answer now violate the half-space; people who guess
  /// have no such weights.
  [[nodiscard]] double probability_of_violating(const HalfSpace& half_space) const;
  /// The probability that the weights from which the person would answer now satisfy all of the half-spaces.
  [[nodiscard]] double probability_of(std::span<const HalfSpace> half_spaces) const;
  /// The same for every state and hypothesis, with its probability: how often the person would satisfy them. People who
  /// guess never do.
  /// @param stopping  see NonLearners::shares(); the weights sum to 1 if it is 1.
  [[nodiscard]] std::vector<WeightedShare> shares(std::span<const HalfSpace> half_spaces, double stopping = 1.0) const;
  /// At most n weights of length 1, shape [d], from which the person would answer if this constraint is violated: drawn
  /// systematically, by probability. None if no belief violates it.
  [[nodiscard]] std::vector<Direction> violators(const HalfSpace& constraint, std::size_t n) const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  void let_some_stop();
  void mend();
  void scale_learners(double factor);

  std::vector<HalfSpace> constraints_;
  double mended_;
  std::vector<LearnerBank> banks_;            // per state
  std::vector<std::vector<double>> weights_;  // shape [states][hypotheses]; with others_ they sum to 1
  // Distribution of the number of right answers so far, shape [states][hypotheses][tests so far + 1].
  std::vector<std::vector<std::vector<double>>> right_;
  NonLearners others_;
  std::size_t num_tests_ = 0, num_right_ = 0;  // so far
  std::size_t component_ = kNone;              // of the last period
};

}  // namespace kith
