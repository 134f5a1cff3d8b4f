#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "console.hpp"
#include "kith/explain/json.hpp"
#include "kith/study/summary.hpp"

namespace kith::cli {

/// What came out per cell, and pooled, as a table with notes below. For domains of more than three features the figures
/// of the exam stand in the place of knowledge, which says little there.
[[nodiscard]] std::string summary_table(const Study& study, std::size_t num_features, const StudySummary& summary,
                                        const Console& console);

/// The same as the document kith.study/1. @param failed  the teams that are missing, described.
[[nodiscard]] Json summary_json(const Study& study, const StudySummary& summary, std::size_t teams,
                                const std::vector<std::string>& failed, double seconds);

}  // namespace kith::cli
