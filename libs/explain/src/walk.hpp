#pragma once

#include <optional>

#include "kith/bec/atlas.hpp"

namespace kith::detail {

// Where an action leads, if the state has it. Only for deterministic MDPs.
[[nodiscard]] std::optional<Outcome> step_by(const Mdp& mdp, StateIndex s, ActionIndex action);

// What the robot's best path from a state is worth; 0 at the end.
[[nodiscard]] Int128 value_of(const Atlas& atlas, MdpIndex world, StateIndex s);

// A robot on its way through one world, which takes best actions only. Exact; ties count as best.
class Walk {
 public:
  Walk(const Atlas& atlas, MdpIndex world, StateIndex start) : atlas_{atlas}, world_{world}, path_{{start}, {}} {}

  [[nodiscard]] bool is_over() const;
  [[nodiscard]] bool is_best(ActionIndex action) const;
  // Takes the action and says true, or leaves all as it is.
  bool take_if_best(ActionIndex action);
  // The path so far and the robot's own rest of it.
  [[nodiscard]] Trajectory finished() const;

 private:
  const Atlas& atlas_;
  MdpIndex world_;
  Trajectory path_;
};

}  // namespace kith::detail
