#pragma once

#include "run_data.hpp"

namespace kith::detail {

// Tables of the document about people over time. A time is left out unless at least 10 of the people, or 20 % of
// them, were still being taught then.

// @param before  by type: mass of a belief in the policy's class before teaching, which is row 0 of every curve.
[[nodiscard]] Json knowledge_by_period_table(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                             const std::vector<double>& before);
[[nodiscard]] Json correct_by_period_table(const RunFiles& run, const ReportDesign& design, const RunData& data);

}  // namespace kith::detail
