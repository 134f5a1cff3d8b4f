#pragma once

#include "run_data.hpp"

namespace kith::detail {

using Values = std::vector<double>;
using Quantity = double (*)(const TeamRecord&);

// The values of every cell.
[[nodiscard]] std::vector<Values> by_cell(const ReportDesign& design, const RunData& data, Quantity quantity);

// Mean, low and high (95 %), appended to a row; null where there is no answer.
void add_interval(Json& row, std::span<const double> values);

// Tables of the document that have one value per team and quantity.
[[nodiscard]] Json cells_table(const ReportDesign& design, const RunData& data);
// @param points  how many teams of a cell are listed, at most.
[[nodiscard]] Json teams_table(const RunFiles& run, const ReportDesign& design, const RunData& data,
                               std::size_t points);
[[nodiscard]] Json completion_table(const ReportDesign& design, const RunData& data);
[[nodiscard]] Json area_table(const ReportDesign& design, const RunData& data);
[[nodiscard]] Json periods_by_component_table(const ReportDesign& design, const RunData& data);

}  // namespace kith::detail
