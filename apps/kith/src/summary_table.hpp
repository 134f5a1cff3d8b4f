#pragma once

#include <string>

#include "console.hpp"
#include "kith/study/summary.hpp"

namespace kith::cli {

/// What came out per cell, and pooled, as a table with notes below.
[[nodiscard]] std::string summary_table(const Study& study, const StudySummary& summary, const Console& console);

}  // namespace kith::cli
