#pragma once

#include "console.hpp"
#include "kith/study/summary.hpp"

namespace kith::cli {

/// Prints the document kith.study/1: what came out per cell, and pooled.
/// @param failed  the teams that are missing, described.
void print_summary(const Study& study, const StudySummary& summary, std::size_t teams,
                   const std::vector<std::string>& failed, double seconds, Console& console);

}  // namespace kith::cli
