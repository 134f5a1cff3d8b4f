#include <array>
#include <memory>
#include <numbers>
#include <utility>

#include "kith/core/math.hpp"
#include "like_bayesian.hpp"

namespace kith {
namespace {

// What was learned fades with time: b <- 2^(-t/h) b + (1 - 2^(-t/h)) b_0, with b_0 what was known at the start.
class DecayingLearner final : public LikeBayesian {
 public:
  DecayingLearner(BayesianLearner person, double half_life, const RandomStream& random)
      : LikeBayesian{std::move(person), random},
        start_{std::make_shared<const ParticleBelief>(*person_.belief())},
        half_life_{half_life} {}

  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<DecayingLearner>(*this); }

  void let_time_pass(double minutes, std::size_t period) override {
    blend(*start_, 1.0 - math::exp(-std::numbers::ln2 * minutes / half_life_), random_.split("fades").split(period));
  }

 private:
  std::shared_ptr<const ParticleBelief> start_;  // never changed, so that clones share it
  double half_life_;
};

constexpr std::array kHalfLives{2.0, 4.0, 8.0, 15.0, 30.0, 60.0};
constexpr std::array kDecayingFitted{FittedParameter{"half_life", kHalfLives}};

}  // namespace

const LearnerModel& decaying_model() {
  static const std::vector<Parameter> kParameters = with_bayesian_parameters({
      {.name = "half_life",
       .default_value = 30.0,
       .description =
           "minutes after which half of what was learned is as it was at the start; a period takes what [pace] says",
       .max = 1e6,
       .min_is_open = true,
       .source = "settles2016"},
  });
  static const LearnerModel kModel =
      like_bayesian("decaying", "like bayesian, but what was learned fades with time", kParameters, kDecayingFitted,
                    [](const ParameterValues& values, std::span<const double> traits, const LearnerStart& start,
                       RandomStream random) -> std::unique_ptr<Learner> {
                      return std::make_unique<DecayingLearner>(bayesian_person(values, traits, start, random),
                                                               values.real("half_life"), random);
                    });
  return kModel;
}

}  // namespace kith
