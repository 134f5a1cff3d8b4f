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

/// What one person believes, judged by the person's answers: the hypotheses of a LearnerBank, and misconceptions that
/// lessons do not mend.
///
/// A person either learns from everything, as a LearnerBank has it, or holds one misconception: violates one
/// constraint c_j of constraints_to_learn() whatever is shown, and learns everything else. For each of these states s
/// (0: learns; j: violates c_j) and each hypothesis h about the ability there is a belief B_sh; B_jh starts uniform
/// over the prior beyond c_j and never leaves it. Answers weigh the states and hypotheses, after each period:
///
///   w_sh <- w_sh (0.99 P_sh(answers) + 0.003),    then    w_0h <- w_0h + mended w_jh,    w_jh <- (1 - mended) w_jh,
///
/// with P as in LearnerBank. The second step says that the feedback of a period may mend a misconception.
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
  /// The probability that the weights from which the person would answer now satisfy all of the half-spaces.
  [[nodiscard]] double probability_of(std::span<const HalfSpace> half_spaces) const;
  /// The same for every state and hypothesis, with its probability: how often the person would satisfy them.
  [[nodiscard]] std::vector<WeightedShare> shares(std::span<const HalfSpace> half_spaces) const;
  /// At most n weights of length 1, shape [d], from which the person would answer if this constraint is violated: drawn
  /// systematically, by probability. None if no belief violates it.
  [[nodiscard]] std::vector<Direction> violators(const HalfSpace& constraint, std::size_t n) const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::vector<HalfSpace> constraints_;
  double mended_;
  std::vector<LearnerBank> banks_;            // per state
  std::vector<std::vector<double>> weights_;  // shape [states][hypotheses]; sum to 1
  std::size_t component_ = kNone;             // of the last period
};

}  // namespace kith
