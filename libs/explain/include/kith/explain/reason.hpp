#pragma once

#include <string>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// What the robot does, rather than what: "it would rather take 2 more steps than cross rubble", "it will not take 5
/// more steps to stop at the charger"; kAllInAll where more than two things differ, or for more than kMostWords.
///
/// Compares the feature counts of the robot's path with those of another one, in the verbs of the domain's [words];
/// what has none is accepted or chosen. What both paths do counts as "more". Where both paths are worth the same to the
/// robot: "it may as well ... as ...".
/// @param alternative  shape [d].
/// @throws std::invalid_argument unless both have d entries, they differ, and the robot's is worth at least as much.
[[nodiscard]] std::string choice_in_words(const Domain& domain, const IntegerVector& robot,
                                          const IntegerVector& alternative);

/// What is said where a choice weighs too much against each other for a sentence.
constexpr const char* kAllInAll = "all in all, its own path is worth more to it";

/// A choice and, behind a colon, the fact that it shows, if there is one; the fact alone instead of kAllInAll.
[[nodiscard]] std::string explained(const std::string& choice, const std::string& fact);

/// What the robot does, rather than what, because of what: choice_in_words() and told() of the constraint that the
/// comparison conveys, { w : (robot - alternative) . w >= 0 }.
/// @throws std::invalid_argument as choice_in_words().
[[nodiscard]] std::string reason(const Domain& domain, const IntegerVector& robot, const IntegerVector& alternative);

/// What somebody predicts in place of the robot's path, in the same words but of any length: "it would rather cross
/// rubble than take 2 more steps", "it would take 2 more steps for nothing".
/// @throws std::invalid_argument unless both have d entries, they differ, and the robot's is worth at least as much.
[[nodiscard]] std::string prediction_in_words(const Domain& domain, const IntegerVector& predicted,
                                              const IntegerVector& robot);

/// The constraint of a comparison. @throws std::invalid_argument if the counts are the same.
[[nodiscard]] HalfSpace constraint_of(const IntegerVector& robot, const IntegerVector& alternative);

}  // namespace kith
