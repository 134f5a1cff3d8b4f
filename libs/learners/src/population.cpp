#include "kith/learners/population.hpp"

#include <cmath>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

constexpr int kMaxDraws = 10'000;

void require(bool condition, const Population& population, const std::string& rule) {
  if (!condition) throw std::invalid_argument("draw_learner: population \"" + population.label + "\": " + rule);
}

void check(const GainDistribution& gain, const std::string& name, const Population& population) {
  require(gain.half_normal.has_value() != gain.value.has_value(), population,
          name + " needs either half_normal or value");
  const double parameter = gain.half_normal ? *gain.half_normal : *gain.value;
  require(parameter >= 0.0 && std::isfinite(parameter), population, name + " must be finite and not negative");
}

void check(const Population& population) {
  require(std::isfinite(population.ability_mean), population, "ability_mean must be finite");
  require(population.ability_sd >= 0.0 && std::isfinite(population.ability_sd), population,
          "ability_sd must be finite and not negative");
  require(
      population.ability_min >= 0.5 && population.ability_min < population.ability_max && population.ability_max <= 1.0,
      population, "0.5 <= ability_min < ability_max <= 1 must hold");
  require(population.gain_max > 0.0, population, "gain_max must be positive");
  require(population.ability_scale > 0.0 && std::isfinite(population.ability_scale), population,
          "ability_scale must be positive and finite");
  check(population.confirm_gain, "confirm_gain", population);
  check(population.correct_gain, "correct_gain", population);
}

double draw_ability(const Population& population, RandomStream random) {
  for (int attempt = 0; attempt < kMaxDraws; ++attempt) {
    const double ability = population.ability_mean + population.ability_sd * standard_normal(random);
    if (ability > population.ability_min && ability < population.ability_max) return ability;
  }
  throw Error{ErrorKind::kInfeasible, "no learning ability of population \"" + population.label +
                                          "\" lies between ability_min and ability_max in 10 000 draws"};
}

double draw_gain(const GainDistribution& gain, RandomStream& random) {
  return gain.value ? *gain.value : half_normal(*gain.half_normal, random);
}

}  // namespace

LearnerParameters draw_learner(const Population& population, RandomStream random) {
  check(population);
  LearnerParameters learner{.ability = draw_ability(population, random.split("ability")),
                            .ability_max = population.ability_max,
                            .ability_scale = population.ability_scale};
  RandomStream gains = random.split("gains");
  for (int attempt = 0; attempt < kMaxDraws; ++attempt) {
    learner.confirm_gain = draw_gain(population.confirm_gain, gains);
    learner.correct_gain = draw_gain(population.correct_gain, gains);
    const bool small = learner.confirm_gain < population.gain_max && learner.correct_gain < population.gain_max;
    if (small && (!population.ordered_gains || learner.confirm_gain < learner.correct_gain)) return learner;
  }
  throw Error{ErrorKind::kInfeasible,
              "no gains of population \"" + population.label + "\" meet gain_max and ordered_gains in 10 000 draws"};
}

}  // namespace kith
