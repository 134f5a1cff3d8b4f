#pragma once

#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study/records.hpp"
#include "kith/teaching/observed_period.hpp"

namespace kith {

/// What every member of a team saw, answered and heard, from the team's record: nothing of what only a simulation
/// knows.
/// @param atlas  of the study's domain.
/// @return per member, in the order of the composition; without periods at RecordLevel::kTeam.
/// @throws std::invalid_argument if the record names a start or a component that the domain does not have.
[[nodiscard]] std::vector<std::vector<ObservedPeriod>> observed_people(const Atlas& atlas, const TeamRecord& record);

}  // namespace kith
