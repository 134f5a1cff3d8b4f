#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kith {

/// A model in the notation of Wilkinson and Rogers, with random intercepts as in lme4:
/// "knowledge ~ strategy*composition + (1|team)".
struct Formula {
  std::string response;
  std::vector<std::string> factors;             ///< Names in the order in which they first appear.
  std::vector<std::vector<std::size_t>> terms;  ///< Each an ascending set of indices of `factors`; by order, then as
                                                ///< written: main effects first. No term twice; never empty sets.
  /// The groups of each random intercept: the columns whose combinations of values they are, as written. (1|team) is
  /// {"team"}, (1|team:member) is {"team", "member"}, and (1|team/member) stands for both. No set of columns twice,
  /// none that is a term as well. Whoever uses a formula fits a mixed model or rejects it if there are any.
  std::vector<std::vector<std::string>> random_intercepts;
};

/// What is wrong with a formula, and where.
struct FormulaError {
  std::string message;
  std::size_t column = 1;  ///< 1-based, in the text.
  std::string hint;
};
struct FormulaReading {
  Formula formula;
  std::vector<FormulaError> errors;  ///< Empty iff the formula is good.
};

/// Reads RESPONSE ~ TERMS with the operators + (both), * (both and their
/// interaction), : (interaction) and parentheses; names are letters, digits, '_' and '.', or anything in
/// back-quotes. "~ 1" is the mean alone (no terms). Random intercepts, (1|a), (1|a:b) or (1|a/b), are added to the
/// terms by +; random slopes, (x|a), are an error.
[[nodiscard]] FormulaReading parse_formula(std::string_view text);

/// The formula as text: "knowledge ~ strategy + composition + strategy:composition",
/// then its random intercepts, each in parentheses.
[[nodiscard]] std::string to_string(const Formula& formula);

}  // namespace kith
