#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kith/learners/learner_model.hpp"
#include "kith/random/distributions.hpp"

namespace kith::testing {

/// Simulated people of whom judges assume too much: they have the parameters of the model "bayesian", and beliefs like
/// it, but learn or answer otherwise. For domains with tables and a feature of steps, the last one.
namespace not_as_assumed {

/// Somebody who learns in the first periods only, if at all, and answers by what is believed then.
class Inattentive final : public Learner {
 public:
  Inattentive(std::unique_ptr<Learner> as_assumed, std::size_t attentive_periods)
      : person_{std::move(as_assumed)}, attentive_periods_{attentive_periods} {}
  [[nodiscard]] std::unique_ptr<Learner> clone() const override {
    return std::make_unique<Inattentive>(person_->clone(), attentive_periods_);
  }
  void begin_component() override { person_->begin_component(); }
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    if (period <= attentive_periods_) person_->watch(half_spaces, period);
  }
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const override {
    return person_->answer(behaviours, tests, period);
  }
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override {
    if (period <= attentive_periods_) person_->hear_feedback(all_correct, half_spaces, period);
  }
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    return person_->likelihood(evidence);
  }
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const override {
    return person_->mass_in(half_spaces);
  }
  [[nodiscard]] const ParticleBelief* belief() const override { return person_->belief(); }

 private:
  std::unique_ptr<Learner> person_;
  std::size_t attentive_periods_;
};

/// How somebody answers who believes nothing.
enum class Path {
  kAny,          ///< One of those that are best for somebody, each as probable as any other.
  kWithDetours,  ///< The same with two steps more, which is best for nobody.
  kShortest,     ///< With the fewest steps.
};

/// Somebody who understands nothing.
class Guesser final : public Learner {
 public:
  Guesser(Path path, RandomStream random) : path_{path}, random_{random} {}
  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<Guesser>(*this); }
  void begin_component() override {}
  void watch(std::span<const HalfSpace> /*half_spaces*/, std::size_t /*period*/) override {}
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const override {
    Response response;
    auto random = random_.split("answer").split(period);
    for (const auto test : tests) response.answers.emplace_back(path(behaviours.atlas(), test, random));
    return response;
  }
  void hear_feedback(bool /*all_correct*/, std::span<const HalfSpace> /*half_spaces*/,
                     std::size_t /*period*/) override {}
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    return evidence.chance();
  }
  [[nodiscard]] double mass_in(std::span<const HalfSpace> /*half_spaces*/) const override { return 0.0; }

 private:
  [[nodiscard]] IntegerVector path(const Atlas& atlas, StartIndex test, RandomStream& random) const {
    const auto& robot = atlas.feature_counts(test);
    const auto& losses = atlas.tables().hull(atlas.tables().hull(test)).losses;
    const auto step = robot.size() - 1;
    auto chosen = robot - losses[uniform_index(losses.size(), random)];
    for (const auto& loss : losses) {
      const auto other = robot - loss;
      if (path_ == Path::kShortest && other[step] < chosen[step]) chosen = other;
    }
    if (path_ == Path::kWithDetours) chosen[step] += 2 * atlas.domain().count_scale();
    return chosen;
  }

  Path path_;
  RandomStream random_;
};

template <std::size_t attentive_periods>
std::unique_ptr<Learner> make_inattentive(const ParameterValues& values, std::span<const double> traits,
                                          const LearnerStart& start, RandomStream random) {
  return std::make_unique<Inattentive>(bayesian_model().make(values, traits, start, random), attentive_periods);
}

template <Path path>
std::unique_ptr<Learner> make_guesser(const ParameterValues& /*values*/, std::span<const double> /*traits*/,
                                      const LearnerStart& /*start*/, RandomStream random) {
  return std::make_unique<Guesser>(path, random);
}

inline LearnerModel like_bayesian(std::string_view kind, decltype(LearnerModel::make) make) {
  auto model = bayesian_model();
  model.kind = kind;
  model.has_ability = false;
  model.make = make;
  model.describe = nullptr;
  return model;
}

}  // namespace not_as_assumed

/// One model of each kind.
[[nodiscard]] inline std::span<const LearnerModel> people_not_as_assumed() {
  using namespace not_as_assumed;
  static const std::vector<LearnerModel> models{
      like_bayesian("guesses", make_guesser<Path::kAny>),
      like_bayesian("guesses with detours", make_guesser<Path::kWithDetours>),
      like_bayesian("copies the shortest path", make_guesser<Path::kShortest>),
      like_bayesian("learns nothing", make_inattentive<0>),
      like_bayesian("learns for three periods", make_inattentive<3>),
      like_bayesian("learns for four periods", make_inattentive<4>)};
  return models;
}

}  // namespace kith::testing
