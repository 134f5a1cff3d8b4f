#include "kith/explain/contrast.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <tuple>

#include "kith/bec/comparison.hpp"
#include "kith/core/assert.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"
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

std::optional<DemoIndex> same_start(const Atlas& atlas, DemoIndex demo, MdpIndex world) {
  const auto& domain = atlas.domain();
  const auto [from, start] = atlas.id(demo);
  const auto before = domain.state(from, start);
  const auto fresh_there = domain.state(world, domain.initial_state(world));
  const auto fresh_here = domain.state(from, domain.initial_state(from));
  const auto has = [](const auto& list, const auto& entry) {
    return std::find(list.begin(), list.end(), entry) != list.end();
  };
  GridState state;
  state.robot = before.robot;
  const auto items_here = domain.items_in(from);
  const auto items_there = domain.items_in(world);
  for (std::size_t i = 0; i < items_there.size(); ++i) {
    const auto place = std::find(items_here.begin(), items_here.end(), items_there[i]);
    const auto j = static_cast<std::size_t>(place - items_here.begin());
    const bool known = place != items_here.end();
    state.items.push_back(known ? before.items[j] : fresh_there.items[i]);
    state.carried.push_back(known && before.carried[j]);
  }
  // A robot that carries something only here would start there with empty hands: another start.
  for (std::size_t j = 0; j < items_here.size(); ++j) {
    if (before.carried[j] && !has(items_there, items_here[j])) return std::nullopt;
  }
  for (const auto& station : fresh_there.stations) {
    if (!has(fresh_here.stations, station) || has(before.stations, station)) state.stations.push_back(station);
  }
  const auto found = domain.find_state(world, state);
  if (!found || domain.mdp(world).is_terminal(*found)) return std::nullopt;
  return atlas.index({world, *found});
}

namespace {

// The robot's path in the other world, if it decides there as the alternative does.
std::optional<Trajectory> flipped_path(const Atlas& atlas, const Contrast& contrast, DemoIndex start) {
  const auto [world, first] = atlas.id(start);
  detail::Walk walk{atlas, world, first};
  for (std::size_t t = 0; t < contrast.decisive; ++t) {
    if (!walk.take_if_best(contrast.robot.actions[t])) return std::nullopt;
  }
  if (walk.is_over() || walk.is_best(contrast.robot.actions[contrast.decisive])) return std::nullopt;
  if (!walk.take_if_best(contrast.alternative.actions[contrast.decisive])) return std::nullopt;
  for (auto t = contrast.decisive + 1; t < contrast.alternative.actions.size(); ++t) {
    if (!walk.take_if_best(contrast.alternative.actions[t])) break;
  }
  return walk.finished();
}

std::string thing_in_words(const Domain& domain, const OptionalGroup& group) {
  constexpr std::size_t kFew = 2;
  const auto& cells = group.cells;
  if (cells.size() > kFew) {
    return "the " + group.name + " from " + cell_text(domain, cells.front()) + " to " + cell_text(domain, cells.back());
  }
  std::vector<std::string> places;
  for (const auto& cell : cells) places.push_back(cell_text(domain, cell));
  return "the " + group.name + " at " + listed(places);
}

// "going up".
std::string doing_instead(const std::string& action) {
  for (const char* move : {"up", "down", "left", "right"}) {
    if (action == move) return "going " + action;
  }
  if (action == "pickup") return "picking it up";
  if (action == "dropoff") return "putting it down";
  if (action == "exit") return "leaving";
  return "'" + action + "'";
}

}  // namespace

std::optional<Flip> nearest_flip(const Atlas& atlas, const Contrast& contrast) {
  const auto& domain = atlas.domain();
  if (!domain.has_map() || !domain.is_exact())
    return std::nullopt;  // without a map nothing says which worlds are alike
  const auto here = atlas.id(contrast.demo).mdp;
  const auto groups = domain.optional_groups();
  struct Candidate {
    std::size_t num_groups, num_cells, world;
    auto operator<=>(const Candidate&) const = default;
  };
  std::vector<Candidate> candidates;
  for (std::size_t m = 0; m < domain.num_mdps(); ++m) {
    if (m == here.value()) continue;
    std::size_t cells = 0;
    const auto toggled = toggled_groups(domain, here, MdpIndex{m});
    for (const auto g : toggled) cells += groups[g].cells.size();
    candidates.push_back({toggled.size(), cells, m});
  }
  std::sort(candidates.begin(), candidates.end());
  for (const auto& candidate : candidates) {
    const MdpIndex world{candidate.world};
    const auto start = same_start(atlas, contrast.demo, world);
    if (!start) continue;
    if (auto path = flipped_path(atlas, contrast, *start)) {
      return Flip{*start, *std::move(path), toggled_groups(domain, here, world)};
    }
  }
  return std::nullopt;
}

std::vector<std::size_t> toggled_groups(const Domain& domain, MdpIndex a, MdpIndex b) {
  const auto here = domain.variant(a);
  const auto there = domain.variant(b);
  std::vector<std::size_t> toggled;
  for (std::size_t g = 0; g < here.size(); ++g) {
    if (here[g] != there[g]) toggled.push_back(g);
  }
  return toggled;
}

std::string difference_in_words(const Domain& domain, MdpIndex world, std::span<const std::size_t> toggled) {
  const auto groups = domain.optional_groups();
  const auto there = domain.variant(world);
  std::vector<std::string> added, removed;
  for (const auto g : toggled) (there[g] ? added : removed).push_back(thing_in_words(domain, groups[g]));
  std::string text;
  if (!added.empty()) text = "with " + listed(added);
  if (!removed.empty()) text += (text.empty() ? "" : " and ") + ("without " + listed(removed));
  return text;
}

std::string flip_in_words(const Atlas& atlas, const Contrast& contrast, const Flip& flip) {
  const auto& domain = atlas.domain();
  const auto [world, start] = atlas.id(flip.demo);
  const auto& names = domain.action_names();
  const auto cell = domain.state(world, flip.robot.states[contrast.decisive]).robot;
  return difference_in_words(domain, world, flip.toggled) + " it " +
         action_words(names[flip.robot.actions[contrast.decisive].value()]) + " at " + cell_text(domain, cell) +
         " rather than " + doing_instead(names[contrast.robot.actions[contrast.decisive].value()]);
}

}  // namespace kith
