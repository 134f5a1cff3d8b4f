#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/integer_vector.hpp"
#include "kith/learners/answer_evidence.hpp"
#include "kith/teaching/learner_hypothesis.hpp"

namespace kith {

/// How well a person learns in a period, as HalfSpaceLikelihood takes it.
struct LearningAbilities {
  double shown = 0.8;     ///< beta while watching the demonstrations.
  double feedback = 0.8;  ///< beta while hearing the feedback, as expected before the answers are known.
};

/// A simulated person who watches demonstrations, answers tests and hears feedback. What a person is like is up to
/// the model (LearnerModel) that made them.
///
/// Calls: begin_component() when a knowledge component begins, also the first one; then in every period, in this order,
/// let_time_pass() (from the second period on), see(), watch(), answer(), in groups that talk be_convinced() or
/// believe() and answer() again, and hear_feedback(). Periods are numbered from
/// 1 and do not begin again with a component.
///
/// What every model promises, and the tests check for all registered ones (docs/library.md):
/// * What a person does depends on their parameters, their random stream and the calls so far only. What is drawn in
///   period t comes from a branch of the stream that is addressed by t, so that calls of answer() change nothing.
/// * A clone does what the original would do, and neither changes the other.
/// * likelihood() agrees with answer().
class Learner {
 public:
  virtual ~Learner() = default;

  /// A copy with the same state and the same random stream.
  [[nodiscard]] virtual std::unique_ptr<Learner> clone() const = 0;

  virtual void begin_component() = 0;

  /// Time passes before the lesson of a period: what the period before took, in minutes. Does nothing to most people.
  virtual void let_time_pass(double /*minutes*/, std::size_t /*period*/) {}

  /// Sees the demonstrations of a period themselves, right before watch() tells what they convey. Most people keep only
  /// that.
  virtual void see(const Atlas& /*atlas*/, std::span<const StartIndex> /*demonstrations*/) {}

  /// Watches the demonstrations of a period, which convey these half-spaces.
  virtual void watch(std::span<const HalfSpace> half_spaces, std::size_t period) = 0;

  /// One answer per test: the feature counts of the path, or their expectations. No answer where the person has none.
  struct Response {
    std::vector<std::optional<IntegerVector>> answers;
    std::optional<Direction> weights{};  ///< Weights whose optimal paths these are, if the person had some in mind.
  };
  /// @param behaviours  of the calling thread; a cache that changes no answer.
  [[nodiscard]] virtual Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                        std::size_t period) const = 0;
  /// What the person would answer with these weights in mind: nothing where they have no optimum. Exams ask like this.
  /// By default answer(), whatever the weights are.
  [[nodiscard]] virtual Response answer_by(Behaviours& behaviours, std::span<const StartIndex> tests,
                                           const Direction& /*weights*/, std::size_t period) const {
    return answer(behaviours, tests, period);
  }

  /// Hears whether all answers were right, and sees the corrections, which convey these half-spaces.
  virtual void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) = 0;

  /// Is convinced by another member, between the answers and the feedback of a period, that the robot's weights satisfy
  /// these half-spaces. Does nothing to people of models that do not say otherwise.
  virtual void be_convinced(std::span<const HalfSpace> /*half_spaces*/, std::size_t /*period*/) {}
  /// Comes to believe something else by talking to the others. As be_convinced().
  virtual void believe(ParticleBelief /*belief*/) {}  // NOLINT(performance-unnecessary-value-param): others keep it

  /// The probability, in [0, 1], that answer() gives exactly these answers in the present state; nothing if the
  /// person has no answer to these tests. @pre evidence is not empty, and has paths if LearnerModel::needs_paths.
  [[nodiscard]] virtual std::optional<double> likelihood(const AnswerEvidence& evidence) const = 0;

  /// How sure the person is that the robot's weights satisfy all of the half-spaces, in [0, 1].
  [[nodiscard]] virtual double mass_in(std::span<const HalfSpace> half_spaces) const = 0;

  /// The person's belief about the robot's weights, to record and to draw; null if the model has none.
  [[nodiscard]] virtual const ParticleBelief* belief() const { return nullptr; }

  /// Whether every answer is the best path for weights drawn from belief(), so that an exam can grade the belief.
  [[nodiscard]] virtual bool answers_as_believed() const { return belief() != nullptr; }

  /// How well the person learns now, in the model's own measure; nothing if the model has no such number.
  [[nodiscard]] virtual std::optional<double> ability() const { return std::nullopt; }

  /// How well the person would learn in the coming period; nothing if the model has no such numbers.
  /// @param begins_component  whether a knowledge component begins with that period.
  [[nodiscard]] virtual std::optional<LearningAbilities> learning_abilities(bool /*begins_component*/) const {
    return std::nullopt;
  }

  /// How often answers copy a demonstration instead, for teachers who presume that.
  [[nodiscard]] virtual Imitation imitation() const { return {}; }

  /// Some `n` weights (or fewer) that the person takes the robot's to be, as they imagine what it will do; none if
  /// the model does not imagine any. For studies with teacher.learner_counterfactuals = "self".
  [[nodiscard]] virtual std::vector<Direction> imagined_weights(std::size_t n, std::size_t period) const;

 protected:
  Learner() = default;
  Learner(const Learner&) = default;
  Learner(Learner&&) = default;
  Learner& operator=(const Learner&) = default;
  Learner& operator=(Learner&&) = default;
};

/// People in their seats.
using Learners = std::vector<std::unique_ptr<Learner>>;

/// log((1 - slip) * likelihood + slip * chance): of answers that are guessed with probability `slip`, at least
/// log(1e-300). 0 if there are no answers or the person has none, as that says nothing about the person.
[[nodiscard]] double log_likelihood(const Learner& learner, const AnswerEvidence& evidence, double slip = 0.0);

/// What demonstrations convey to somebody who expected the robot to follow one of these weights: the half-spaces of
/// every demonstration, each reduced to its minimal set, one demonstration behind the other.
/// @param regions  over behaviours.constraints().
[[nodiscard]] std::vector<HalfSpace> conveyed_to(Behaviours& behaviours, Regions& regions,
                                                 std::span<const StartIndex> demonstrations,
                                                 std::span<const Direction> expected);

}  // namespace kith
