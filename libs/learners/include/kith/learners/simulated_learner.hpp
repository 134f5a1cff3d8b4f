#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/learners/population.hpp"

namespace kith {

/// A simulated person: a particle belief about the robot's reward that learns
/// from demonstrations and feedback with an ability beta of its own, and answers
/// tests with a single weight drawn from it [jayaraman2024, section IV-A].
///
/// Ability: beta_0 at the start of every knowledge component; after a period
/// + confirm_gain if all answers were right, else + correct_gain; never above
/// ability_max. Each update uses the ability with its log-odds times ability_scale.
/// The person never learns from their own answers.
///
/// What happens in period t depends on the person's stream, t and what is shown
/// only. A value; the atlas must outlive it.
class SimulatedLearner {
 public:
  SimulatedLearner(const Atlas& atlas, ParticleBelief initial, const LearnerParameters& parameters, LikelihoodForm form,
                   RandomStream person);

  [[nodiscard]] const LearnerParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] const ParticleBelief& belief() const noexcept { return belief_; }
  /// beta now, before scaling.
  [[nodiscard]] double ability() const noexcept { return ability_; }

  /// A new knowledge component begins: the ability returns to beta_0.
  void begin_component() noexcept { ability_ = parameters_.ability; }

  /// Watches the demonstrations of a period, which convey the half-spaces.
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period);

  /// What the demonstrations convey to this person's own N systematically drawn beliefs, instead of
  /// to those that the teacher imagined; concatenated over the demonstrations, each reduced to its minimal set.
  /// @param regions over behaviours.constraints().
  [[nodiscard]] std::vector<HalfSpace> own_counterfactuals(Behaviours& behaviours, Regions& regions,
                                                           std::span<const DemoIndex> demonstrations, std::size_t n,
                                                           std::size_t period) const;

  /// One answer per test, all from one weight drawn from the belief among those with
  /// a finite optimum in every test; no answers at all if there is no such weight.
  struct Response {
    std::vector<std::optional<IntegerVector>> answers;  ///< Feature counts of the path, or expectations, per test.
    std::optional<Direction> weights;                   ///< The weight that was drawn.
  };
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const DemoIndex> tests, std::size_t period) const;

  /// Hears which answers were right: the ability changes, then the true half-spaces are learned with it.
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period);

 private:
  [[nodiscard]] HalfSpaceLikelihood likelihood() const;
  [[nodiscard]] std::vector<double> weights_with_answers(std::span<const DemoIndex> tests) const;
  [[nodiscard]] Response tabulated_answer(Behaviours& behaviours, std::span<const DemoIndex> tests,
                                          RandomStream random) const;
  [[nodiscard]] Response planned_answer(Behaviours& behaviours, std::span<const DemoIndex> tests,
                                        RandomStream random) const;

  const Atlas* atlas_;
  LearnerParameters parameters_;
  LikelihoodForm form_;
  RandomStream person_;
  ParticleBelief belief_;
  double ability_;
};

}  // namespace kith
