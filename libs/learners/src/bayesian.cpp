#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/core/vector_clones.hpp"
#include "kith/learners/bayesian_learner.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "like_bayesian.hpp"

namespace kith {
namespace {

// --- the person --------------------------------------------------------------

constexpr double kSurest = 1.0 - 1e-9;  // certainty could exclude every particle

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

// The belief's weights, 0 where some test has no finite optimum.
std::vector<double> weights_with_answers(const Atlas& atlas, const ParticleBelief& belief,
                                         std::span<const StartIndex> tests) {
  std::vector<double> weights(belief.weights().begin(), belief.weights().end());
  std::vector<HalfSpace> facets;  // of all finite regions; many tests share theirs
  for (const auto test : tests) {
    for (const HalfSpace& facet : atlas.tables().finite_region(test).facets()) {
      if (std::find(facets.begin(), facets.end(), facet) == facets.end()) facets.push_back(facet);
    }
  }
  for (const HalfSpace& facet : facets) exclude_outside(facet.unit_normal(), belief, weights);
  return weights;
}

bool holds(const std::vector<HalfSpace>& half_spaces, const Direction& w) {
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& h) { return h.contains(w); });
}

// The mass of the weights that give exactly the answers.
double consistent_mass(const AnswerEvidence& evidence, const ParticleBelief& belief) {
  if (evidence.is_contradictory()) return 0.0;
  if (evidence.outside().empty()) return belief.mass_in(evidence.consistent());
  double mass = 0.0;
  const auto weights = belief.weights();
  for (std::size_t i = 0; i < belief.size(); ++i) {
    if (weights[i] == 0.0) continue;
    const auto point = belief.point(i);
    if (!holds(evidence.consistent(), point)) continue;
    const bool fits = std::none_of(evidence.outside().begin(), evidence.outside().end(),
                                   [&](const auto& cone) { return holds(cone, point); });
    if (fits) mass += weights[i];
  }
  return mass;
}

}  // namespace

BayesianLearner::BayesianLearner(ParticleBelief initial, const BayesianPerson& person, LikelihoodForm form,
                                 RandomStream random)
    : person_{person}, form_{form}, random_{random}, belief_{std::move(initial)}, ability_{person.ability} {}

void BayesianLearner::observe(std::span<const HalfSpace> half_spaces, RandomStream random) {
  const double scaled = std::min(scaled_ability(ability_, person_.ability_scale), kSurest);
  belief_.observe(half_spaces, HalfSpaceLikelihood{scaled, form_, belief_.dimension()}, random);
}

// The half-spaces without those that are too many for the period.
std::vector<HalfSpace> BayesianLearner::taken_in(std::span<const HalfSpace> half_spaces, std::size_t period) {
  std::vector<HalfSpace> result;
  for (const auto& half_space : half_spaces) {
    auto known = std::find_if(met_.begin(), met_.end(), [&](const auto& before) { return before.first == half_space; });
    if (known == met_.end()) {
      auto random = random_.split("capacity").split(period).split(met_.size());
      const bool is_within = met_.size() < person_.capacity || uniform01(random) < person_.beyond_capacity;
      known = met_.insert(met_.end(), {half_space, is_within});
    }
    if (known->second) result.push_back(half_space);
  }
  return result;
}

void BayesianLearner::learn(std::span<const HalfSpace> half_spaces, std::size_t period, RandomStream random) {
  if (person_.capacity == 0) return observe(half_spaces, random);
  observe(taken_in(half_spaces, period), random);
}

void BayesianLearner::watch(std::span<const HalfSpace> half_spaces, std::size_t period) {
  met_.clear();
  if (person_.forgetting > 0.0 && period > 1) {
    belief_.diffuse(person_.forgetting, random_.split("forget").split(period));
  }
  learn(half_spaces, period, random_.split("watch").split(period));
}

void BayesianLearner::hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) {
  ability_ = ability_after(all_correct, person_);
  learn(half_spaces, period, random_.split("feedback").split(period));
}

void BayesianLearner::be_convinced(std::span<const HalfSpace> half_spaces, std::size_t period) {
  learn(half_spaces, period, random_.split("convinced").split(period));
}

double BayesianLearner::ability_after(bool all_correct, const BayesianPerson& person) const noexcept {
  return std::min(ability_ + (all_correct ? person.confirm_gain : person.correct_gain), person.ability_max);
}

std::optional<LearningAbilities> BayesianLearner::learning_abilities(bool begins_component) const {
  const auto usable = [&](double ability) { return std::min(scaled_ability(ability, person_.ability_scale), kSurest); };
  const double now = begins_component ? person_.ability : ability_;
  const double gain = (person_.confirm_gain + person_.correct_gain) / 2.0;
  return LearningAbilities{usable(now), usable(std::max(now, std::min(now + gain, person_.ability_max)))};
}

std::vector<Direction> BayesianLearner::imagined_weights(std::size_t n, std::size_t period) const {
  std::vector<Direction> weights;
  for (const auto& draw : belief_.systematic_draws(n, random_.split("imagine").split(period))) {
    weights.push_back(belief_.point(draw.index));
  }
  return weights;
}

