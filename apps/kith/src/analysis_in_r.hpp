#pragma once

#include <optional>

#include "kith/analysis/table_model.hpp"

namespace kith::cli {

/// What has to be installed for models on tables, as a command.
inline constexpr const char* kInstallR =
    "apt install r-base-core r-cran-lme4 r-cran-lmertest r-cran-emmeans r-cran-car r-cran-mass r-cran-ordinal "
    "r-cran-survival r-cran-jsonlite";

/// Runs analysis.R on the table with Rscript; nothing if there is no Rscript.
/// @throws Error kInfeasible with R's reason if it cannot fit the model or lacks a package, kIo if it cannot be run.
[[nodiscard]] std::optional<Analysis> analyze_in_r(const Dataset& data, const ModelQuestion& question,
                                                   const AnalysisOptions& options);

/// The same; without R what kith has of its own, which may be nothing.
[[nodiscard]] std::optional<Analysis> analyze_in_r_or_alone(const Dataset& data, const ModelQuestion& question,
                                                            const AnalysisOptions& options);

}  // namespace kith::cli
