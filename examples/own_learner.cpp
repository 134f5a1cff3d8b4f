// A learner of one's own: holds a single opinion about the reward, and keeps it until told to be wrong.
#include <array>
#include <cstdio>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/learners/run_period.hpp"
#include "kith/teaching/session.hpp"

namespace {

class OneOpinion final : public kith::Learner {
 public:
  OneOpinion(const kith::PriorCover& opinions, double patience, kith::RandomStream random)
      : opinions_{opinions, {.particles = opinions.size()}}, patience_{patience}, random_{random} {}

  [[nodiscard]] std::unique_ptr<kith::Learner> clone() const override { return std::make_unique<OneOpinion>(*this); }
  void begin_component() override { mistakes_ = 0; }

  // Believes what the demonstrations show, and looks for an opinion that fits only when patience is at an end.
  void watch(std::span<const kith::HalfSpace> shown, std::size_t period) override {
    heard_.insert(heard_.end(), shown.begin(), shown.end());
    if (mistakes_ > patience_) change_opinion(period);
  }

  [[nodiscard]] Response answer(kith::Behaviours& behaviours, std::span<const kith::StartIndex> tests,
                                std::size_t) const override {
    const auto cell = behaviours.locate(opinion());
    Response response;
    for (const auto test : tests) response.answers.push_back(behaviours.answer(test, cell));
    response.weights = opinion();
    return response;
  }

  void hear_feedback(bool all_correct, std::span<const kith::HalfSpace> corrections, std::size_t) override {
    heard_.insert(heard_.end(), corrections.begin(), corrections.end());
    mistakes_ += all_correct ? 0 : 1;
  }

  [[nodiscard]] std::optional<double> likelihood(const kith::AnswerEvidence& evidence) const override {
    if (!holds(evidence.possible())) return std::nullopt;
    bool gives_them = !evidence.is_contradictory() && holds(evidence.consistent());
    for (const auto& cone : evidence.outside()) gives_them = gives_them && !holds(cone);
    return gives_them ? 1.0 : 0.0;
  }

  [[nodiscard]] double mass_in(std::span<const kith::HalfSpace> half_spaces) const override {
    return holds(half_spaces) ? 1.0 : 0.0;
  }

 private:
  [[nodiscard]] kith::Direction opinion() const { return opinions_.point(held_); }
  [[nodiscard]] bool holds(std::span<const kith::HalfSpace> half_spaces) const {
    for (const auto& half_space : half_spaces) {
      if (!half_space.contains(opinion())) return false;
    }
    return true;
  }
  // What is drawn in a period comes from a branch of the stream that is addressed by the period.
  void change_opinion(std::size_t period) {
    auto random = random_.split(period);
    for (int attempt = 0; attempt < 100 && !holds(heard_); ++attempt) {
      held_ = kith::uniform_index(opinions_.size(), random);
    }
    mistakes_ = 0;
  }

  kith::ParticleBelief opinions_;  // evenly spread over what is known beforehand
  double patience_;
  kith::RandomStream random_;
  std::size_t held_ = 0;
  int mistakes_ = 0;
  std::vector<kith::HalfSpace> heard_;
};

const std::array kParameters{kith::Parameter{.name = "patience",
                                             .default_value = 1.0,
                                             .description = "mistakes that do not change the opinion yet",
                                             .max = 10.0}};
constexpr std::array kTraits{kith::LearnerTrait{"patience", "Mistakes that do not change the opinion yet."}};

const kith::LearnerModel kOneOpinion{
    .kind = "one-opinion",
    .description = "holds one opinion until patience is at an end",
    .parameters = kParameters,
    .traits = kTraits,
    .draw = [](const kith::ParameterValues& values,
               kith::RandomStream random) { return std::vector{values.real("patience") * kith::uniform01(random)}; },
    .make = [](const kith::ParameterValues&, std::span<const double> traits, const kith::LearnerStart& start,
               kith::RandomStream random) -> std::unique_ptr<kith::Learner> {
      return std::make_unique<OneOpinion>(start.cover(1000), traits[0], random);
    }};

}  // namespace

int main() {
  const kith::Atlas atlas{kith::load_domain("item-delivery")};
  kith::TeachingCache cache{atlas};
  const kith::RandomStream random{1};
  const kith::LearnerStart start{.cover = [&](std::size_t num_points) -> const kith::PriorCover& {
    return cache.cover(atlas.prior_cone(), num_points);
  }};

  kith::ParameterValues parameters{kOneOpinion.parameters};
  parameters.set("patience", 2.0);  // a value out of range is refused with its range
  kith::Learners people;
  for (std::uint64_t i = 1; i <= 2; ++i) {
    const auto person = random.split("person").split(i);
    const auto traits = kOneOpinion.draw(parameters, person.split("parameters"));
    people.push_back(kOneOpinion.make(parameters, traits, start, person.split("learner")));
  }

  const std::vector persons{random.split("teacher belief").split(1), random.split("teacher belief").split(2)};
  kith::Session session{cache, {.max_periods = 12}, kith::strategy_named("joint"), persons, random.split("teacher")};
  while (session.propose(cache)) {
    kith::run_period(session, cache, people);
    const auto& period = session.history().back();
    std::printf("period %2zu: %-16s right:", session.periods(),
                atlas.knowledge_components()[period.lesson.component].name.c_str());
    for (const bool right : period.feedback.all_correct) std::printf(" %s", right ? "yes" : "no");
    std::printf("\n");
  }
}
