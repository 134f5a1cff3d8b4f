#pragma once

#include "kith/belief/aggregation.hpp"

// One row per rule; each is defined in a file of its own.
namespace kith::detail {

extern const AggregationRule kCommonRule;
extern const AggregationRule kJointRule;

}  // namespace kith::detail
