#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kith/files/csv_reader.hpp"

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

/// The test of one term of a model, or of one part of the data. Missing numbers cannot be estimated.
struct TermResult {
  std::string subject{};                ///< The term, "strategy:composition", or the part, "PPP".
  std::size_t df = 0;                   ///< Degrees of freedom of the term.
  std::optional<double> residual_df{};  ///< May be infinite; missing for chi-squared.
  std::optional<double> statistic{};
  std::optional<double> p{};
  std::optional<double> corrected_p{};  ///< For the family, if it is corrected.
  std::optional<double> effect{};       ///< Partial eta squared, and its interval of level 1 - 2 alpha.
  std::optional<double> low{};
  std::optional<double> high{};
  std::optional<double> sum_of_squares{};
  std::optional<double> rank_p{};  ///< Of a test that does not assume normal residuals.
};

/// Tests that belong together: of all terms of a model, of all parts of the data.
struct TestFamily {
  enum class Statistic { kF, kChiSquared };
  /// How degrees of freedom of residuals are written.
  enum class Residuals { kWhole, kOneDecimal, kFourDigits };
  Statistic statistic = Statistic::kF;
  Residuals residuals = Residuals::kWhole;
  bool are_terms = true;  ///< Whether subjects are terms of the finding's model.
  std::vector<TermResult> tests{};
};

/// What was compared, by how much it differs, and how sure that is. Missing numbers cannot be estimated, or were not
/// asked for.
struct ComparisonResult {
  std::string name{};                ///< "joint - common", or the name of a planned contrast.
  std::string response{};            ///< A column; empty: that of the finding.
  std::string at{};                  ///< The level of ComparisonFamily::by.
  std::size_t n = 0;                 ///< Pairs of values; 0 where they are not paired.
  std::optional<double> estimate{};  ///< First minus second; and its interval of level 1 - alpha.
  std::optional<double> low{};
  std::optional<double> high{};
  std::optional<double> d{};  ///< Standardised, with its interval.
  std::optional<double> d_low{};
  std::optional<double> d_high{};
  std::optional<double> t{};
  std::optional<double> df{};  ///< Missing if infinite.
  std::optional<double> p{};   ///< Adjusted if ComparisonFamily::is_adjusted.
  std::optional<double> corrected_p{};
};

/// Comparisons that belong together.
struct ComparisonFamily {
  enum class Kind {
    kPrimary,     ///< The hypotheses of the study.
    kPlanned,     ///< Contrasts planned beforehand, of the levels of `factor`.
    kPairs,       ///< All pairs of levels of `factor`.
    kSamePeople,  ///< All pairs of strategies, on the same people.
    kAlone,       ///< Teams taught together and people taught one after the other.
  };
  Kind kind = Kind::kPairs;
  std::string factor{};
  std::string by{};          ///< The factor at each level of which is compared; may be empty.
  bool is_adjusted = false;  ///< Whether p-values and intervals allow for the number of comparisons.
  std::vector<ComparisonResult> comparisons{};
};

/// The estimated marginal mean of a level of a factor, and its interval of level 1 - alpha.
struct MeanResult {
  std::string level{};
  std::optional<double> mean{};
  std::optional<double> low{};
  std::optional<double> high{};
  std::size_t n = 0;
};
struct MeanFamily {
  std::string factor{};
  std::vector<MeanResult> means{};
};

/// The answer to one question about a study.
struct Finding {
  std::string id{};        ///< "periods", "knowledge-within-composition", ...
  std::string topic{};     ///< "Effects of strategy and composition"; findings about several responses share it.
  std::string response{};  ///< In words; empty if the topic says it.
  std::string question{};
  std::string model{};                  ///< The formula, or what is compared.
  std::string sentence{};               ///< What was tested, on what, and what it means.
  std::string results{};                ///< The tests as a results section reports them, see results_paragraph().
  std::vector<std::string> warnings{};  ///< Assumptions that do not hold, and what could not be estimated and why.
  std::vector<TestFamily> tests{};      ///< Those that it rests on first.
  std::vector<ComparisonFamily> comparisons{};
  std::vector<MeanFamily> means{};
  std::vector<ResultTable> tables{};  ///< What people read; made from what is above, and never read back.
  std::vector<Method> methods{};      ///< Every procedure whose results the tables hold.

  /// "Effects of strategy and composition: periods"
  [[nodiscard]] std::string title() const { return response.empty() ? topic : topic + ": " + response; }
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
