#include <algorithm>
#include <tuple>

#include "diagnostic_at.hpp"
#include "kith/toml/reader.hpp"

namespace kith {

void TomlReport::add(Diagnostic diagnostic, const TomlPlace& place) {
  if (diagnostic.severity == Severity::kError) {
    ++num_errors_;
    if (num_errors_ > kMaxErrors) return;
  }
  entries_.push_back({place, std::move(diagnostic)});
}

void TomlReport::error(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  Diagnostic d =
      diagnostic_at(document_.sources.at(place.source), place, std::move(id), std::move(message), std::move(hint));
  add(std::move(d), place);
}

void TomlReport::infeasible(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  Diagnostic d =
      diagnostic_at(document_.sources.at(place.source), place, std::move(id), std::move(message), std::move(hint));
  d.infeasible = true;
  add(std::move(d), place);
}

void TomlReport::warning(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  Diagnostic d =
      diagnostic_at(document_.sources.at(place.source), place, std::move(id), std::move(message), std::move(hint));
  d.severity = Severity::kWarning;
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
