#pragma once

#include "kith/analysis/finding.hpp"
#include "run_data.hpp"

namespace kith::detail {

// Three sentences that need no statistics: what was simulated, what teaching together gave, and whether strategies and
// compositions made a difference. One or two where the design has less.
[[nodiscard]] Json plain_summary(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                 const Analysis& analysis);

}  // namespace kith::detail
