#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "imagined_people.hpp"
#include "kith/teaching/strategy.hpp"
#include "lesson_loss.hpp"

namespace kith {

struct LessonLimits {
  std::size_t demonstrations = 3;  // >= 1
  std::size_t tests = 3;           // >= 1
  std::size_t capacity = 0;        // different constraints of a lesson that members take in; 0: all
};

// The lesson that lowers the loss most per item: with the demonstrations D and the tests T the one with the largest
//
//   (loss(nothing) - loss(D, F(T))) / (|D| + |T|),
//
// F(T) being those of the constraints taught so far that the tests examine. Demonstrations are added, and tests to
// each, as long as this grows; there is always one of each. A demonstration conveys what one of the groups of imagined
// people did not expect. Starts that nobody has met are taken while there are any that help.
// @return without demonstrations if none conveys anything; without tests if nothing taught can be examined.
[[nodiscard]] UnitProposal best_lesson(TeachingCache& cache, const TeachingView& view, LessonLoss& loss,
                                       std::span<const ImaginedPeople> groups, const LessonLimits& limits,
                                       RandomStream random);

}  // namespace kith
