#pragma once

#include "json_table.hpp"
#include "run_data.hpp"

namespace kith::detail {

// Of a study that varies keys, every two factors with at least three levels each, one of them such a key: [{"factors":
// [row, column], "outcomes": [outcome_json()], "table"}]. A row of the table is a
// combination of levels, with means over everything else, and with what each comes to among those that have its level
// of the first factor (column "_standing"): "best", "not clearly worse" (the 95 % interval of the difference, of the
// same people where those can be compared, includes 0), or "".
[[nodiscard]] Json matrices(const RunFiles& run, const RunData& data);

}  // namespace kith::detail
