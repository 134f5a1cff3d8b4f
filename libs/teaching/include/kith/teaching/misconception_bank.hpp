#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/credible_level.hpp"
#include "kith/teaching/lesson_beliefs.hpp"
#include "kith/teaching/non_learners.hpp"
#include "kith/teaching/observed_period.hpp"

namespace kith {

/// The constraints of all knowledge components that somebody who knows the prior may get wrong; sorted.
[[nodiscard]] std::vector<HalfSpace> constraints_to_learn(const Atlas& atlas);

/// How the answers of a person agree with what was expected of the person before each of them was seen, under the
/// hypotheses as all answers weigh them: a posterior predictive check [gelman2013].
struct Agreement {
  std::size_t tests = 0;  ///< That were asked; one without an answer counts as wrong.
  std::size_t right = 0;
  double expected = 0.0;  ///< Right answers.
  double variance = 0.0;  ///< Of the number of right answers.
  /// Twice the smaller probability of so few, or so many, right answers (half that of exactly so many): in [0, 1]; 1
  /// without tests.
  double p = 1.0;
  friend bool operator==(const Agreement&, const Agreement&) = default;
};

/// Somebody whom a person may be, as a bank has it.
struct PossiblePerson {
  /// What lessons do to them.
  enum class Kind { kLearns, kMisconceives, kDoesNotLearn, kGuesses };
  double weight = 0.0;  ///< Probability.
  Kind kind = Kind::kLearns;
  KnownBelief* belief = nullptr;  ///< Null: guesses.
  AnswerFit::Guess guess = AnswerFit::Guess::kSensible;
};

/// What one person believes, judged by the person's answers: people who learn, misconceptions that lessons do not mend,
/// people who stop learning, and those who guess or never learn (NonLearners).
///
/// A person either learns from everything or holds one misconception: violates one constraint c_j of
/// constraints_to_learn() whatever is shown, and learns everything else. For each of these states s (0: learns; j:
/// violates c_j) and each hypothesis h about the ability there is a belief B_sh of LessonBeliefs; B_jh starts uniform
/// over the prior beyond c_j and never leaves it. Answers weigh the states and hypotheses, after each period:
///
///   w_sh <- w_sh P_sh(answers),    then    w_0h <- w_0h + mended w_jh,    w_jh <- (1 - mended) w_jh,
///
/// with P as in AnswerFit. The second step says that the feedback of a period may mend a misconception. Before any
/// period but the first, a share NonLearners::kStop of those in state 0 stop learning: they keep the belief B_0h that
/// they have then, which makes a state of its own for every period. Where there are many hypotheses, one stands for
/// four of people with a misconception. Boards of an exam (ObservedPeriod::is_exam()) weigh, and change nobody.
class MisconceptionBank {
 public:
  struct Options : LessonBeliefs::Options {
    /// Probability, before anything was observed, that the person holds a misconception, each as probable as any
    /// other; in [0, 1).
    double misconceived = 0.2;
    double mended = 0.1;  ///< Probability that the feedback of a period ends a misconception, in [0, 1].
  };

  /// The beliefs that the banks of people with the same lessons share.
  [[nodiscard]] static std::shared_ptr<LessonBeliefs> beliefs(TeachingCache& cache, const Options& options,
                                                              const RandomStream& random);
  /// @param beliefs  as from beliefs(). @throws std::invalid_argument if an option is out of range.
  MisconceptionBank(const Atlas& atlas, const Options& options, std::shared_ptr<LessonBeliefs> beliefs);

  /// The next period of this person; periods come in order.
  /// @throws std::invalid_argument if the beliefs are those of people with other lessons.
  void observe(const Atlas& atlas, const ObservedPeriod& period);

