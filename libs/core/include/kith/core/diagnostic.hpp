#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace kith {

enum class Severity { kError, kWarning };

/// What a program can offer its user to get past an error. Libraries name the remedy only; how to ask for it depends on
/// the program: the command line names its options ("add --yes"), a server has buttons.
enum class Remedy {
  kNone,
  kReplaceContents,  ///< Use another folder, or allow that what this one holds is replaced.
  kStartOver,        ///< Discard unfinished work and begin anew.
  kAllowStart,       ///< Do not insist on work to resume.
  kRunStudy,         ///< Make the results first: run the study.
  kRunShard,         ///< Make the shard first.
  kMergeShards,      ///< Put the shards of the study together.
  kMergePart,        ///< Put together what there is.
  kAnalyseTable,     ///< Analyse the table on its own, without its run.
  kShowMap,          ///< Look at the map of the domain, with everything on it.
  kShowStates,       ///< Look at the states of an MDP and their names.
  kListConstraints,  ///< Look at the list of constraints that can be taught or tested.
};

/// How to mend an error: in words, by a remedy, or either.
struct Advice {
  Advice() = default;
  // A text or a remedy is advice.
  // NOLINTBEGIN(google-explicit-constructor)
  Advice(Remedy what) : remedy{what} {}
  Advice(std::string text, Remedy what = Remedy::kNone) : hint{std::move(text)}, remedy{what} {}
  Advice(const char* text, Remedy what = Remedy::kNone) : hint{text}, remedy{what} {}
  // NOLINTEND(google-explicit-constructor)

  std::string hint;
  Remedy remedy = Remedy::kNone;
};

/// One thing that is wrong with a file that a person wrote: what, where, and
/// how to mend it. Lines and columns are 1-based; 0 means "the file as a whole".
struct Diagnostic {
  Severity severity = Severity::kError;
  std::string id{};       ///< Stable name, such as "E0312".
  std::string message{};  ///< One sentence, lower case, no full stop.
  std::string file{};     ///< As the user named it.
  std::size_t line = 0;
  std::size_t column = 0;
  std::size_t length = 1;         ///< Characters to underline, at least 1.
  std::string hint{};             ///< How to mend it; may be empty.
  std::string source_line{};      ///< The text of `line`, for display; may be empty.
  bool infeasible = false;        ///< Well-formed, but nothing can be done with it: ErrorKind::kInfeasible.
  Remedy remedy = Remedy::kNone;  ///< What else may help.

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
