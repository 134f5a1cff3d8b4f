#pragma once

#include <span>
#include <vector>

#include "imagined_people.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/unit_value.hpp"

namespace kith {

struct PlanOptions {
  std::size_t max_demonstrations = 2;  // >= 1, but 0 in parameters: Lookahead::plan_for() decides
  double min_gain = 0.0;               // of U, for every demonstration but the first
  std::size_t capacity = 0;            // different constraints of a lesson that members take in; 0: all
};

// Greedy: the demonstration of the component with the largest U beside those chosen before, again and again. What was
// not met yet is preferred; among equals the simplest picture. Without demonstrations if none conveys anything.
[[nodiscard]] Unit plan_unit(TeachingCache& cache, const TeachingView& view, UnitValue& value,
                             const ImaginedPeople& people, const PlanOptions& options, RandomStream random);

// The unit of these demonstrations, with what they convey to the imagined people; those that convey nothing are left
// out.
[[nodiscard]] Unit unit_of(TeachingCache& cache, const TeachingView& view, std::span<const StartIndex> demonstrations,
                           const ImaginedPeople& people);

// U of a unit that a strategy chose.
[[nodiscard]] double value_of(TeachingCache& cache, UnitValue& value, const Unit& unit, std::size_t capacity = 0);

}  // namespace kith
