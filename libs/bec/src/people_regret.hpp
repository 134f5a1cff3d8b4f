#pragma once

#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/bec/behaviours.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

// How much people lose against the robot, on a sample of the starts: what not knowing something costs.
class PeopleRegret {
 public:
  // @pre the atlas knows its demonstrations; it need not know more. Behaviours are planned on demand.
  explicit PeopleRegret(const Atlas& atlas);

  // Mean over the starts, in units of the normalised weights. Where somebody has no optimum, it is that of the worst
  // single deviation from the robot's path.
  [[nodiscard]] double of(const Direction& weights);

 private:
  struct Start {
    DemoIndex demo;
    double worst = 0.0;  // of a single deviation
  };

  const Atlas* atlas_;
  Behaviours behaviours_;
  std::vector<Start> starts_;
};

}  // namespace kith
