#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "run_data.hpp"

namespace kith::detail {

// What single teams were shown and asked, and how they answered: {"domain", "features", "boards", "sentences", "teams"}
// (docs/json.md). The telling teams first, then by replicate, as many as a page can hold. Nothing if only teams were
// recorded.
[[nodiscard]] std::optional<Json> team_lessons(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                               const Atlas& atlas, std::vector<std::string>& notes);

}  // namespace kith::detail