  /// c_j, the constraints that the person may violate.
  [[nodiscard]] std::span<const HalfSpace> constraints() const noexcept { return constraints_; }
  /// Probability of holding misconception j. @pre j < constraints().size().
  [[nodiscard]] double probability_of_misconception(std::size_t j) const;
  /// The probability that the person learns (still), with or without a misconception, and that of guessing.
  [[nodiscard]] double probability_of_learning() const noexcept;
  [[nodiscard]] double probability_of_guessing() const noexcept { return others_.weight_of_guessing(); }
  /// See NonLearners::odds_of_learning(); people with a misconception learn.
  [[nodiscard]] double odds_of_learning() const noexcept { return others_.odds_of_learning(probability_of_learning()); }
  /// How many times as probable the answers are from people who learn than from those of them who guess the answers of
  /// every other period: the product of 2 L / (L + G) over periods and boards, with the probabilities L and G of the
  /// answers from people who learn and who guess. At most a share of 1 / r of those who guess so reaches r (Ville's
  /// inequality), as far as they otherwise answer as L says.
  [[nodiscard]] double odds_against_halves() const noexcept { return odds_against_halves_; }
  /// Boards of an exam so far.
  [[nodiscard]] std::size_t num_boards() const noexcept { return num_boards_; }
  /// How many times as probable the answers are from people who learn everything than from anybody who stopped,
  /// whenever, under whichever hypothesis, as far as whoever stopped satisfies the half-spaces less surely:
  ///
  ///   mean_h L_h / max_kh L_kh max(0, q - q_kh)
  ///
  /// with the likelihoods L of all answers and the probabilities q that the half-spaces hold often enough
  /// (probability_of_enough()). Infinite if nobody can have stopped.
  [[nodiscard]] double odds_against_stopping(std::span<const HalfSpace> half_spaces,
                                             const CredibleLevelOptions& options) const;
  /// How far the answers agree with the hypotheses.
  [[nodiscard]] Agreement agreement() const;
  /// The probability that the weights from which the person would answer now violate the half-space; people who guess
  /// have no such weights.
  [[nodiscard]] double probability_of_violating(const HalfSpace& half_space) const;
  /// The probability that the weights from which the person would answer now satisfy all of the half-spaces.
  [[nodiscard]] double probability_of(std::span<const HalfSpace> half_spaces) const;
  /// The same for every state and hypothesis, with its probability: how often the person would satisfy them. People who
  /// guess never do. The weights sum to 1, but for what is negligible.
  [[nodiscard]] std::vector<WeightedShare> shares(std::span<const HalfSpace> half_spaces) const;
  /// shares() of several lists of half-spaces after a time without lessons, in which beliefs blur: those of 99 % of the
  /// probability; the rest stay as they are. @param angle  in radians, >= 0.
  [[nodiscard]] std::vector<std::vector<WeightedShare>> shares_after(double angle,
                                                                     std::span<const std::vector<HalfSpace>> lists,
                                                                     const RandomStream& random) const;
  /// Everybody whom the person may be with a probability of at least `least`; valid until the next lesson is observed.
  [[nodiscard]] std::vector<PossiblePerson> possible_people(double least) const;
  /// At most n weights of length 1, shape [d], from which the person would answer if this constraint is violated: drawn
  /// systematically, by probability. None if no belief violates it.
  [[nodiscard]] std::vector<Direction> violators(const HalfSpace& constraint, std::size_t n) const;

 private:
  static constexpr std::size_t kGoesOn = static_cast<std::size_t>(-1);
  // Some people who learn with, or as far as, one hypothesis has it.
  struct People {
    std::size_t state = 0, hypothesis = 0;
    std::size_t periods = kGoesOn;   // after which they stopped
    double weight = 0.0;             // with others_ they sum to 1
    double likelihood = 0.0;         // of all answers, but for a factor common to all; in state 0
    std::vector<double> right{1.0};  // distribution of their number of right answers so far
  };
  [[nodiscard]] bool learns(const People& people) const { return people.state == 0 && people.periods == kGoesOn; }
  [[nodiscard]] KnownBelief& belief(const People& people) const;
  void weigh(const Atlas& atlas, const AnswerFit& fit, bool is_exam);
  void let_some_stop();
  void mend();

  std::vector<HalfSpace> constraints_;
  double mended_;
  std::size_t stands_for_ = 1;  // hypotheses that one of people with a misconception stands for
  std::shared_ptr<LessonBeliefs> beliefs_;
  std::vector<People> people_;  // those who learn first, by hypothesis
  NonLearners others_;
  double odds_against_halves_ = 1.0;
  std::size_t num_periods_ = 0, num_tests_ = 0, num_right_ = 0, num_boards_ = 0;  // so far
};

}  // namespace kith
