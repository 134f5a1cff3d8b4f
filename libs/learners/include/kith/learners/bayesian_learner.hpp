#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/learners/learner.hpp"

namespace kith {

/// The numbers of one person of the model "bayesian", constant for a session.
struct BayesianPerson {
  double ability = 0.7;        ///< beta_0, in [0.5, 1].
  double confirm_gain = 0.0;   ///< Added to the ability after a period in which all answers were right.
  double correct_gain = 0.0;   ///< Added after a period with a wrong answer.
  double ability_max = 0.95;   ///< Cap on the ability, in [0.5, 1].
  double ability_scale = 1.0;  ///< Multiplies the log-odds of the current, capped ability at every update; > 0.
  std::size_t capacity = 0;    ///< Different constraints that are taken in per period; 0: all.
  double beyond_capacity = 0;  ///< Probability that a constraint beyond them is taken in all the same, in [0, 1].
  double forgetting = 0.0;     ///< Radians per axis by which the belief is blurred between periods, >= 0.
  friend bool operator==(const BayesianPerson&, const BayesianPerson&) = default;
};

/// A simulated person with a particle belief about the robot's reward, who learns from demonstrations and feedback
/// with an ability beta of their own, and answers tests with a single weight drawn from the belief
/// [jayaraman2024, section IV-A]. The model "bayesian".
///
/// Ability: beta_0 at the start of every knowledge component; after a period + confirm_gain if all answers were right,
/// else + correct_gain; never above ability_max. Every update uses the ability with its log-odds times ability_scale,
/// and at most 1 - 1e-9: somebody who is certain could find that nothing is possible any more.
/// The person never learns from their own answers.
///
/// Capacity: of the different constraints of a period, in the order of the demonstrations and then of the feedback, the
/// first `capacity` are taken in, every other one with probability `beyond_capacity`; whoever missed a constraint in
/// the lesson also misses it in the feedback. Forgetting: before the demonstrations of every period but the first the
/// belief is diffused (ParticleBelief::diffuse).
class BayesianLearner final : public Learner {
 public:
  BayesianLearner(ParticleBelief initial, const BayesianPerson& person, LikelihoodForm form, RandomStream random);

  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<BayesianLearner>(*this); }
  void begin_component() override { ability_ = person_.ability; }
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override;
  /// All answers come from one weight drawn from the belief among those with a finite optimum in every test; there are
  /// no answers at all if there is no such weight.
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const override;
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override;
  /// As from a demonstration, with the present ability.
  void be_convinced(std::span<const HalfSpace> half_spaces, std::size_t period) override;
  /// mass(weights that give exactly these answers) / mass(weights that give any); nothing if the latter is 0.
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override;
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const override {
    return belief_.mass_in(half_spaces);
  }
  [[nodiscard]] const ParticleBelief* belief() const override { return &belief_; }
  /// beta now, before scaling.
  [[nodiscard]] std::optional<double> ability() const override { return ability_; }
  /// Scaled; the feedback is expected to follow as many periods with all answers right as others.
  [[nodiscard]] std::optional<LearningAbilities> learning_abilities(bool begins_component) const override;
  /// Systematic draws from the belief.
  [[nodiscard]] std::vector<Direction> imagined_weights(std::size_t n, std::size_t period) const override;

  [[nodiscard]] const BayesianPerson& person() const noexcept { return person_; }
  /// The ability that hear_feedback() will lead to if this is `person` from now on.
  [[nodiscard]] double ability_after(bool all_correct, const BayesianPerson& person) const noexcept;
  /// From now on this is another person, with the same belief and ability at this moment: what `fit` uses to share the
  /// past of people who differ in what has not mattered yet.
  void become(const BayesianPerson& person) noexcept { person_ = person; }
  /// From now on this is what the person believes: for models of people whose beliefs change otherwise, too.
  void believe(ParticleBelief belief) override { belief_ = std::move(belief); }

 private:
  void learn(std::span<const HalfSpace> half_spaces, std::size_t period, RandomStream random);
  void observe(std::span<const HalfSpace> half_spaces, RandomStream random);
  [[nodiscard]] std::vector<HalfSpace> taken_in(std::span<const HalfSpace> half_spaces, std::size_t period);
  [[nodiscard]] Response tabulated_answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                          RandomStream random) const;
  [[nodiscard]] Response planned_answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                        RandomStream random) const;

  BayesianPerson person_;
  LikelihoodForm form_;
  RandomStream random_;
  ParticleBelief belief_;
  double ability_;
  // With a limited capacity: what was met in this period, and whether it was taken in.
  std::vector<std::pair<HalfSpace, bool>> met_;
};

}  // namespace kith
