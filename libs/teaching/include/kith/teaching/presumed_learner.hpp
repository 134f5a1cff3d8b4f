#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/stream.hpp"
#include "kith/teaching/answer_fit.hpp"
#include "kith/teaching/learner_hypothesis.hpp"

namespace kith {

/// Somebody as a hypothesis of a LearnerBank has them: what they believe after what they were shown and told, and how
/// probable their answers then are. Called as a simulated Learner is; the person's answers change nothing.
class PresumedLearner {
 public:
  virtual ~PresumedLearner() = default;
  [[nodiscard]] virtual std::unique_ptr<PresumedLearner> clone() const = 0;

  virtual void begin_component() = 0;
  virtual void let_time_pass(double /*minutes*/, std::size_t /*period*/) {}
  virtual void see(const Atlas& /*atlas*/, std::span<const StartIndex> /*demonstrations*/) {}
  virtual void watch(std::span<const HalfSpace> half_spaces, std::size_t period) = 0;
  virtual void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) = 0;

  /// The probability of exactly these answers, in (0, 1]. @param cells  of the belief's points; changed as a cache
  /// only.
  [[nodiscard]] virtual double likelihood(const AnswerFit& fit, PointCells& cells) const = 0;
  [[nodiscard]] virtual const ParticleBelief& belief() const = 0;
  /// With which the person learns now.
  [[nodiscard]] virtual double ability() const = 0;
  /// As a strategy compares units, with weight 1. @param begins  whether a component begins.
  [[nodiscard]] virtual MemberHypothesis as_member(bool begins) const = 0;

 protected:
  PresumedLearner() = default;
  PresumedLearner(const PresumedLearner&) = default;
  PresumedLearner& operator=(const PresumedLearner&) = default;
};

/// What a presumed person begins with.
struct PresumedStart {
  const PriorCover& cover;
  FilterOptions filter;
  LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;
  std::span<const std::vector<HalfSpace>> components;  ///< constraints_of_components()
};

/// A kind of people that a hypothesis may be about: see hypotheses_about_kinds() of kith/learners.
struct PresumedKind {
  std::string name;  ///< Of the learner model. Hypotheses with different parameters of a kind share it.
  std::function<std::unique_ptr<PresumedLearner>(const LearnerHypothesis& hypothesis, const PresumedStart& start,
                                                 RandomStream random)>
      make;
};

/// What people are who are of no PresumedKind.
inline constexpr std::string_view kUsualKind = "bayesian";

}  // namespace kith