std::optional<double> BayesianLearner::likelihood(const AnswerEvidence& evidence) const {
  const double possible = belief_.mass_in(evidence.possible());
  if (possible <= 0.0) return std::nullopt;
  return std::min(consistent_mass(evidence, belief_) / possible, 1.0);
}

Learner::Response BayesianLearner::answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                          std::size_t period) const {
  const auto random = random_.split("answer").split(period);
  return behaviours.atlas().find_tables() ? tabulated_answer(behaviours, tests, random)
                                          : planned_answer(behaviours, tests, random);
}

Learner::Response BayesianLearner::tabulated_answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                                    RandomStream random) const {
  Response response;
  response.answers.resize(tests.size());
  const std::vector<double> weights = weights_with_answers(behaviours.atlas(), belief_, tests);
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; })) return response;
  response.weights = belief_.point(categorical(weights, random));
  const auto cell = behaviours.locate(*response.weights);
  for (std::size_t t = 0; t < tests.size(); ++t) response.answers[t] = behaviours.answer(tests[t], cell);
  return response;
}

// Draws until the tests have an answer; a weight without one is not drawn again.
Learner::Response BayesianLearner::planned_answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                                  RandomStream random) const {
  Response response;
  std::vector<double> weights(belief_.weights().begin(), belief_.weights().end());
  while (std::any_of(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; })) {
    const std::size_t drawn = categorical(weights, random);
    const auto cell = behaviours.locate(belief_.point(drawn));
    response.answers.clear();
    for (const StartIndex test : tests) response.answers.push_back(behaviours.answer(test, cell));
    if (std::all_of(response.answers.begin(), response.answers.end(), [](const auto& a) { return a.has_value(); })) {
      response.weights = belief_.point(drawn);
      return response;
    }
    weights[drawn] = 0.0;
  }
  response.answers.assign(tests.size(), std::nullopt);
  return response;
}

// --- the model ---------------------------------------------------------------

namespace {

constexpr int kMaxDraws = 10'000;

std::optional<ParameterProblem> check_bayesian(const ParameterValues& values) {
  if (values.real("ability.min") < values.real("ability_max")) return std::nullopt;
  return ParameterProblem{"ability", "no ability lies between min and ability_max",
                          "ability.min must be less than ability_max"};
}

double draw_ability(const ParameterValues& values, RandomStream random) {
  const double mean = values.real("ability.mean");
  const double sd = values.real("ability.sd");
  const double min = values.real("ability.min");
  const double max = values.real("ability_max");
  for (int attempt = 0; attempt < kMaxDraws; ++attempt) {
    const double ability = mean + sd * standard_normal(random);
    if (ability > min && ability < max) return ability;
  }
  throw Error{ErrorKind::kInfeasible, "in 10 000 draws, no initial ability is above ability.min and below ability_max"};
}

double draw_gain(const Spread& gain, RandomStream& random) {
  return gain.value ? *gain.value : half_normal(gain.half_normal.value(), random);
}

// The ability (normal, redrawn until inside the limits), then both gains, redrawn together until they meet the rules;
// each from its own branch of the stream, so that a change of one distribution leaves the other's draws.
std::vector<double> draw_bayesian(const ParameterValues& values, RandomStream random) {
  const double ability = draw_ability(values, random.split("ability"));
  const auto& confirm = values.spread("confirm_gain");
  const auto& correct = values.spread("correct_gain");
  const double max = values.real("gain_max");
  const bool ordered = values.boolean("ordered_gains");
  RandomStream gains = random.split("gains");
  for (int attempt = 0; attempt < kMaxDraws; ++attempt) {
    const double confirm_gain = draw_gain(confirm, gains);
    const double correct_gain = draw_gain(correct, gains);
    const bool small = confirm_gain < max && correct_gain < max;
    if (small && (!ordered || confirm_gain < correct_gain)) return {ability, confirm_gain, correct_gain};
  }
  throw Error{ErrorKind::kInfeasible, std::string{"in 10 000 draws, no gains are below gain_max"} +
                                          (ordered ? " with confirm_gain below correct_gain (ordered_gains)" : "")};
}

BayesianPerson person_of(const ParameterValues& values, std::span<const double> traits) {
  return {.ability = traits[0],
          .confirm_gain = traits[1],
          .correct_gain = traits[2],
          .ability_max = values.real("ability_max"),
          .ability_scale = values.real("ability_scale"),
          .capacity = static_cast<std::size_t>(values.count("capacity")),
          .beyond_capacity = values.real("beyond_capacity"),
          .forgetting = values.real("forgetting")};
}

// What somebody knows who knows each component with this probability; every constraint once.
std::vector<HalfSpace> known_by_chance(double probability, const std::vector<std::vector<HalfSpace>>& components,
                                       RandomStream random) {
  std::vector<HalfSpace> known;
  for (std::size_t k = 0; k < num_known_by_chance(components.size()); ++k) {
    auto draw = random.split(k);
    if (!(uniform01(draw) < probability)) continue;
    for (const auto& half_space : components[k]) {
      if (std::find(known.begin(), known.end(), half_space) == known.end()) known.push_back(half_space);
    }
  }
  return known;
}

}  // namespace

