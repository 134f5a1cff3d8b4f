#pragma once

#include <vector>

#include "kith/live/teaching_task.hpp"

namespace kith {

/// What the teacher would have shown first in place of the first demonstration of a lesson: with that excluded, then
/// with the next one excluded as well, and so on; fewer than `n` if nothing else has gain, and none
/// for a lesson that was chosen for no single belief.
/// @param before  the session that proposed the lesson, as it was then.
[[nodiscard]] std::vector<RunnerUp> runners_up(const Session& before, const Lesson& lesson, TeachingCache& cache,
                                               std::size_t n);

}  // namespace kith
