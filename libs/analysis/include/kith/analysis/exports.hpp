#pragma once

#include <string>
#include <vector>

#include "kith/analysis/finding.hpp"

namespace kith {

/// What a results section reports of a finding, in the manner of the American Psychological Association: the model and
/// the method, the first of its families of tests that has any, planned contrasts and t tests. Tables play no part. "y
/// ~ g (one-way analysis of variance). The effect of g was significant, F(3, 224) = 10.82, p < .001, partial eta
/// squared = .127, 90 % CI [.059, .187]." Empty if the finding has none of these.
/// @param alpha  of the analysis; intervals of partial eta squared have level 1 - 2 alpha.
[[nodiscard]] std::string results_paragraph(const Finding& finding, double alpha);

/// All findings as LaTeX: a section each with its sentence, results paragraph and tables (booktabs), to be included in
/// a document. Numbers are printed as kith prints them.
[[nodiscard]] std::string latex_text(const Analysis& analysis, double alpha);

struct NamedText {
  std::string name;  ///< A file name without folder.
  std::string text;
};
/// Every table of every finding as CSV with all digits, columns named as in documents (field_names()). Files are called
/// FINDING-NUMBER.csv; the last one, tables.csv, lists them with their captions.
[[nodiscard]] std::vector<NamedText> csv_tables(const Analysis& analysis);

}  // namespace kith
