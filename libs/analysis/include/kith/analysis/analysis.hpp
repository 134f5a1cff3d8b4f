#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kith/analysis/anova.hpp"
#include "kith/analysis/contrasts.hpp"
#include "kith/analysis/finding.hpp"
#include "kith/analysis/multiple.hpp"

namespace kith {

struct AnalysisOptions {
  double alpha = 0.05;  ///< In (0, 1): below it a p-value counts as evidence; intervals have level 1 - alpha.
  Correction correction = Correction::kBonferroni;  ///< Of families of tests.
  std::vector<PlannedContrast> contrasts{};         ///< Compared in every model that has their factor.
  std::vector<std::string> by{};  ///< Factors at each level of which the levels of the others are compared as well.
};

/// The analyses of a study of teaching strategies, by the tables in a run folder:
///
///   primary                        the contrasts that the study file marks as primary, corrected among themselves
///                                  [holm1979]; then everything else is exploratory, and a note says so
///   periods, knowledge             strategy x composition without the baseline [jayaraman2024, section V]
///   ...-within-composition         strategy within each composition, corrected for their number
///   ...-beliefs, ...-variation     team beliefs against individual ones: means, and how much teams vary
///   ...-paired                     strategies on the same simulated people, pair by pair
///   demonstrations                 the manipulation check: how much the demonstrations convey, per component
///   ...-baseline                   group strategies against teaching everybody alone
///
/// Teams of the same people are not independent: random intercepts, which is an analysis of variance with error strata
/// since designs are balanced, and paired tests. What a design does not allow is left
/// out, and a note says why.
/// @throws kith::Error kInvalidInput for a damaged table or an unfinished run, kIo if there is none, kInfeasible
/// (E0906) if nothing can be analysed.
[[nodiscard]] Analysis analyze_run(const std::filesystem::path& run_folder, const AnalysisOptions& options);

}  // namespace kith
