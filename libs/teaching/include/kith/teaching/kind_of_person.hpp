#pragma once

#include <span>
#include <string>
#include <vector>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/learner_bank.hpp"
#include "kith/teaching/observed_period.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {

/// What kind of learner somebody is, after all that was observed of them: LearnerBank::kinds() of
/// TeachingOptions::kinds.
/// @param cache  changes no result. @param random  moves the points of beliefs.
[[nodiscard]] std::vector<KindProbability> kinds_after(TeachingCache& cache, const TeachingOptions& options,
                                                       std::span<const ObservedPeriod> periods,
                                                       const RandomStream& random);

/// "imitating (97 %)" or "cannot tell yet (imitating 55 %, slipping 30 %)": those with at least 10 %, likeliest first.
[[nodiscard]] std::string kinds_in_words(std::vector<KindProbability> kinds);

}  // namespace kith
