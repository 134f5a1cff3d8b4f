#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// One run of the robot's policy, with outcomes as they fell.
struct PolicyRun {
  Trajectory path;
  IntegerVector times;     ///< In how many steps each feature was other than 0; shape [d], no discount.
  bool has_ended = false;  ///< In a terminal state; otherwise Domain::max_steps() ended it.
};

/// Draws runs of the robot's policy from a start. Nothing if no outcome that can follow is left to chance. Runs that
/// meet a state which inferred weights do not explain (InferredWeights) are drawn again.
/// @param n  how many runs; fewer where most draws meet such a state.
[[nodiscard]] std::vector<PolicyRun> several_runs(const Atlas& atlas, StartIndex start, std::size_t n,
                                                  RandomStream& random);

/// Some of the runs that stand for all of them, by their length in steps: the middle one first, then shorter and longer
/// ones in turn. Quantiles 0.5, 0.3, 0.7, 0.1 and 0.9; fewer if there are fewer runs.
[[nodiscard]] std::vector<PolicyRun> typical_runs(std::vector<PolicyRun> runs);

/// How often things happened that chance decides: "in 10 runs: falling into the water in 3, coming home in 7".
/// Things that happened in every run or in none are left out; if nothing is left, "the same path each time".
[[nodiscard]] std::string runs_in_words(const Domain& domain, MdpIndex world, const std::vector<PolicyRun>& runs);

/// A path that some runs have in common.
struct Way {
  std::size_t run = 0;    ///< The first run that took it.
  std::size_t times = 0;  ///< How many runs took it, at least 1.
};

/// The different paths of runs, the most frequent first, then in the order of the runs.
[[nodiscard]] std::vector<Way> different_ways(const std::vector<PolicyRun>& runs);

}  // namespace kith
