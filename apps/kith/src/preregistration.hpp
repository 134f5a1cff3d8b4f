#pragma once

#include <span>
#include <string>

#include "kith/analysis/study_power.hpp"
#include "kith/domains/domain.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/study_spec.hpp"

namespace kith::cli {

/// What is planned.
struct PlannedStudy {
  const StudySpec& spec;
  const Domain& domain;
  RunInputs inputs;     ///< As kith study freezes them.
  std::string source;   ///< The study as named on the command line.
  std::string written;  ///< When: UTC, "2026-01-31T12:00:00Z".
  std::string results;  ///< The folder in which a run of it is looked for.
  std::string missing;  ///< What no power was estimated for, as a sentence; empty: nothing.
};

/// A preregistration of a study as Markdown: hypotheses, design, sample size, stopping, exclusions, analyses, and what
/// proves that this was planned: digests of the inputs. The hypotheses are the primary contrasts of the study file if
/// it has any. The models are those that kith analyze fits, see planned_analyses(); the sample size is that of the
/// file.
/// @param curves  of the effects that decide on the sample size, with a point at spec.replicates teams per cell.
/// @param cells  of the same effects.
[[nodiscard]] std::string preregistration_text(const PlannedStudy& planned, std::span<const PowerCurve> curves,
                                               std::span<const EffectCells> cells, const PowerOptions& options);

}  // namespace kith::cli
