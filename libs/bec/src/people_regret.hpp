#pragma once

#include <memory>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/bec/behaviours.hpp"

namespace kith {

// How much people lose against the robot, on a sample of the starts: what not knowing something costs.
class PeopleRegret {
 public:
  // How many worlds are sampled at most, and how many starts of each.
  struct Sample {
    std::size_t mdps = 12;
    std::size_t starts_per_mdp = 24;
  };

  // @pre the store's atlas knows its demonstrations; it need not know more. Behaviours are planned on demand.
  PeopleRegret(std::shared_ptr<PartitionStore> store, const Sample& sample);

  // Mean over the starts, in units of the normalised weights. Where somebody has no optimum, it is that of the worst
  // single deviation from the robot's path.
  [[nodiscard]] double of(const Direction& weights);

  // A start where somebody takes a worse path than the robot.
  struct Mistake {
    StartIndex start;
    double regret = 0.0;      // divided by the number of starts, so that those of one person add up to of(), or to less
    IntegerVector advantage;  // what the robot's path counts more than theirs, in units of 1 / Domain::count_scale()
  };
  // Those with an optimum; in the order of the starts.
  [[nodiscard]] std::vector<Mistake> mistakes(const Direction& weights);

 private:
  struct Start {
    StartIndex index;
    double worst = 0.0;  // of a single deviation
  };

  const Atlas* atlas_;
  Behaviours behaviours_;
  std::vector<Start> starts_;
};

}  // namespace kith
