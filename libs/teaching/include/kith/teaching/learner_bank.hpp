#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/lesson.hpp"

namespace kith {

/// 0.99 P + 0.003: how much answers of probability P, in [0, 1], count for a hypothesis. People make slips.
[[nodiscard]] double weight_of_answers(double likelihood) noexcept;

/// Who is this? A bank of hypotheses about one member, with the belief that the person would have under each.
///
/// The beliefs learn from demonstrations and feedback, never from the person's answers, as simulated people do. Answers
/// weigh the hypotheses: after each period
///
///   w_h <- w_h (0.99 P_h + 0.003),   P_h = (mass of the weights that give exactly these answers)
///                                        / (mass of the weights that give any),
///
/// under the belief of hypothesis h, and the weights are normalised; 0.003 stands for slips. Where behaviours are not
/// tabulated, P_h is the mass of the weights that satisfy what the answers show; a path that is best for no weights, as
/// people may take it, counts in the same way. The ability of hypothesis h grows by its confirm_gain or correct_gain,
/// as observed, and is reset when a component begins. A hypothesis that somebody knows components begins with the
/// belief after their constraints, taken in with kAbilityOfKnowing.
class LearnerBank {
 public:
  /// @param random  the root of what moves the beliefs' points.
  /// @param components  constraints_of_components(), for hypotheses that somebody knows some of them.
  /// @throws std::invalid_argument if there is no hypothesis or one is out of range.
  LearnerBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
              std::vector<LearnerHypothesis> hypotheses, RandomStream random,
              std::span<const std::vector<HalfSpace>> components = {});

  void begin_component();
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period);
  /// @param verdicts  those of the answers, for domains without tables and for paths that are best for nobody.
  void see_answers(const Atlas& atlas, std::span<const Test> tests, std::span<const Answer> answers,
                   std::span<const Verdict> verdicts);
  /// P_h for answers that were given to all of the tests, one per hypothesis.
  [[nodiscard]] std::vector<double> likelihoods(const Atlas& atlas, std::span<const Test> tests,
                                                std::span<const Answer> answers, std::span<const Verdict> verdicts);
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period);

  /// Blurs all beliefs: every point is moved by N(0, angle^2) per axis of its tangent plane (radians), inside the
  /// prior.
  void forget(double angle, const RandomStream& random);

  [[nodiscard]] std::span<const LearnerHypothesis> hypotheses() const noexcept { return hypotheses_; }
  /// Posterior probabilities, one per hypothesis; sum to 1.
  [[nodiscard]] std::span<const double> weights() const noexcept { return weights_; }
  [[nodiscard]] const ParticleBelief& belief(std::size_t h) const { return beliefs_[h]; }
  /// The hypotheses as a strategy compares units with them. @param begins  whether a component begins.
  [[nodiscard]] std::vector<MemberHypothesis> as_members(bool begins) const;

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
  /// Mass of every policy cell under the mixture of the hypotheses. @pre behaviours are tabulated.
  [[nodiscard]] std::vector<double> cell_masses(const Atlas& atlas);
  /// Expected mass of the weights that satisfy the half-spaces.
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const;

  friend bool operator==(const LearnerBank& a, const LearnerBank& b) {
    return a.hypotheses_ == b.hypotheses_ && a.weights_ == b.weights_ && a.abilities_ == b.abilities_ &&
           a.beliefs_ == b.beliefs_;
  }

 private:
  struct AbilityBin {
    double low, high, probability;
  };
  void observe(std::size_t h, std::span<const HalfSpace> half_spaces, RandomStream random);
  [[nodiscard]] std::span<const std::uint32_t> cells_of(const Atlas& atlas, std::size_t h);
  [[nodiscard]] std::vector<AbilityBin> ability_bins() const;

  LikelihoodForm likelihood_;
  std::vector<LearnerHypothesis> hypotheses_;
  RandomStream random_;
  std::vector<double> weights_;
  std::vector<double> abilities_;  // now
  std::vector<ParticleBelief> beliefs_;
  // Policy cells of the points, which stay as long as nothing is resampled; a cache.
  struct Located {
    std::size_t num_resamplings = 0;
    std::vector<std::uint32_t> cells;
  };
  std::vector<Located> located_;
};

}  // namespace kith
