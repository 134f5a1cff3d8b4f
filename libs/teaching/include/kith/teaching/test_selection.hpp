#pragma once

#include <vector>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/visited_starts.hpp"

namespace kith {

/// The tests of one unit.
struct TestChoice {
  std::vector<Test> tests;
  std::size_t untested = 0;  ///< Constraints that nothing can test.
};

/// What else decides between starts that test the same.
struct TestPreferences {
  TeachingCache& cache;               ///< Of the atlas; changes no result.
  const VisitedStarts& demonstrated;  ///< In this lesson or before.
  bool avoids_shortest = false;       ///< Those come first that people who only take the shortest path get wrong.
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
/// With preferences, of the starts whose pictures were shown those come first that nobody met, then those that were
/// tests, last demonstrations. TestPreferences::avoids_shortest decides before looks do.
///
/// @param taught  What is examined, sorted: T, and what else of the component matters.
/// @param visited  chosen ones are added.
/// @param preferences  null: what was shown comes again in any order, and shortest paths do not matter.
[[nodiscard]] TestChoice select_tests(const Atlas& atlas, const KnowledgeComponent& component,
                                      const std::vector<Demonstration>& unit, const std::vector<HalfSpace>& taught,
                                      VisitedStarts& visited, RandomStream random,
                                      const TestPreferences* preferences = nullptr);

}  // namespace kith
