#pragma once

#include <span>

#include "binding.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/past_periods.hpp"

/// What happens in a session as the tuples of kith/_records.py: values that stay what they are.
namespace kith::python {

[[nodiscard]] py::object to_python(const Atlas& atlas, const Lesson& lesson);
[[nodiscard]] py::object to_python(const Atlas& atlas, const Feedback& feedback);
[[nodiscard]] py::object to_python(const Atlas& atlas, const PastPeriod& period);

/// The unit of these demonstrations, in this order.
/// @param belief  what they convey is what they tell people who hold it; null: what the robot's paths show.
[[nodiscard]] Unit picked_unit(TeachingCache& cache, std::span<const HalfSpace> taught_region,
                               std::span<const StartIndex> demos, const ParticleBelief* belief,
                               const SelectionOptions& options, const RandomStream& random);

}  // namespace kith::python