BayesianLearner bayesian_person(const ParameterValues& values, std::span<const double> traits,
                                const LearnerStart& start, const RandomStream& random) {
  const FilterOptions filter{.particles = num_particles(values),
                             .process_noise = values.real("process_noise"),
                             .records_support = start.records_support};
  const auto person = person_of(values, traits);
  ParticleBelief belief{start.cover(filter.particles), filter};
  if (values.real("known") > 0.0 && start.components) {
    const double ability = std::min(scaled_ability(person.ability_max, person.ability_scale), kSurest);
    belief.observe(known_by_chance(values.real("known"), start.components(), random.split("known")),
                   HalfSpaceLikelihood{ability, start.likelihood, belief.dimension()}, random.split("knows"));
  }
  return BayesianLearner{std::move(belief), person, start.likelihood, random};
}

namespace {

std::unique_ptr<Learner> make_bayesian(const ParameterValues& values, std::span<const double> traits,
                                       const LearnerStart& start, RandomStream random) {
  return std::make_unique<BayesianLearner>(bayesian_person(values, traits, start, random));
}

std::string describe_bayesian(const ParameterValues& values, std::span<const double> traits) {
  std::array<char, 200> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "ability %.4f, gains %.4f confirmed and %.4f corrected",
                                  traits[0], traits[1], traits[2]));
  return std::string{text.data()} + ", at most " + to_string(values.real("ability_max")) + ", log-odds x " +
         to_string(values.real("ability_scale"));
}

std::vector<Parameter> bayesian_parameters() {
  const Spread confirm{.half_normal = 0.033, .value = {}};
  const Spread correct{.half_normal = 0.056, .value = {}};
  return {
      {.name = "ability.mean",
       .default_value = 0.703,
       .description = "mean of the initial ability (beta_0), the probability mass that a constraint is believed with",
       .is_required = true,
       .source = "jayaraman2024"},
      {.name = "ability.sd",
       .default_value = 0.034,
       .description = "standard deviation of the initial ability",
       .is_required = true,
       .source = "jayaraman2024"},
      {.name = "ability.min",
       .default_value = 0.6,
       .description = "initial abilities that are not above this are redrawn",
       .min = 0.5,
       .max_is_open = true,
       .source = "jayaraman2024"},
      {.name = "ability_max",
       .default_value = 0.95,
       .description = "cap of the ability at all times; 1 is taken as 1 - 1e-9",
       .min = 0.5,
       .min_is_open = true,
       .source = "jayaraman2024"},
      {.name = "confirm_gain",
       .default_value = confirm,
       .description = "gain of ability after a period with all answers right",
       .is_required = true,
       .source = "jayaraman2024"},
      {.name = "correct_gain",
       .default_value = correct,
       .description = "gain of ability after a period with a wrong answer",
       .is_required = true,
       .source = "jayaraman2024"},
      {.name = "gain_max",
       .default_value = 0.08,
       .description = "gains of this size or more are redrawn",
       .max = 0.5,
       .min_is_open = true,
       .source = "jayaraman2024"},
      {.name = "ordered_gains",
       .default_value = true,
       .description = "whether gains are redrawn unless confirm_gain < correct_gain",
       .source = "jayaraman2024"},
      {.name = "ability_scale",
       .default_value = 1.0,
       .description = "factor on the log-odds of the ability whenever something is learned",
       .max = 5.0,
       .min_is_open = true},
      {.name = "capacity",
       .default_value = std::int64_t{0},
       .description = "different constraints that a person takes in per period; 0: all",
       .max = 1000.0},
      {.name = "beyond_capacity",
       .default_value = 0.0,
       .description = "probability that a constraint beyond the capacity is taken in all the same"},
      {.name = "forgetting",
       .default_value = 0.0,
       .description = "angle in radians by which a belief is blurred between two periods",
       .max = 3.0},
      {.name = "known",
       .default_value = 0.0,
       .description =
           "probability with which a person knows each knowledge component but the last beforehand, with ability_max"},
      particles_parameter(),
      process_noise_parameter(),
  };
}

constexpr std::array kBayesianTraits{
    LearnerTrait{"ability", "Ability at the start of every knowledge component."},
    LearnerTrait{"confirm_gain", "Gain of ability after a period with all answers right."},
    LearnerTrait{"correct_gain", "Gain of ability after a period with a wrong answer."},
};

}  // namespace

const LearnerModel& bayesian_model() {
  static const std::vector<Parameter> kParameters = bayesian_parameters();
  static const LearnerModel kModel{
      .kind = "bayesian",
      .description =
          "a particle belief about the robot's weights, updated with an ability that grows with feedback; all answers "
          "of a period come from one weight drawn from it",
      .parameters = kParameters,
      .traits = kBayesianTraits,
      .has_ability = true,
      .check = check_bayesian,
      .draw = draw_bayesian,
      .make = make_bayesian,
      .describe = describe_bayesian};
  return kModel;
}

}  // namespace kith
