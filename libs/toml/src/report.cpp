#include <algorithm>
#include <tuple>

#include "kith/toml/reader.hpp"

namespace kith {

void TomlReport::add(Diagnostic diagnostic, const TomlPlace& place) {
  if (diagnostic.severity == Severity::kError) {
    ++num_errors_;
    if (num_errors_ > kMaxErrors) return;
  }
  const TomlSource& source = document_.sources.at(place.source);
  diagnostic.file = source.name;
  diagnostic.line = place.line;
  diagnostic.column = place.column;
  diagnostic.length = place.length;
  diagnostic.source_line = source.line(place.line);
  entries_.push_back({place, std::move(diagnostic)});
}

void TomlReport::error(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  Diagnostic d;
  d.id = std::move(id);
  d.message = std::move(message);
  d.hint = std::move(hint);
  add(std::move(d), place);
}

void TomlReport::infeasible(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  Diagnostic d;
  d.id = std::move(id);
  d.message = std::move(message);
  d.hint = std::move(hint);
  d.infeasible = true;
  add(std::move(d), place);
}

void TomlReport::warning(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  Diagnostic d;
  d.severity = Severity::kWarning;
  d.id = std::move(id);
  d.message = std::move(message);
  d.hint = std::move(hint);
  add(std::move(d), place);
}

std::vector<Diagnostic> TomlReport::diagnostics() const {
  std::vector<Entry> sorted = entries_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.place.source, a.place.line, a.place.column) <
           std::tie(b.place.source, b.place.line, b.place.column);
  });
  std::vector<Diagnostic> diagnostics;
  diagnostics.reserve(sorted.size());
  for (Entry& entry : sorted) diagnostics.push_back(std::move(entry.diagnostic));
  return diagnostics;
}

}  // namespace kith
