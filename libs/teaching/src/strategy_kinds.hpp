#pragma once

#include "kith/teaching/strategy.hpp"

// One row per kind; each is defined in a file of its own.
namespace kith::detail {

extern const StrategyKind kBaselineKind;        // member_strategies.cpp
extern const StrategyKind kIndividualLowKind;   // member_strategies.cpp
extern const StrategyKind kIndividualHighKind;  // member_strategies.cpp
extern const StrategyKind kCommonKind;          // team_strategies.cpp
extern const StrategyKind kJointKind;           // team_strategies.cpp

}  // namespace kith::detail
