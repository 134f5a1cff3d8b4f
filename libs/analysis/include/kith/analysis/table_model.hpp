#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/dataset.hpp"

namespace kith {

/// A model to be tested on any tidy table, which analysis.R does: lme4, emmeans, car and others of R.
struct ModelQuestion {
  std::string formula{};                  ///< As R reads it: "knowledge ~ strategy*composition + (1|team)"
  std::optional<std::string> observed{};  ///< Column of true and false: false for a count that was cut off (censored).
  /// What the response is; unspecified: what the table says, else a number. Counts also get count regressions.
  ColumnKind response_kind = ColumnKind::kUnspecified;
  std::vector<std::string> identifiers{};           ///< Further columns that name who or what a row is about.
  bool independent = false;                         ///< Analyse rows as independent although identifiers repeat.
  std::optional<SmallestEffect> smallest_effect{};  ///< Differences are tested for being smaller than this.
};

/// What tells the groups and the people of a table apart: its identifiers, as its codebook and `others` say, in the
/// form of R, "team" or "team:member". Members and seats are numbered anew in every team and session; in a study's
/// tables without seed addresses, replicates of a composition are the same people.
[[nodiscard]] std::vector<std::string> identifiers_of(const Dataset& data, const std::vector<std::string>& others);

/// The plan that analysis.R reads, as a JSON document.
/// @throws kith::Error (kInvalidInput, E0901) for identifiers that are no columns.
[[nodiscard]] std::string table_plan(const Dataset& data, const ModelQuestion& question,
                                     const AnalysisOptions& options);
/// The table as analysis.R reads it: commas between cells, points in numbers, missing cells NA.
[[nodiscard]] std::string table_csv(const Dataset& data);
/// What kith can say itself, without R: the analysis of variance of one response by one factor, or by several with all
/// their interactions ("y ~ a*b"), in a table of numbers whose rows are independent and whose cells are of one size.
/// Nothing for any other question or table. @throws kith::Error as Dataset does, and kUsage for comparisons of factors
/// that the model does not have.
[[nodiscard]] std::optional<Analysis> analyze_balanced_table(const Dataset& data, const ModelQuestion& question,
                                                             const AnalysisOptions& options);
/// What analysis.R printed.
/// @param subject  what was analysed.
/// @throws kith::Error (kInfeasible, E0904) with R's reason if the model cannot be fitted, or if it is no such
/// document.
[[nodiscard]] Analysis read_table_findings(std::string_view json, const std::string& subject);

}  // namespace kith
