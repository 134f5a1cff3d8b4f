#pragma once

#include <algorithm>
#include <optional>

#include "kith/explain/contrast.hpp"

namespace kith::detail {

// How another path leaves the robot's.
struct Departure {
  std::size_t expected_from = 0;  // step of the robot's path at whose state the other one was expected
  IntegerVector counts;           // what it counts from that state on
  std::size_t step = 0;           // at which it leaves, not before that
  Trajectory rest;                // from there on
};

// The robot's path and the other one.
[[nodiscard]] Contrast beside(const Atlas& atlas, StartIndex start, const Departure& other);

// What follows if the robot took another action at one state of its path and then did its best again.
//
// The counts differ by what is expected from that state on; where chance has a part the paths are the likeliest ones.
// Nothing if the state has no such action.
[[nodiscard]] std::optional<Contrast> deviation(const Atlas& atlas, StartIndex start, std::size_t at,
                                                ActionIndex action);

// The best of them for the robot among those that `admits` accepts, at step `first` of its path or at a later one
// before `end`.
template <typename Predicate>
[[nodiscard]] std::optional<Contrast> best_deviation(const Atlas& atlas, StartIndex start, std::size_t first,
                                                     std::size_t end, const Predicate& admits) {
  const auto& weights = atlas.domain().weights().integer;
  const auto path = atlas.trajectory(start);
  const auto& mdp = atlas.domain().mdp(atlas.id(start).mdp);
  std::optional<Contrast> best;
  for (std::size_t t = first; t < std::min(end, path.actions.size()); ++t) {
    for (const Choice& choice : mdp.choices(path.states[t])) {
      if (choice.action == path.actions[t]) continue;
      auto other = deviation(atlas, start, t, choice.action);
      if (!other || !admits(*other)) continue;
      if (!best || dot(weights, other->alternative_counts - other->robot_counts) >
                       dot(weights, best->alternative_counts - best->robot_counts)) {
        best = std::move(other);
      }
    }
  }
  return best;
}

}  // namespace kith::detail
