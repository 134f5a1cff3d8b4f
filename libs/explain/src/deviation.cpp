#include "deviation.hpp"

#include <utility>

namespace kith::detail {
namespace {

// Appends the rest of a path.
void append(Trajectory& path, const Trajectory& rest) {
  if (rest.repeats_from) path.repeats_from = path.actions.size() + *rest.repeats_from;
  path.states.insert(path.states.end(), rest.states.begin() + 1, rest.states.end());
  path.actions.insert(path.actions.end(), rest.actions.begin(), rest.actions.end());
}

Trajectory first_steps(const Trajectory& path, std::size_t n) {
  const auto steps = static_cast<std::ptrdiff_t>(n);
  return {{path.states.begin(), path.states.begin() + steps + 1}, {path.actions.begin(), path.actions.begin() + steps}};
}

}  // namespace

Contrast beside(const Atlas& atlas, StartIndex start, const Departure& other) {
  Contrast result;
  result.start = start;
  result.robot = atlas.trajectory(start);
  result.robot_counts = atlas.feature_counts(start);
  result.decisive = other.step;
  result.alternative = first_steps(result.robot, other.step);
  append(result.alternative, other.rest);
  const auto there = atlas.index({atlas.id(start).mdp, result.robot.states.at(other.expected_from)});
  result.alternative_counts = result.robot_counts - atlas.feature_counts(there) + other.counts;
  return result;
}

std::optional<Contrast> deviation(const Atlas& atlas, StartIndex start, std::size_t at, ActionIndex action) {
  const auto world = atlas.id(start).mdp;
  const auto& mdp = atlas.domain().mdp(world);
  const auto s = atlas.trajectory(start).states.at(at);
  const auto choices = mdp.choices(s);
  const auto choice = std::ranges::find(choices, action, &Choice::action);
  if (choice == choices.end()) return std::nullopt;

  const auto next = std::ranges::max(mdp.outcomes(*choice), {}, &Outcome::probability).next;
  Trajectory rest{{s, next}, {action}};
  if (!mdp.is_terminal(next)) append(rest, atlas.trajectory(atlas.index({world, next})));
  auto counts = atlas.deviation_counts(atlas.index({world, s}), static_cast<std::size_t>(choice - choices.begin()));
  return beside(atlas, start, {at, counts, at, std::move(rest)});
}

}  // namespace kith::detail
