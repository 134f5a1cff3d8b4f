#pragma once

#include <string>
#include <vector>

#include "kith/table/csv_reader.hpp"

namespace kith {

/// What the cells of a column of results are, which decides how they are written.
enum class ResultKind {
  kText,
  kCount,     ///< A whole number.
  kNumber,    ///< Three decimals, or four significant digits if those are fewer.
  kFraction,  ///< Three decimals: proportions, partial eta squared.
  kP,         ///< A p-value: three decimals, "< 0.001" below.
};

struct ResultColumn {
  std::string name;
  ResultKind kind = ResultKind::kNumber;
  std::string field{};  ///< Its name in documents; empty: made from `name`, see field_names().
};

/// A table of results. A missing number is one that cannot be estimated; the finding's notes say why.
struct ResultTable {
  std::string caption;
  std::vector<ResultColumn> columns;
  std::vector<std::vector<TableCell>> rows;
};

/// A cell as people read it; "not estimable" for a missing one.
[[nodiscard]] std::string formatted(const TableCell& cell, ResultKind kind);
/// All cells of a table, as people read them.
[[nodiscard]] std::vector<std::vector<std::string>> formatted_rows(const ResultTable& table);
/// The name of every column in documents, no two alike: its `field`, or its name in lower case with underscores ("p,
/// corrected" is p_corrected, "Hedges' g" is hedges_g). A name that an earlier column has gets a number: mean, mean_2.
[[nodiscard]] std::vector<std::string> field_names(const ResultTable& table);
/// "p = 0.032", "p < 0.001".
[[nodiscard]] std::string p_text(double p);

/// A procedure that an analysis used, as a methods section names it.
struct Method {
  std::string text{};    ///< "two-way analysis of variance (type II sums of squares)"
  std::string source{};  ///< Its key in docs/references.bib; may be empty.
};

/// The answer to one question about a study.
struct Finding {
  std::string id{};  ///< "periods", "knowledge-within-composition", ...
  std::string title{};
  std::string question{};
  std::string model{};                  ///< The formula, or what is compared.
  std::string sentence{};               ///< What was tested, on what, and what it means.
  std::string results{};                ///< The tests as a results section reports them, see results_paragraph().
  std::vector<std::string> warnings{};  ///< Assumptions that do not hold, and what could not be estimated and why.
  std::vector<ResultTable> tables{};
  std::vector<Method> methods{};  ///< Every procedure whose results the tables hold.
};

/// All that was found.
struct Analysis {
  std::string subject;             ///< What was analysed: a folder or a file.
  std::vector<std::string> notes;  ///< What holds for all findings.
  std::vector<Finding> findings{};
  std::vector<std::string> not_analysed{};  ///< What the design does not allow, and why.
};

/// What the design does not allow as one sentence; empty if there is nothing.
[[nodiscard]] std::string not_analysed_text(const Analysis& analysis);

/// The findings as a JSON array, on one line: {"id", "title", "question", "model", "sentence", "results", "warnings",
/// "tables", "methods"} each. A table is {"caption", "columns": [{"field", "name", "kind"}], "rows": [{FIELD: value}]};
/// kinds are "text", "count", "number", "fraction" and "p". Values have all digits; null is what cannot be estimated,
/// and a field that does not apply to a row (the F of residuals) is absent.
[[nodiscard]] std::string findings_json(const Analysis& analysis);

}  // namespace kith
