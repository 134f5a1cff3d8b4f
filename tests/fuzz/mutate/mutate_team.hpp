#pragma once

#include "dice.hpp"
#include "kith/study/records.hpp"

namespace kith::fuzzing {

/// One change of a record: a number, a text, a list. What it is about (the address) stays.
void mutate_team(TeamRecord& record, Dice& dice);
/// Takes some of the lists of another.
void cross_teams(TeamRecord& record, const TeamRecord& other, Dice& dice);

}  // namespace kith::fuzzing
