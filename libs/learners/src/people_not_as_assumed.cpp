#include "kith/learners/people_not_as_assumed.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "kith/core/distributions.hpp"
#include "like_bayesian.hpp"

namespace kith {
namespace {

// How somebody answers who believes nothing.
enum class Path {
  kAny,          // one of those that are best for somebody, each as probable as any other
  kWithDetours,  // the same with two steps more, which is best for nobody
  kShortest,     // with the fewest steps
  kOwn,          // the best for weights that were thought of beforehand
};

// Somebody who learns in the first periods only, if at all, and answers by what is believed then, or guesses.
class Inattentive final : public Learner {
 public:
  Inattentive(std::unique_ptr<Learner> as_assumed, std::size_t attentive_periods, std::unique_ptr<Learner> later)
      : person_{std::move(as_assumed)}, attentive_periods_{attentive_periods}, later_{std::move(later)} {}
  [[nodiscard]] std::unique_ptr<Learner> clone() const override {
    return std::make_unique<Inattentive>(person_->clone(), attentive_periods_, later_ ? later_->clone() : nullptr);
  }
  void begin_component() override { person_->begin_component(); }
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    if (period <= attentive_periods_) person_->watch(half_spaces, period);
  }
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const override {
    return (later_ && period > attentive_periods_ ? later_ : person_)->answer(behaviours, tests, period);
  }
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override {
    if (period <= attentive_periods_) person_->hear_feedback(all_correct, half_spaces, period);
  }
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    return person_->likelihood(evidence);
  }
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const override {
    return later_ ? 0.0 : person_->mass_in(half_spaces);
  }
  [[nodiscard]] const ParticleBelief* belief() const override { return person_->belief(); }

 private:
  std::unique_ptr<Learner> person_;
  std::size_t attentive_periods_;
  std::unique_ptr<Learner> later_;  // who answers from then on; null: the same person
};

// Somebody who learns nothing, and believes nothing but for Path::kOwn.
class Guesser final : public Learner {
 public:
  Guesser(Path path, const PriorCover& cover, RandomStream random) : path_{path}, random_{random} {
    constexpr std::size_t kPeople = 16;  // whose paths come to mind where behaviours are not tabulated
    auto draws = random_.split("people");
    for (std::size_t i = 0; i < kPeople; ++i) people_.push_back(cover.point(uniform_index(cover.size(), draws)));
  }
  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<Guesser>(*this); }
  void begin_component() override {}
  void watch(std::span<const HalfSpace> /*half_spaces*/, std::size_t /*period*/) override {}
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const override {
    Response response;
    auto random = random_.split("answer").split(period);
    for (const auto test : tests) response.answers.push_back(path(behaviours, test, random));
    return response;
  }
  void hear_feedback(bool /*all_correct*/, std::span<const HalfSpace> /*half_spaces*/,
                     std::size_t /*period*/) override {}
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    return evidence.chance();
  }
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const override {
    const auto holds = [&](const HalfSpace& h) { return h.contains(people_.front()); };
    return path_ == Path::kOwn && std::all_of(half_spaces.begin(), half_spaces.end(), holds) ? 1.0 : 0.0;
  }

 private:
  [[nodiscard]] std::vector<IntegerVector> paths(Behaviours& behaviours, StartIndex test) const {
    const auto& atlas = behaviours.atlas();
    std::vector<IntegerVector> all;
    if (const auto* tables = atlas.find_tables(); tables && path_ != Path::kOwn) {
      for (const auto& loss : tables->hull(tables->hull(test)).losses) all.push_back(atlas.feature_counts(test) - loss);
      return all;
    }
    for (const auto& weights : people_) {
      if (auto answer = behaviours.answer(test, behaviours.locate(weights))) all.push_back(*answer);
      if (path_ == Path::kOwn) break;
    }
    return all;
  }
  [[nodiscard]] std::optional<IntegerVector> path(Behaviours& behaviours, StartIndex test, RandomStream& random) const {
    const auto all = paths(behaviours, test);
    if (all.empty()) return std::nullopt;
    const auto& atlas = behaviours.atlas();
    const auto step = reference_feature(atlas.domain(), atlas.knowledge_components());
    auto chosen = all[uniform_index(all.size(), random)];
    for (const auto& other : all) {
      if (path_ == Path::kShortest && other[step] < chosen[step]) chosen = other;
    }
    if (path_ == Path::kWithDetours) chosen[step] += 2 * atlas.domain().count_scale();
    return chosen;
  }

  Path path_;
  RandomStream random_;
  std::vector<Direction> people_;
};

