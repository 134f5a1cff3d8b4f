#include "kith/learners/simulated_learner.hpp"

#include <algorithm>
#include <utility>

#include "kith/core/vector_clones.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

// weights[i] = 0 where normal . point i < 0.
KITH_VECTOR_CLONES void exclude_outside(const Eigen::Vector3d& normal, const ParticleBelief& belief,
                                        std::vector<double>& weights) {
  const double ux = normal.x();
  const double uy = normal.y();
  const double uz = normal.z();
  const double* const x = belief.x().data();
  const double* const y = belief.y().data();
  const double* const z = belief.z().data();
  double* const weight = weights.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weight[i] = ux * x[i] + (uy * y[i] + uz * z[i]) < 0.0 ? 0.0 : weight[i];
  }
}

}  // namespace

SimulatedLearner::SimulatedLearner(const Atlas& atlas, ParticleBelief initial, const LearnerParameters& parameters,
                                   LikelihoodForm form, RandomStream person)
    : atlas_{&atlas},
      parameters_{parameters},
      form_{form},
      person_{person},
      belief_{std::move(initial)},
      ability_{parameters.ability} {}

HalfSpaceLikelihood SimulatedLearner::likelihood() const {
  return HalfSpaceLikelihood{scaled_ability(ability_, parameters_.ability_scale), form_, belief_.dimension()};
}

void SimulatedLearner::watch(std::span<const HalfSpace> half_spaces, std::size_t period) {
  belief_.observe(half_spaces, likelihood(), person_.split("watch").split(period));
}

std::vector<HalfSpace> SimulatedLearner::own_counterfactuals(Behaviours& behaviours, Regions& regions,
                                                             std::span<const DemoIndex> demonstrations, std::size_t n,
                                                             std::size_t period) const {
  std::vector<PolicyCellIndex> cells;
  for (const auto& draw : belief_.systematic_draws(n, person_.split("imagine").split(period))) {
    cells.push_back(behaviours.locate(belief_.point(draw.index)));
  }
  std::vector<HalfSpace> result;
  for (const auto demo : demonstrations) {
    const auto own = behaviours.constraints().half_spaces(regions.minimal(behaviours.conveyed(demo, cells)));
    result.insert(result.end(), own.begin(), own.end());
  }
  return result;
}

// The belief's weights, 0 where some test has no finite optimum.
std::vector<double> SimulatedLearner::weights_with_answers(std::span<const DemoIndex> tests) const {
  std::vector<double> weights(belief_.weights().begin(), belief_.weights().end());
  std::vector<HalfSpace> facets;  // of all finite regions; many tests share theirs
  for (const auto test : tests) {
    for (const HalfSpace& facet : atlas_->finite_region(test).facets()) {
      if (std::find(facets.begin(), facets.end(), facet) == facets.end()) facets.push_back(facet);
    }
  }
  for (const HalfSpace& facet : facets) exclude_outside(facet.unit_normal(), belief_, weights);
  return weights;
}

SimulatedLearner::Response SimulatedLearner::answer(Behaviours& behaviours, std::span<const DemoIndex> tests,
                                                    std::size_t period) const {
  const auto random = person_.split("answer").split(period);
  return atlas_->is_tabulated() ? tabulated_answer(behaviours, tests, random)
                                : planned_answer(behaviours, tests, random);
}

SimulatedLearner::Response SimulatedLearner::tabulated_answer(Behaviours& behaviours, std::span<const DemoIndex> tests,
                                                              RandomStream random) const {
  Response response;
  response.answers.resize(tests.size());
  const std::vector<double> weights = weights_with_answers(tests);
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; })) return response;
  response.weights = belief_.point(categorical(weights, random));
  const auto cell = behaviours.locate(*response.weights);
  for (std::size_t t = 0; t < tests.size(); ++t) response.answers[t] = behaviours.answer(tests[t], cell);
  return response;
}

// Draws until the tests have an answer; a weight without one is not drawn again.
SimulatedLearner::Response SimulatedLearner::planned_answer(Behaviours& behaviours, std::span<const DemoIndex> tests,
                                                            RandomStream random) const {
  Response response;
  std::vector<double> weights(belief_.weights().begin(), belief_.weights().end());
  while (std::any_of(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; })) {
    const std::size_t drawn = categorical(weights, random);
    const auto cell = behaviours.locate(belief_.point(drawn));
    response.answers.clear();
    for (const DemoIndex test : tests) response.answers.push_back(behaviours.answer(test, cell));
    if (std::all_of(response.answers.begin(), response.answers.end(), [](const auto& a) { return a.has_value(); })) {
      response.weights = belief_.point(drawn);
      return response;
    }
    weights[drawn] = 0.0;
  }
  response.answers.assign(tests.size(), std::nullopt);
  return response;
}

void SimulatedLearner::hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) {
  const double gain = all_correct ? parameters_.confirm_gain : parameters_.correct_gain;
  ability_ = std::min(ability_ + gain, parameters_.ability_max);
  belief_.observe(half_spaces, likelihood(), person_.split("feedback").split(period));
}

}  // namespace kith
