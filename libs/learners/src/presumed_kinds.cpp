#include "kith/learners/presumed_kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "kith/teaching/presumed_learner.hpp"

namespace kith {
namespace {

// A simulated person of a model in the place of a presumed one.
class PresumedPerson final : public PresumedLearner {
 public:
  explicit PresumedPerson(std::unique_ptr<Learner> person) : person_{std::move(person)} {}
  PresumedPerson(const PresumedPerson& other) : PresumedLearner{other}, person_{other.person_->clone()} {}
  PresumedPerson& operator=(const PresumedPerson&) = delete;
  ~PresumedPerson() override = default;

  [[nodiscard]] std::unique_ptr<PresumedLearner> clone() const override {
    return std::make_unique<PresumedPerson>(*this);
  }
  void begin_component() override { person_->begin_component(); }
  void let_time_pass(double minutes, std::size_t period) override { person_->let_time_pass(minutes, period); }
  void see(const Atlas& atlas, std::span<const StartIndex> demonstrations) override {
    person_->see(atlas, demonstrations);
  }
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    person_->watch(half_spaces, period);
  }
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override {
    person_->hear_feedback(all_correct, half_spaces, period);
  }

  [[nodiscard]] double likelihood(const AnswerFit& fit, PointCells& cells) const override {
    if (person_->answers_as_believed() || !fit.atlas().find_tables()) return fit.of(belief(), cells).likelihood;
    std::vector<GivenAnswer> given;
    for (const auto& one : fit.given()) given.push_back({one.start, one.counts});
    const double guess = fit.of(AnswerFit::Guess::kAny).likelihood;
    const auto answers = person_->likelihood(AnswerEvidence{fit.atlas(), given});
    return (1.0 - AnswerFit::slip()) * answers.value_or(guess) + AnswerFit::slip() * guess;
  }
  [[nodiscard]] const ParticleBelief& belief() const override { return *person_->belief(); }
  [[nodiscard]] double ability() const override { return person_->ability().value(); }
  [[nodiscard]] MemberHypothesis as_member(bool begins) const override {
    const auto abilities = person_->learning_abilities(begins).value();
    return {1.0, person_->belief(), abilities.shown, abilities.feedback, person_->imitation()};
  }

 private:
  std::unique_ptr<Learner> person_;
};

bool is_presumable(const LearnerModel& model) {
  const auto& usual = bayesian_model();
  const bool has_belief = num_particles(ParameterValues{model.parameters}) > 0;
  return model.has_ability && has_belief && model.traits.size() == usual.traits.size();
}

// The defaults of the model's parameters, with every combination of the whole numbers of `fitted`.
std::vector<ParameterValues> settings_of(const LearnerModel& model) {
  std::vector<ParameterValues> settings{ParameterValues{model.parameters}};
  for (const auto& fitted : model.fitted) {
    const auto declared = std::find_if(model.parameters.begin(), model.parameters.end(),
                                       [&](const auto& one) { return one.name == fitted.name; });
    if (!std::holds_alternative<std::int64_t>(declared->default_value)) continue;
    std::vector<ParameterValues> all;
    for (const auto& before : settings) {
      for (const double value : fitted.values) {
        all.push_back(before);
        all.back().set(fitted.name, static_cast<std::int64_t>(std::lround(value)));
      }
    }
    settings = std::move(all);
  }
  return settings;
}

std::shared_ptr<const PresumedKind> presumed_kind(const LearnerModel& model, const ParameterValues& setting) {
  auto make = [&model, setting](const LearnerHypothesis& hypothesis, const PresumedStart& start,
                                RandomStream random) -> std::unique_ptr<PresumedLearner> {
    auto values = setting;
    values.set("particles", static_cast<std::int64_t>(start.filter.particles));
    values.set("process_noise", start.filter.process_noise);
    const std::array traits{hypothesis.ability, hypothesis.confirm_gain, hypothesis.correct_gain};
    const LearnerStart beginning{
        .cover = [&start](std::size_t) -> const PriorCover& { return start.cover; },
        .likelihood = start.likelihood,
        .components = [&start] { return std::vector(start.components.begin(), start.components.end()); }};
    return std::make_unique<PresumedPerson>(model.make(values, traits, beginning, random));
  };
  return std::make_shared<const PresumedKind>(PresumedKind{std::string{model.kind}, std::move(make)});
}

}  // namespace

std::vector<std::string> presumable_kinds(LearnerModels models) {
  std::vector<std::string> kinds;
  for (const auto* model : models) {
    if (is_presumable(*model)) kinds.emplace_back(model->kind);
  }
  return kinds;
}

std::vector<LearnerHypothesis> hypotheses_about_kinds(const std::vector<std::string>& kinds, LearnerModels models) {
  constexpr std::array kAbilities{0.7, 0.85};
  std::vector<LearnerHypothesis> hypotheses;
  for (const auto& kind : kinds) {
    const auto* model = find_learner_model(kind, models);
    if (model == nullptr || !is_presumable(*model)) throw std::invalid_argument{"hypotheses_about_kinds: " + kind};
    const auto settings = settings_of(*model);
    for (const auto& setting : settings) {
      const auto presumed = model == &bayesian_model() ? nullptr : presumed_kind(*model, setting);
      for (const double ability : kAbilities) {
        auto& one = hypotheses.emplace_back();
        one.ability = ability;
        one.probability = 1.0 / static_cast<double>(settings.size() * kAbilities.size());
        one.kind = presumed;
      }
    }
  }
  return hypotheses;
}

}  // namespace kith
