#pragma once

#include "kith/learners/people_not_as_assumed.hpp"

namespace kith::testing {

/// One model of each kind that docs/audit.md reports.
[[nodiscard]] inline std::span<const LearnerModel> people_not_as_assumed() {
  constexpr std::size_t kReported = 6;
  return kith::people_not_as_assumed().first(kReported);
}

}  // namespace kith::testing
