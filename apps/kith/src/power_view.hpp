#pragma once

#include <span>
#include <string>
#include <vector>

#include "console.hpp"
#include "kith/analysis/study_power.hpp"
#include "kith/explain/json.hpp"

// How `kith power` shows its results.
namespace kith::cli {

/// What the analyses take for granted, in sentences; as text under a heading.
[[nodiscard]] std::vector<std::string> assumptions(const StudySpec& spec, bool paired);
[[nodiscard]] std::string assumptions_text(const StudySpec& spec, bool paired, const Console& console);
/// The same where the simulated people are those of the study, and the analysis may not know.
[[nodiscard]] std::string replication_assumptions(const StudySpec& spec, bool paired, const Console& console);

/// One line per size; the bar is the power, ':' the power wanted.
[[nodiscard]] std::string curve_text(const PowerCurve& curve, const PowerOptions& options, const Console& console);
/// What the effects of one outcome are effects on: means and standard deviations of the cells, and what imposed
/// effects make of the means. @param cells  of each curve.
[[nodiscard]] std::string cells_text(const StudyOutcome& outcome, std::span<const PowerCurve> curves,
                                     std::span<const EffectCells> cells, const Console& console);
[[nodiscard]] Json curve_json(const PowerCurve& curve, const EffectCells& cells);

[[nodiscard]] std::string replication_text(const std::vector<PublishedFinding>& findings, const Replication& result,
                                           const StudySpec& spec, const Console& console);
[[nodiscard]] Json replication_json(const std::vector<PublishedFinding>& findings, const Replication& result);

}  // namespace kith::cli
