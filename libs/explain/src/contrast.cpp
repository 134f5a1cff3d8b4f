#include "kith/explain/contrast.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "deviation.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/core/assert.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"
#include "kith/mdp/behaviour.hpp"
#include "walk.hpp"

namespace kith {
namespace {

// Weights under which exactly the paths with these feature counts are best.
IntegerVector weights_that_choose(const Atlas& atlas, StartIndex start, const IntegerVector& vertex) {
  const auto vertices = atlas.tables().coverage_set(start);
  if (vertex == atlas.feature_counts(start) || std::find(vertices.begin(), vertices.end(), vertex) == vertices.end()) {
    throw std::invalid_argument{"contrast_with: the vertex is none of the coverage set, or the robot's own"};
  }
  Cone cone = atlas.tables().finite_region(start);
  for (const auto& other : vertices) {
    if (other == vertex) continue;
    const bool has_interior = cone.clip(constraint_of(vertex, other));
    KITH_ASSERT(has_interior);  // a vertex is the unique optimum of some weights
  }
  return cone.interior_direction();
}

Int128 squared_length(const IntegerVector& v) { return dot(v, v); }

}  // namespace

Contrast contrast_with(const Atlas& atlas, StartIndex start, std::size_t from, const IntegerVector& vertex) {
  const auto robot = atlas.trajectory(start);
  if (from >= robot.actions.size()) throw std::invalid_argument{"contrast_with: the path is shorter"};
  const auto world = atlas.id(start).mdp;
  const auto& mdp = atlas.domain().mdp(world);
  const auto here = atlas.index({world, robot.states[from]});
  const auto weights = weights_that_choose(atlas, here, vertex);
  const auto solution = plan_exactly(mdp, weights).solution.value();

  // As long as the robot's actions are as good as any to such a person, they expect them.
  auto t = from;
  while (true) {
    KITH_ASSERT(t < robot.actions.size());  // else the robot's path would have the vertex's counts
    const auto s = robot.states[t];
    const auto step = detail::step_by(mdp, s, robot.actions[t]);
    KITH_ASSERT(step.has_value());
    const auto reward = dot(weights, mdp.integer_features(*step));
    if (reward + solution.values[step->next.value()] != solution.values[s.value()]) break;
    ++t;
  }
  auto rest = canonical_trajectory(mdp, solution.canonical_choice, robot.states[t]);
  return detail::beside(atlas, start, {from, vertex, t, std::move(rest)});
}

std::optional<HalfSpace> conveyed_by(const Domain& domain, const Contrast& contrast) {
  return preference_of_robot(domain, contrast.robot_counts - contrast.alternative_counts);
}

IntegerVector whole_counts(const Domain& domain, const IntegerVector& counts) {
  IntegerVector whole(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    whole[k] = std::llround(static_cast<double>(counts[k]) / static_cast<double>(domain.count_scale()));
  }
  return whole;
}

namespace {

// What the actions of a path that ends count; nothing unless all of it is whole.
std::optional<IntegerVector> counts_along(const Mdp& mdp, const Trajectory& path) {
  IntegerVector counts(mdp.num_features());
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    const auto step = detail::step_by(mdp, path.states[t], path.actions[t]);
    if (!step) return std::nullopt;
    const auto features = mdp.features(*step);
    for (std::size_t k = 0; k < counts.size(); ++k) {
      if (features[k] != std::round(features[k])) return std::nullopt;
      counts[k] += std::llround(features[k]);
    }
  }
  return counts;
}

}  // namespace

std::string choice_between(const Domain& domain, MdpIndex world, const Trajectory& robot, const Trajectory& other) {
  if (robot.repeats_from && other.repeats_from) return kAllInAll;
  if (other.repeats_from) return "it would rather finish than go on for ever";
  if (robot.repeats_from) return "it would rather go on for ever than finish";
  const auto own = counts_along(domain.mdp(world), robot);
  const auto others = counts_along(domain.mdp(world), other);
  if (!own || !others || *own == *others || sign_of_dot(domain.weights().integer, *own - *others) < 0) return kAllInAll;
  return choice_in_words(domain, *own, *others);
}

std::string reason(const Atlas& atlas, const Contrast& contrast, std::span<const HalfSpace> together) {
  const auto& domain = atlas.domain();
  if (domain.is_exact()) return reason(domain, contrast.robot_counts, contrast.alternative_counts);
  const auto conveyed = conveyed_by(domain, contrast);
  if (!conveyed) throw std::invalid_argument{"reason: both paths are worth the same"};
  const auto world = atlas.id(contrast.start).mdp;
  const auto fact = told(domain, *conveyed, together);
  if (is_exact(domain.mdp(world))) {
    return explained(choice_in_words(domain, whole_counts(domain, contrast.robot_counts),
                                     whole_counts(domain, contrast.alternative_counts)),
                     fact);
  }
  if (domain.mdp(world).is_deterministic())
    return explained(choice_between(domain, world, contrast.robot, contrast.alternative), fact);
  const auto difference = contrast.robot_counts - contrast.alternative_counts;
  const auto risk = risk_in_words(domain, world, difference);
  return explained(risk.empty() ? on_average_in_words(domain, difference) : risk, fact);
}

