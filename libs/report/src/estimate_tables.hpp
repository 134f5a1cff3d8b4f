#pragma once

#include <optional>

#include "design.hpp"
#include "json_table.hpp"
#include "run_data.hpp"

namespace kith::detail {

// Predicted probabilities that everybody present answers a random test of the component correctly, in tenths, beside
// the true ones after the same periods. Nothing if people have no beliefs to compare with.
[[nodiscard]] std::optional<Json> mastery_calibration_table(const RunData& data);

// Estimates of abilities after each period beside the truth, per series: correlation, coverage of the 80 % intervals,
// and the share of people of whom it is told whether they are proficient. Periods with fewer than 10 people are left
// out.
[[nodiscard]] Json ability_estimates_table(const ReportDesign& design, const RunData& data);

}  // namespace kith::detail
