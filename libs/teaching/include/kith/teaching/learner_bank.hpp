#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/teaching/answer_fit.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/non_learners.hpp"
#include "kith/teaching/presumed_learner.hpp"

namespace kith {

/// A kind of people and the probability that somebody is one of them.
struct KindProbability {
  std::string kind;  ///< As in study files.
  double probability = 0.0;
  friend bool operator==(const KindProbability&, const KindProbability&) = default;
};
/// The kind that somebody is with a probability of at least 0.8, else "cannot tell yet".
[[nodiscard]] std::string kind_word(std::span<const KindProbability> kinds);
/// The kinds that hypotheses are about, each once, in their order, with their probabilities beforehand.
[[nodiscard]] std::vector<KindProbability> kinds_of(std::span<const LearnerHypothesis> hypotheses);

/// Who is this? A bank of hypotheses about one member, with the belief that the person would have under each, and of
/// people who do not learn (NonLearners).
///
/// The beliefs learn from demonstrations and feedback, never from the person's answers, as simulated people do. Answers
/// weigh the hypotheses: after each period w_h <- w_h P_h, where P_h is the probability of exactly these answers under
/// the belief of hypothesis h (AnswerFit), and the weights are normalised together with those of people who do not
/// learn. The ability of hypothesis h grows by its confirm_gain or correct_gain, as observed, and is reset when a
/// component begins. A hypothesis that somebody knows components begins with the belief after their constraints, taken
/// in with kAbilityOfKnowing. Hypotheses about other kinds of people
/// (PresumedKind) say themselves what those believe and how probable that makes the answers.
class LearnerBank {
 public:
  /// @param random  the root of what moves the beliefs' points.
  /// @param components  constraints_of_components(), for hypotheses that somebody knows some of them.
  /// NonLearners are left out with a single hypothesis, which answers cannot weigh.
  /// @throws std::invalid_argument if there is no hypothesis or one is out of range.
  LearnerBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
              std::vector<LearnerHypothesis> hypotheses, RandomStream random,
              std::span<const std::vector<HalfSpace>> components = {});

  /// What has become of people by the same change, for the banks of members who share them: banks that are copies of
  /// one share the people of their hypotheses for as long as the same happens to these, and each changes once.
  using Changed = std::map<std::shared_ptr<const PresumedLearner>, std::shared_ptr<const PresumedLearner>, std::less<>>;

  void begin_component(Changed* changed = nullptr);
  /// The time since the period before, and what is shown: as Learner::let_time_pass() and see(), before watch().
  void let_time_pass(double minutes, std::size_t period, Changed* changed = nullptr);
  void see(const Atlas& atlas, std::span<const StartIndex> demonstrations, Changed* changed = nullptr);
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period, Changed* changed = nullptr);
  /// What the person answered; tests without an answer say nothing.
  void see_answers(const AnswerFit& fit);
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period,
                     Changed* changed = nullptr);

  [[nodiscard]] std::span<const LearnerHypothesis> hypotheses() const noexcept { return hypotheses_; }
  /// Posterior probabilities, one per hypothesis, if the person learns; sum to 1.
  [[nodiscard]] std::span<const double> weights() const noexcept { return weights_; }
  /// Posterior probability that the person learns (still).
  [[nodiscard]] double probability_of_learning() const noexcept { return learns_; }
  /// See NonLearners::odds_of_learning(); infinite if everybody learns.
  [[nodiscard]] double odds_of_learning() const noexcept { return others_.odds_of_learning(learns_); }
  [[nodiscard]] const ParticleBelief& belief(std::size_t h) const { return people_[h].person->belief(); }
  /// What kind of learner this is, if the person learns: the kinds of the hypotheses, each once, in their order.
  [[nodiscard]] std::vector<KindProbability> kinds() const;
  /// The hypotheses as a strategy compares units with them: if the person learns, as lessons change nobody else. @param
  /// begins  whether a component begins.
  [[nodiscard]] std::vector<MemberHypothesis> as_members(bool begins) const;

  // Estimates of abilities, and of what was known, are those if the person learns.

  /// Posterior mean of the ability now.
  [[nodiscard]] double expected_present_ability() const;
  /// Posterior mean of the initial ability.
  [[nodiscard]] double expected_ability() const;
  /// The initial ability below which the posterior puts probability q, in [0, 1]; linear between the abilities of the
  /// bank, each of which stands for the range halfway to its neighbours.
  [[nodiscard]] double ability_quantile(double q) const;
  /// Posterior probability that the initial ability is at least this; with the same interpolation.
  [[nodiscard]] double probability_of_ability(double at_least) const;
  /// Posterior probability that the member knew the component beforehand.
  [[nodiscard]] double probability_of_knowing(std::size_t component) const;
  /// Mass of every policy cell under the mixture of the hypotheses and of people who do not learn; those who guess have
  /// none. @param stopping  see NonLearners::shares(). @pre behaviours are tabulated.
  [[nodiscard]] std::vector<double> cell_masses(const Atlas& atlas, double stopping = 1.0);
  /// Expected mass of the weights that satisfy the half-spaces, under the same mixture.
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const;

  /// The probability of something that depends on what the person believes, under the same mixture; of those who guess
  /// it is taken not to hold.
  /// @param holds  gets a belief, and the share of answers that are the person's own and no imitations.
  [[nodiscard]] double probability_that(const std::function<bool(const ParticleBelief&, double own)>& holds) const;

  friend bool operator==(const LearnerBank& a, const LearnerBank& b) {
    return a.hypotheses_ == b.hypotheses_ && a.weights_ == b.weights_ && a.people_ == b.people_ &&
           a.learns_ == b.learns_ && a.others_ == b.others_;
  }

 private:
  struct AbilityBin {
    double low, high, probability;
  };
  struct Presumed {
    std::shared_ptr<const PresumedLearner> person;
    PointCells cells{};
    friend bool operator==(const Presumed& a, const Presumed& b) {
      return a.person->ability() == b.person->ability() && a.person->belief() == b.person->belief();
    }
  };
  [[nodiscard]] std::vector<AbilityBin> ability_bins() const;
  // @param usual  those of the usual kind, too.
  template <typename Change>
  void change_all(Changed* changed, Change change, bool usual = true);

  std::vector<LearnerHypothesis> hypotheses_;
  std::vector<double> weights_;
  std::vector<Presumed> people_;
  double learns_ = 1.0;  // with the weights of others_ 1
  NonLearners others_;
  bool has_begun_ = false;  // some lesson was watched
};

}  // namespace kith
