#include "kith/explain/contrast.hpp"

#include <algorithm>
#include <stdexcept>

#include "kith/bec/comparison.hpp"
#include "kith/core/assert.hpp"
#include "kith/explain/reason.hpp"
#include "kith/mdp/behaviour.hpp"
#include "walk.hpp"

namespace kith {
namespace {

// Weights under which exactly the paths with these feature counts are best.
IntegerVector weights_that_choose(const Atlas& atlas, DemoIndex demo, const IntegerVector& vertex) {
  const auto vertices = atlas.coverage_set(demo);
  if (vertex == atlas.feature_counts(demo) || std::find(vertices.begin(), vertices.end(), vertex) == vertices.end()) {
    throw std::invalid_argument{"contrast_with: the vertex is none of the coverage set, or the robot's own"};
  }
  Cone cone = atlas.finite_region(demo);
  for (const auto& other : vertices) {
    if (other == vertex) continue;
    const bool has_interior = cone.clip(constraint_of(vertex, other));
    KITH_ASSERT(has_interior);  // a vertex is the unique optimum of some weights
  }
  return cone.interior_direction();
}

// Appends the rest of a path.
void append(Trajectory& path, const Trajectory& rest) {
  path.states.insert(path.states.end(), rest.states.begin() + 1, rest.states.end());
  path.actions.insert(path.actions.end(), rest.actions.begin(), rest.actions.end());
}

Trajectory first_steps(const Trajectory& path, std::size_t n) {
  const auto steps = static_cast<std::ptrdiff_t>(n);
  return {{path.states.begin(), path.states.begin() + steps + 1}, {path.actions.begin(), path.actions.begin() + steps}};
}

}  // namespace

Contrast contrast_with(const Atlas& atlas, DemoIndex demo, std::size_t from, const IntegerVector& vertex) {
  Contrast result;
  result.demo = demo;
  result.robot = atlas.trajectory(demo);
  result.robot_counts = atlas.feature_counts(demo);
  if (from >= result.robot.actions.size()) throw std::invalid_argument{"contrast_with: the path is shorter"};
  const auto world = atlas.id(demo).mdp;
  const auto& mdp = atlas.domain().mdp(world);
  const auto here = atlas.index({world, result.robot.states[from]});
  const auto weights = weights_that_choose(atlas, here, vertex);
  const auto solution = plan_exactly(mdp, weights).solution.value();

  // As long as the robot's actions are as good as any to such a person, they expect them.
  auto t = from;
  while (true) {
    KITH_ASSERT(t < result.robot.actions.size());  // else the robot's path would have the vertex's counts
    const auto s = result.robot.states[t];
    const auto step = detail::step_by(mdp, s, result.robot.actions[t]);
    KITH_ASSERT(step.has_value());
    const auto reward = dot(weights, mdp.integer_features(*step));
    if (reward + solution.values[step->next.value()] != solution.values[s.value()]) break;
    ++t;
  }
  result.decisive = t;
  result.alternative = first_steps(result.robot, t);
  append(result.alternative, canonical_trajectory(mdp, solution.canonical_choice, result.robot.states[t]));
  result.alternative_counts = result.robot_counts - atlas.feature_counts(here) + vertex;
  return result;
}

std::optional<Contrast> contrast_for(const Atlas& atlas, DemoIndex demo, const HalfSpace& constraint) {
  const auto path = atlas.trajectory(demo);
  const auto world = atlas.id(demo).mdp;
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    const auto here = atlas.index({world, path.states[t]});
    const auto& robot = atlas.feature_counts(here);
    std::optional<IntegerVector> nearest;
    const auto size = [&](const IntegerVector& v) { return dot(robot - v, robot - v); };
    for (const auto& vertex : atlas.coverage_set(here)) {
      if (vertex == robot || constraint_of(robot, vertex) != constraint) continue;
      if (!nearest || size(vertex) < size(*nearest)) nearest = vertex;
    }
    if (nearest) return contrast_with(atlas, demo, t, *nearest);
  }
  return std::nullopt;
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
std::optional<Contrast> contrast_with_person(const Behaviours& behaviours, DemoIndex demo, std::size_t from,
                                             const Direction& weights, const IntegerVector& answer) {
  const Atlas& atlas = behaviours.atlas();
  const auto world = atlas.id(demo).mdp;
  Contrast result;
  result.demo = demo;
  result.robot = atlas.trajectory(demo);
  result.robot_counts = atlas.feature_counts(demo);
  const auto here = atlas.index({world, result.robot.states[from]});
  auto t = from;
  if (atlas.domain().is_exact()) {
    t = steps_together(atlas.domain().mdp(world), result.robot, from,
                       {weights.data(), static_cast<std::size_t>(weights.size())});
  }
  const auto rest = behaviours.trajectory(atlas.index({world, result.robot.states[t]}), weights);
  if (!rest) return std::nullopt;
  result.alternative = first_steps(result.robot, t);
  append(result.alternative, *rest);
  result.alternative_counts = result.robot_counts - atlas.feature_counts(here) + answer;
  const auto [robot, other] = std::mismatch(result.robot.actions.begin(), result.robot.actions.end(),
                                            result.alternative.actions.begin(), result.alternative.actions.end());
  // Where chance has a part the likeliest paths may be the same: then it is the state that tells.
  const bool differ = robot != result.robot.actions.end();
  result.decisive = differ ? static_cast<std::size_t>(robot - result.robot.actions.begin()) : from;
  return result;
}

}  // namespace

std::optional<Contrast> contrast_for(Behaviours& behaviours, DemoIndex demo, const HalfSpace& constraint,
                                     std::span<const PolicyCellIndex> people) {
  const Atlas& atlas = behaviours.atlas();
  if (atlas.is_tabulated()) return contrast_for(atlas, demo, constraint);
  std::size_t from = 0;
  for (const DemoIndex here : atlas.path(demo)) {
    for (const PolicyCellIndex person : people) {
      const auto answer = behaviours.answer(here, person);
      if (!answer) continue;
      const auto conveyed = preference_of_robot(atlas.domain(), atlas.feature_counts(here) - *answer);
      if (conveyed != constraint) continue;
      if (auto contrast = contrast_with_person(behaviours, demo, from, behaviours.weights(person), *answer))
        return contrast;
    }
    ++from;
  }
  return std::nullopt;
}

}  // namespace kith
