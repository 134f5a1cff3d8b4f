#include "kith/learners/simulated_learner.hpp"

#include <algorithm>
#include <utility>

#include "kith/random/distributions.hpp"

namespace kith {

SimulatedLearner::SimulatedLearner(const Atlas& atlas, ParticleBelief initial, const LearnerParameters& parameters,
                                   LikelihoodForm form, RandomStream person)
    : atlas_{&atlas},
      parameters_{parameters},
      form_{form},
      person_{person},
      belief_{std::move(initial)},
      ability_{parameters.ability} {}

HalfSpaceLikelihood SimulatedLearner::likelihood() const {
  return HalfSpaceLikelihood{scaled_ability(ability_, parameters_.ability_scale), form_};
}

void SimulatedLearner::watch(std::span<const HalfSpace> half_spaces, std::size_t period) {
  belief_.observe(half_spaces, likelihood(), person_.split("watch").split(period));
}

std::vector<HalfSpace> SimulatedLearner::own_counterfactuals(Regions& regions,
                                                             std::span<const DemoIndex> demonstrations, std::size_t n,
                                                             std::size_t period) const {
  std::vector<PolicyCellIndex> cells;
  for (const auto& draw : belief_.systematic_draws(n, person_.split("imagine").split(period))) {
    cells.push_back(atlas_->cells().locate(belief_.point(draw.index)));
  }
  std::vector<HalfSpace> result;
  for (const auto demo : demonstrations) {
    const auto own = atlas_->constraints().half_spaces(regions.of(atlas_->conveyed(demo, cells)).minimal);
    result.insert(result.end(), own.begin(), own.end());
  }
  return result;
}

SimulatedLearner::Response SimulatedLearner::answer(std::span<const DemoIndex> tests, std::size_t period) const {
  Response response;
  response.answers.resize(tests.size());
  std::vector<double> weights(belief_.weights().begin(), belief_.weights().end());
  bool any = false;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto point = belief_.point(i);
    const bool finite = std::all_of(tests.begin(), tests.end(),
                                    [&](DemoIndex test) { return atlas_->finite_region(test).contains(point); });
    if (!finite) weights[i] = 0.0;
    any = any || weights[i] > 0.0;
  }
  if (!any) return response;
  auto random = person_.split("answer").split(period);
  response.weights = belief_.point(categorical(weights, random));
  const auto cell = atlas_->cells().locate(*response.weights);
  for (std::size_t t = 0; t < tests.size(); ++t) response.answers[t] = atlas_->answer(tests[t], cell);
  return response;
}

void SimulatedLearner::hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) {
  const double gain = all_correct ? parameters_.confirm_gain : parameters_.correct_gain;
  ability_ = std::min(ability_ + gain, parameters_.ability_max);
  belief_.observe(half_spaces, likelihood(), person_.split("feedback").split(period));
}

}  // namespace kith
