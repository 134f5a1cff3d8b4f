#include "kith/core/diagnostic.hpp"

#include <algorithm>

#include "kith/core/printable.hpp"

namespace kith {
namespace {

std::string place(const Diagnostic& d) {
  std::string text = printable(d.file, Keep::kLine);
  if (d.line == 0) return text;
  text.append(":").append(std::to_string(d.line));
  if (d.column > 0) text.append(":").append(std::to_string(d.column));
  return text;
}

// As wide as the line is before `column`: tabs stay tabs, so that the caret stands under its character whatever the
// width of a tab.
std::string blank_before(std::string_view source, std::size_t column) {
  auto blank = printable(source.substr(0, column - 1), Keep::kLine);
  for (char& c : blank) c = c == '\t' ? '\t' : ' ';
  return blank.append(column - 1 - std::min(column - 1, source.size()), ' ');
}

std::string excerpt(const Diagnostic& d) {
  std::string_view source = d.source_line;
  if (source.ends_with('\r')) source.remove_suffix(1);  // of a line break as Windows has it
  const std::string number = std::to_string(d.line);
  const std::string gutter(std::max<std::size_t>(number.size(), 5), ' ');
  std::string text = gutter.substr(number.size()) + number + " | " + printable(source, Keep::kLine) + "\n";
  if (d.column == 0) return text;
  text += gutter + " | " + blank_before(source, d.column) + "^";
  text.append(std::max<std::size_t>(d.length, 1) - 1, '~');
  return text + "\n";
}

// Optimal string alignment: insertions, deletions, substitutions and swaps of
// neighbours, no part edited twice. Three rows of the table are kept.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substituted});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before[j - 2] + 1);
      }
    }
    before.swap(previous);
    previous.swap(current);
  }
  return previous[b.size()];
}

}  // namespace

bool has_errors(const std::vector<Diagnostic>& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::kError; });
}

std::string to_text(const Diagnostic& diagnostic) {
  std::string text = place(diagnostic);
  if (!text.empty()) text += ": ";
  text += diagnostic.severity == Severity::kError ? "error" : "warning";
  if (!diagnostic.id.empty()) text += "[" + diagnostic.id + "]";
  text += ": " + printable(diagnostic.message) + "\n";
  if (diagnostic.line > 0 && !diagnostic.source_line.empty()) text += excerpt(diagnostic);
  if (!diagnostic.hint.empty()) text += "   = help: " + printable(diagnostic.hint) + "\n";
  return text;
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  std::size_t best = std::max<std::size_t>(word.size() / 3, 2) + 1;
  std::string nearest;
  for (const std::string& candidate : known) {
    // The distance is at least the difference in length; computing it takes the product of the lengths.
    if (std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size()) >= best) continue;
    const std::size_t distance = edit_distance(word, candidate);
    // A distance as long as both words would mean that not one letter is kept.
    if (distance < best && distance < std::max(word.size(), candidate.size())) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace kith
