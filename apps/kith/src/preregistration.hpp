#pragma once

#include <span>
#include <string>

#include "kith/planning/power.hpp"
#include "kith/study/study_spec.hpp"

namespace kith::cli {

/// A preregistration of a study as Markdown: hypotheses, design, sample size, stopping, exclusions, analyses. The
/// models are those that kith analyze fits, see planned_analyses(); the sample size is that of the study file.
/// @param source  the study as named on the command line.
/// @param curves  of the effects that decide on the sample size, with a point at spec.replicates teams per cell.
[[nodiscard]] std::string preregistration_text(const StudySpec& spec, const std::string& source,
                                               std::span<const PowerCurve> curves, const PowerOptions& options);

}  // namespace kith::cli
