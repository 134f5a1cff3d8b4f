// TOML texts and assignments of the command line. What is read can be written, and reading that gives an equal table,
// which is written as the same text.

#include "../fuzzing.hpp"
#include "kith/files/document.hpp"

using namespace kith;

namespace {

void check_assignment(std::string_view text, TomlDocument& document) {
  const auto parsed = parse_assignment(text, "--set");
  fuzzing::require(parsed.assignment.has_value() != has_errors(parsed.diagnostics), "an assignment, or errors");
  fuzzing::require_good(parsed.diagnostics, text, "--set");
  if (parsed.assignment) fuzzing::require_good(assign(document, *parsed.assignment), text, "--set");
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "toml", .head_lines = 1};

// The first line is an assignment.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  const auto assignment = bytes.line();
  auto parsed = parse_toml(bytes.rest(), "file");
  fuzzing::require(parsed.document.has_value() != has_errors(parsed.diagnostics), "a document, or errors");
  const auto outcome = fuzzing::require_good(parsed.diagnostics, bytes.rest(), "file");
  auto document = parsed.document ? *std::move(parsed.document) : TomlDocument{{{"file", ""}}, {}};
  check_assignment(assignment, document);
  const auto text = to_toml(document.root);
  const auto again = parse_toml(text, "again");
  fuzzing::require(again.document.has_value(), "what is written can be read", text);
  fuzzing::require(again.document->root == document.root, "what is written reads as an equal table", text);
  fuzzing::require(to_toml(again.document->root) == text, "writing is a fixpoint", text);
  return outcome;
}
