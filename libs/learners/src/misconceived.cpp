#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "like_bayesian.hpp"

namespace kith {
namespace {

// Starts sure of something false. Before the lesson of every period but the first a share of the belief is what
// somebody without the misconception knows at the start, so that there are always points that can be right.
class MisconceivedLearner final : public LikeBayesian {
 public:
  MisconceivedLearner(BayesianLearner person, std::shared_ptr<const ParticleBelief> unbiased, double openness,
                      const RandomStream& random)
      : LikeBayesian{std::move(person), random}, unbiased_{std::move(unbiased)}, openness_{openness} {}

  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<MisconceivedLearner>(*this); }

  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    if (period > 1) blend(*unbiased_, openness_, random_.split("openness").split(period));
    person_.watch(half_spaces, period);
  }

 private:
  std::shared_ptr<const ParticleBelief> unbiased_;  // never changed, so that clones share it
  double openness_;
};

// The constraint with this number, from 1, or the last one; nothing if there are none.
std::optional<HalfSpace> constraint_of(const LearnerStart& start, std::size_t number) {
  if (!start.components) return std::nullopt;
  const auto components = start.components();
  if (components.empty() || components.back().empty()) return std::nullopt;
  return components.back()[std::min(number, components.back().size()) - 1];
}

// The belief with this share of its mass where the constraint holds; as it is where all or none of it does.
ParticleBelief doubting(ParticleBelief belief, const HalfSpace& constraint, double doubt) {
  const double holds = belief.mass_in(std::array{constraint});
  if (holds <= 0.0 || holds >= 1.0) return belief;
  std::vector<double> factors;
  for (std::size_t i = 0; i < belief.size(); ++i) {
    factors.push_back(constraint.contains(belief.point(i)) ? doubt / holds : (1.0 - doubt) / (1.0 - holds));
  }
  belief.weigh_by(factors);
  return belief;
}

std::unique_ptr<Learner> make_misconceived(const ParameterValues& values, std::span<const double> traits,
                                           const LearnerStart& start, RandomStream random) {
  auto person = bayesian_person(values, traits, start, random);
  auto unbiased = std::make_shared<const ParticleBelief>(*person.belief());
  const auto constraint = constraint_of(start, static_cast<std::size_t>(values.count("constraint")));
  if (constraint) person.believe(doubting(*unbiased, *constraint, values.real("doubt")));
  return std::make_unique<MisconceivedLearner>(std::move(person), std::move(unbiased), values.real("openness"), random);
}

constexpr std::array kConstraints{1.0, 2.0, 3.0};
constexpr std::array kMisconceivedFitted{FittedParameter{"constraint", kConstraints}};

}  // namespace

const LearnerModel& misconceived_model() {
  static const std::vector<Parameter> kParameters = with_bayesian_parameters({
      {.name = "constraint",
       .default_value = std::int64_t{1},
       .description =
           "what is believed to be otherwise: the constraint of the last knowledge component with this number, in the "
           "order of kith inspect; numbers beyond the last stand for the last",
       .min = 1,
       .max = 1000},
      {.name = "doubt",
       .default_value = 0.05,
       .description = "mass of the belief, at the start, in which the constraint holds",
       .min_is_open = true},
      {.name = "openness",
       .default_value = 0.02,
       .description = "share of the belief that is replaced by an unbiased one before every period but the first",
       .source = "hesterberg1995"},
  });
  static const LearnerModel kModel = like_bayesian(
      "misconceived", "like bayesian, but at the start nearly sure that something true about the robot is false",
      kParameters, kMisconceivedFitted, make_misconceived);
  return kModel;
}

}  // namespace kith
