#pragma once

#include <cstddef>
#include <vector>

#include "kith/bec/behaviours.hpp"

namespace kith {

/// What some people expect the robot to do from a start.
struct ExpectedWay {
  IntegerVector counts;  ///< Of the path, or expected; shape [d], in units of 1 / Domain::count_scale().
  Direction weights;     ///< Of one of them, shape [d]: see Behaviours::trajectory().
  double share = 0.0;    ///< Of those who have an optimum there, in (0, 1].
};

/// What people expect whose weights fill the prior evenly, by feature counts: the most frequent first, then in the
/// order of counts. Of the ways that hardly anybody expects some may be missing. Where behaviours are tabulated,
/// BehaviourTables::coverage_set() has all of them.
/// @param n  about how many people. @throws std::invalid_argument if it is 0.
[[nodiscard]] std::vector<ExpectedWay> expected_ways(Behaviours& behaviours, StartIndex start, std::size_t n = 500);

}  // namespace kith
