#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kith/analysis/tests.hpp"

namespace kith {

/// Who teams consist of: composition and replicate, for the same people are taught at every setting of a study.
using TeamPeople = std::pair<std::string, std::size_t>;
/// An outcome of teams by who they consist of, finite; teams of the same people count once, with their mean.
using TeamValues = std::map<TeamPeople, std::vector<double>>;
[[nodiscard]] std::vector<double> means_of_people(const TeamValues& values);

/// How much two ways of teaching differ.
struct TeamDifference {
  std::size_t n = 0;                 ///< Pairs, or people of the first.
  std::optional<double> estimate{};  ///< First minus second; missing if one of both has no values.
  Estimable<MeanDifference> test;    ///< Paired t test, or Welch's.
};
/// @param same_people  compare within the people of both; else all of the first with all of the second.
[[nodiscard]] TeamDifference difference_of_teams(const TeamValues& first, const TeamValues& second, bool same_people,
                                                 double confidence = 0.95);

}  // namespace kith
