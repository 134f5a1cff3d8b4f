#pragma once

#include <vector>

#include "kith/teaching/lesson.hpp"
#include "kith/teaching/visited_starts.hpp"

namespace kith {

/// The tests of one unit.
struct TestChoice {
  std::vector<Test> tests;
  std::size_t untested = 0;  ///< Constraints that nothing can test.
};

/// Chooses start states that show whether constraints were understood.
///
/// A start tests c if c is among the one-step constraints of the robot's path
/// and a facet of the robot's cell in the start's coverage set (somebody who
/// differs only in c answers differently). Unvisited starts whose pictures were
/// not shown come first; without any test of c itself, the constraint nearest in angle
/// stands in, among those over the same features if there are any. Starts that test
/// several constraints are taken greedily, then one per constraint; the most
/// complex pictures first, then those least like the unit's demonstrations, then chance.
///
/// @param taught  What is examined, sorted: T, and what else of the component matters.
/// @param visited  chosen ones are added.
[[nodiscard]] TestChoice select_tests(const Atlas& atlas, const KnowledgeComponent& component,
                                      const std::vector<Demonstration>& unit, const std::vector<HalfSpace>& taught,
                                      VisitedStarts& visited, RandomStream random);

}  // namespace kith