bool is_detour(const Domain& domain, const Contrast& contrast) {
  const auto more = contrast.alternative_counts - contrast.robot_counts;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const bool is_cost = domain.weights().integer[k] < 0;
    if (is_cost ? more[k] < 0 : more[k] > 0) return false;
  }
  return true;
}

namespace {

// With the path of somebody, as the coverage sets know them.
std::optional<Contrast> vertex_for(const Atlas& atlas, StartIndex start, const HalfSpace& constraint) {
  const auto path = atlas.path(start);
  for (std::size_t t = 0; t < path.size(); ++t) {
    const auto& robot = atlas.feature_counts(path[t]);
    std::optional<IntegerVector> nearest;
    for (const auto& vertex : atlas.tables().coverage_set(path[t])) {
      if (vertex == robot || constraint_of(robot, vertex) != constraint) continue;
      if (!nearest || squared_length(robot - vertex) < squared_length(robot - *nearest)) nearest = vertex;
    }
    if (nearest) return contrast_with(atlas, start, t, *nearest);
  }
  return std::nullopt;
}

// With one other action.
std::optional<Contrast> deviation_for(const Atlas& atlas, StartIndex start, const HalfSpace& constraint) {
  const auto path = atlas.path(start);
  for (std::size_t t = 0; t < path.size(); ++t) {
    const auto [world, s] = atlas.id(path[t]);
    const auto choices = atlas.domain().mdp(world).choices(s);
    std::optional<std::size_t> nearest;
    IntegerVector least;
    for (std::size_t c = 0; c < choices.size(); ++c) {
      const auto loss = atlas.feature_counts(path[t]) - atlas.deviation_counts(path[t], c);
      if (preference_of_robot(atlas.domain(), loss) != constraint) continue;
      if (nearest && squared_length(loss) >= squared_length(least)) continue;
      nearest = c;
      least = loss;
    }
    if (nearest) return detail::deviation(atlas, start, t, choices[*nearest].action);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Contrast> contrast_for(const Atlas& atlas, StartIndex start, const HalfSpace& constraint) {
  return atlas.find_tables() ? vertex_for(atlas, start, constraint) : deviation_for(atlas, start, constraint);
}

namespace {

// How long the robot's path from step `from` on is as good as any to somebody with these weights.
std::size_t steps_together(const Mdp& mdp, const Trajectory& robot, std::size_t from, std::span<const double> weights) {
  const auto behaviour = behave(mdp, weights);
  auto t = from;
  while (behaviour && t + 1 < robot.actions.size()) {
    const auto choices = mdp.choices(robot.states[t]);
    const auto own = std::find_if(choices.begin(), choices.end(),
                                  [&](const Choice& choice) { return choice.action == robot.actions[t]; });
    const auto c = static_cast<std::size_t>(own - choices.begin());
    if (!is_optimal(mdp, *behaviour, weights, robot.states[t], c)) break;
    ++t;
  }
  return t;
}

// Beside the path that somebody with the given weights expects from step `from` on.
std::optional<Contrast> contrast_with_person(const Behaviours& behaviours, StartIndex start, std::size_t from,
                                             const Direction& weights, const IntegerVector& answer) {
  const Atlas& atlas = behaviours.atlas();
  const auto world = atlas.id(start).mdp;
  const auto path = atlas.trajectory(start);
  auto t = from;
  if (atlas.domain().is_exact()) {
    t = steps_together(atlas.domain().mdp(world), path, from,
                       {weights.data(), static_cast<std::size_t>(weights.size())});
  }
  auto rest = behaviours.trajectory(atlas.index({world, path.states[t]}), weights);
  if (!rest) return std::nullopt;
  auto result = detail::beside(atlas, start, {from, answer, t, *std::move(rest)});
  // Where chance has a part the likeliest paths may be the same: then it is the state that tells.
  const auto parting = first_difference(result.robot, result.alternative);
  const bool differ = parting && (result.robot.repeats_from || *parting < result.robot.actions.size());
  result.decisive = differ ? *parting : from;
  // Both may go round in a cycle for a while before they part.
  result.robot = written_out(std::move(result.robot), result.decisive + 1);
  result.alternative = written_out(std::move(result.alternative), result.decisive + 1);
  return result;
}

}  // namespace

std::optional<Contrast> contrast_for(Behaviours& behaviours, StartIndex start, const HalfSpace& constraint,
                                     std::span<const PolicyCellIndex> people) {
  const Atlas& atlas = behaviours.atlas();
  if (atlas.find_tables()) return contrast_for(atlas, start, constraint);
  std::size_t from = 0;
  for (const StartIndex here : atlas.path(start)) {
    for (const PolicyCellIndex person : people) {
      const auto answer = behaviours.answer(here, person);
      if (!answer) continue;
      const auto conveyed = preference_of_robot(atlas.domain(), atlas.feature_counts(here) - *answer);
      if (conveyed != constraint) continue;
      if (auto contrast = contrast_with_person(behaviours, start, from, behaviours.weights(person), *answer))
        return contrast;
    }
    ++from;
  }
  return deviation_for(atlas, start, constraint);
}

}  // namespace kith
