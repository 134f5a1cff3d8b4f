#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kith/learners/bayesian_learner.hpp"
#include "kith/learners/learner_model.hpp"

namespace kith {

// The person of the model "bayesian" with these traits.
[[nodiscard]] BayesianLearner bayesian_person(const ParameterValues& values, std::span<const double> traits,
                                              const LearnerStart& start, const RandomStream& random);

// The parameters of "bayesian", then these.
[[nodiscard]] std::vector<Parameter> with_bayesian_parameters(std::vector<Parameter> more);

// A row like that of "bayesian": the same people, to whom `make` adds something else.
// @param parameters, fitted  have to stay.
[[nodiscard]] LearnerModel like_bayesian(std::string_view kind, std::string_view description,
                                         std::span<const Parameter> parameters, std::span<const FittedParameter> fitted,
                                         decltype(LearnerModel::make) make);

// Somebody who is like a person of "bayesian" in all that a derived class does not change.
class LikeBayesian : public Learner {
 public:
  void begin_component() override { person_.begin_component(); }
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    person_.watch(half_spaces, period);
  }
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const final {
    auto response = person_.answer(behaviours, tests, period);
    change_answers(response, behaviours, tests, period);
    return response;
  }
  [[nodiscard]] Response answer_by(Behaviours& behaviours, std::span<const StartIndex> tests, const Direction& weights,
                                   std::size_t period) const final {
    Response response{.answers = {}, .weights = weights};
    const auto cell = behaviours.locate(weights);
    for (const auto test : tests) response.answers.push_back(behaviours.answer(test, cell));
    change_answers(response, behaviours, tests, period);
    return response;
  }
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override {
    person_.hear_feedback(all_correct, half_spaces, period);
  }
  void be_convinced(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    person_.be_convinced(half_spaces, period);
  }
  void believe(ParticleBelief belief) override { person_.believe(std::move(belief)); }
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    return person_.likelihood(evidence);
  }
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const override {
    return person_.mass_in(half_spaces);
  }
  [[nodiscard]] const ParticleBelief* belief() const override { return person_.belief(); }
  [[nodiscard]] std::optional<double> ability() const override { return person_.ability(); }
  [[nodiscard]] std::optional<LearningAbilities> learning_abilities(bool begins_component) const override {
    return person_.learning_abilities(begins_component);
  }
  [[nodiscard]] std::vector<Direction> imagined_weights(std::size_t n, std::size_t period) const override {
    return person_.imagined_weights(n, period);
  }

 protected:
  // What the person makes of the best paths for the weights that they have in mind.
  virtual void change_answers(Response& /*response*/, Behaviours& /*behaviours*/, std::span<const StartIndex> /*tests*/,
                              std::size_t /*period*/) const {}

  LikeBayesian(BayesianLearner person, const RandomStream& random) : person_{std::move(person)}, random_{random} {}

  // Becomes (1 - share) times the present belief plus share times another.
  void blend(const ParticleBelief& other, double share, const RandomStream& random) {
    auto belief = *person_.belief();
    belief.blend(other, share, random);
    person_.believe(std::move(belief));
  }

  BayesianLearner person_;
  RandomStream random_;  // of what the person does besides: an address of its own
};

// The mean of f(weights, their policy cell) over those weights of the belief that have an answer to every test; nothing
// if there are none. @pre evidence has paths.
template <typename F>
std::optional<double> mean_over_weights(const ParticleBelief& belief, const AnswerEvidence& evidence, F f) {
  double possible = 0.0, sum = 0.0;
  const auto weights = belief.weights();
  for (std::size_t i = 0; i < belief.size(); ++i) {
    if (weights[i] == 0.0) continue;
    const auto point = belief.point(i);
    const bool answers = std::all_of(evidence.possible().begin(), evidence.possible().end(),
                                     [&](const HalfSpace& h) { return h.contains(point); });
    if (!answers) continue;
    possible += weights[i];
    sum += weights[i] * f(point, evidence.atlas().tables().cells().locate(point));
  }
  if (!(possible > 0.0)) return std::nullopt;
  return std::min(sum / possible, 1.0);
}

// The same for what depends on the policy cell alone, which is computed once for every cell.
template <typename F>
std::optional<double> mean_over_cells(const ParticleBelief& belief, const AnswerEvidence& evidence, F f) {
  std::vector<double> known(evidence.atlas().tables().cells().size(), -1.0);
  return mean_over_weights(belief, evidence, [&](const Direction& /*point*/, PolicyCellIndex cell) {
    auto& value = known[cell.value()];
    if (value < 0.0) value = f(cell);
    return value;
  });
}

// @throws std::invalid_argument unless the evidence has paths.
void require_paths(const AnswerEvidence& evidence);

}  // namespace kith
