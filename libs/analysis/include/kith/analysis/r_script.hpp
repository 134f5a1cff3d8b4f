#pragma once

#include <string>

#include "kith/analysis/analysis.hpp"

namespace kith {

/// An analysis to be repeated and continued in R: three files for one folder.
struct RProject {
  std::string data;      ///< data.csv: the rows and columns that were analysed, numbers with decimal points.
  std::string codebook;  ///< codebook.json: what kind each column is.
  std::string script;    ///< analysis.R
};

/// Writes the analysis of a model of a table as an R script: the same tables in the same order with base R, car,
/// emmeans, lme4 with lmerTest, and survival, then what goes beyond kith as commented calls. The script keeps each of
/// its tables in r-results/, as CSV with the captions, row labels and field names of kith's documents.
///
/// What kith computes by resampling (permutation tests) is left out, as are aligned ranks.
/// @throws as analyze_table() does for formulas and columns.
[[nodiscard]] RProject r_project(const Dataset& data, const ModelQuestion& question, const AnalysisOptions& options);

}  // namespace kith
