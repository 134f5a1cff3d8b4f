#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kith {

enum class Severity { kError, kWarning };

/// One thing that is wrong with a file that a person wrote: what, where, and
/// how to mend it. Lines and columns are 1-based; 0 means "the file as a whole".
struct Diagnostic {
  Severity severity = Severity::kError;
  std::string id{};       ///< Stable name, such as "E0312"; documented in docs/errors.md.
  std::string message{};  ///< One sentence, lower case, no full stop.
  std::string file{};     ///< As the user named it.
  std::size_t line = 0;
  std::size_t column = 0;
  std::size_t length = 1;     ///< Characters to underline, at least 1.
  std::string hint{};         ///< The mend; may be empty.
  std::string source_line{};  ///< The text of `line`, for display; may be empty.
  bool infeasible = false;    ///< Well-formed, but nothing can be done with it (exit 4 rather than 3).

  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

/// Whether any of them is an error rather than a warning.
[[nodiscard]] bool has_errors(const std::vector<Diagnostic>& diagnostics);

/// The diagnostic as people read it, GNU style so that editors jump to it:
///   FILE:LINE:COLUMN: error[ID]: MESSAGE
/// followed, where known, by the source line, a caret under the place, and
/// "= help: HINT". Ends with a newline.
[[nodiscard]] std::string to_text(const Diagnostic& diagnostic);

/// The known word closest to `word` in edit distance (optimal string
/// alignment), or an empty string if none is within a third of its length
/// (at least 2 edits). Ties: the earlier one.
[[nodiscard]] std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace kith