template <Path path>
std::unique_ptr<Learner> make_guesser(const ParameterValues& values, std::span<const double> /*traits*/,
                                      const LearnerStart& start, RandomStream random) {
  return std::make_unique<Guesser>(path, start.cover(num_particles(values)), random);
}

template <std::size_t attentive_periods, bool guesses_later = false>
std::unique_ptr<Learner> make_inattentive(const ParameterValues& values, std::span<const double> traits,
                                          const LearnerStart& start, RandomStream random) {
  return std::make_unique<Inattentive>(
      bayesian_model().make(values, traits, start, random), attentive_periods,
      guesses_later ? make_guesser<Path::kAny>(values, traits, start, random.split("later")) : nullptr);
}

// Somebody of another model, with the parameters that it has besides.
std::unique_ptr<Learner> make_of(const LearnerModel& model,
                                 const std::vector<std::pair<std::string_view, ParameterValue>>& more,
                                 const ParameterValues& values, std::span<const double> traits,
                                 const LearnerStart& start, const RandomStream& random) {
  ParameterValues all{model.parameters};
  for (std::size_t i = 0; i < values.values().size(); ++i) all.set(values.declared()[i].name, values.values()[i]);
  for (const auto& [name, value] : more) all.set(name, value);
  return model.make(all, traits, start, random);
}

template <std::int64_t constraint>
std::unique_ptr<Learner> make_stubborn(const ParameterValues& values, std::span<const double> traits,
                                       const LearnerStart& start, RandomStream random) {
  constexpr double kHardlyEver = 1e-100;
  return make_of(misconceived_model(), {{"constraint", constraint}, {"doubt", kHardlyEver}, {"openness", 0.0}}, values,
                 traits, start, random);
}

std::unique_ptr<Learner> make_slipping_often(const ParameterValues& values, std::span<const double> traits,
                                             const LearnerStart& start, RandomStream random) {
  return make_of(slipping_model(), {{"slip", 0.5}, {"guess", 0.1}}, values, traits, start, random);
}

std::unique_ptr<Learner> make_noisy(const ParameterValues& values, std::span<const double> traits,
                                    const LearnerStart& start, RandomStream random) {
  return make_of(noisy_rational_model(), {{"rationality", 2.0}}, values, traits, start, random);
}

std::unique_ptr<Learner> make_copying(const ParameterValues& values, std::span<const double> traits,
                                      const LearnerStart& start, RandomStream random) {
  return make_of(imitating_model(), {{"reward", 0.05}}, values, traits, start, random);
}

LearnerModel kind_row(std::string_view kind, decltype(LearnerModel::make) make) {
  auto model = bayesian_model();
  model.kind = kind;
  model.has_ability = false;
  model.make = std::move(make);
  model.describe = nullptr;
  return model;
}

}  // namespace

std::span<const LearnerModel> people_not_as_assumed() {
  static const std::vector<LearnerModel> models{kind_row("guesses", make_guesser<Path::kAny>),
                                                kind_row("guesses with detours", make_guesser<Path::kWithDetours>),
                                                kind_row("copies the shortest path", make_guesser<Path::kShortest>),
                                                kind_row("learns nothing", make_inattentive<0>),
                                                kind_row("learns for three periods", make_inattentive<3>),
                                                kind_row("learns for four periods", make_inattentive<4>),
                                                kind_row("learns for one period", make_inattentive<1>),
                                                kind_row("learns for two periods", make_inattentive<2>),
                                                kind_row("guesses after three periods", make_inattentive<3, true>),
                                                kind_row("has made up their mind", make_guesser<Path::kOwn>),
                                                kind_row("holds on to a first misconception", make_stubborn<1>),
                                                kind_row("holds on to a second misconception", make_stubborn<2>),
                                                kind_row("holds on to a third misconception", make_stubborn<3>),
                                                kind_row("slips every other time", make_slipping_often),
                                                kind_row("takes paths that are nearly as good", make_noisy),
                                                kind_row("imitates what was shown", make_copying)};
  return models;
}

}  // namespace kith
