#pragma once

#include "design.hpp"
#include "json_table.hpp"
#include "run_data.hpp"

namespace kith::detail {

// Mean regret, share right and knowledge of the teams of a series when so many periods were taught, and what that had
// taken: items shown, teacher's and people's minutes. Teams that have ended stay as they are.
[[nodiscard]] Json exam_by_period_table(const ReportDesign& design, const RunData& data);

// What the teams of a cell knew at the end and what that took, and how often the cell is on the efficiency front of its
// composition: no strategy leads to at least as much knowledge with fewer items, or more with as many.
[[nodiscard]] Json efficiency_table(const RunFiles& run, const ReportDesign& design, const RunData& data);

// Forecasts before the first lesson beside what happened, per cell.
[[nodiscard]] Json forecasts_table(const ReportDesign& design, const RunData& data);

// Forecast probabilities of being done after a few more periods, in tenths, beside how often that was so.
[[nodiscard]] Json forecast_calibration_table(const RunData& data);

}  // namespace kith::detail
