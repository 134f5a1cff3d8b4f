#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kith {

/// A model in the notation of Wilkinson and Rogers: "knowledge ~ strategy*composition".
struct Formula {
  std::string response;
  std::vector<std::string> factors;             ///< Names in the order in which they first appear.
  std::vector<std::vector<std::size_t>> terms;  ///< Each an ascending set of indices of `factors`; by order, then as
                                                ///< written: main effects first. No term twice; never empty sets.
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
/// back-quotes. "~ 1" is the mean alone (no terms).
[[nodiscard]] FormulaReading parse_formula(std::string_view text);

/// The formula as text: "knowledge ~ strategy + composition + strategy:composition".
[[nodiscard]] std::string to_string(const Formula& formula);

}  // namespace kith
