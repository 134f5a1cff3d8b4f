#include <algorithm>
#include <tuple>

#include "diagnostic_at.hpp"
#include "kith/files/reader.hpp"

namespace kith {

// Beyond the cap errors are only counted: finding the line of each takes as long as the text is.
void TomlReport::add(const Diagnostic& kind, const TomlPlace& place, std::string id, std::string message,
                     std::string hint) {
  if (kind.severity == Severity::kError && ++num_errors_ > kMaxErrors) return;
  Diagnostic d =
      diagnostic_at(document_.sources.at(place.source), place, std::move(id), std::move(message), std::move(hint));
  d.severity = kind.severity;
  d.infeasible = kind.infeasible;
  entries_.push_back({place, std::move(d)});
}

void TomlReport::error(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  add({}, place, std::move(id), std::move(message), std::move(hint));
}

void TomlReport::infeasible(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  add({.infeasible = true}, place, std::move(id), std::move(message), std::move(hint));
}

void TomlReport::warning(std::string id, const TomlPlace& place, std::string message, std::string hint) {
  add({.severity = Severity::kWarning}, place, std::move(id), std::move(message), std::move(hint));
}

void TomlReport::withdraw(std::string_view id, const TomlPlace& place, std::string_view message) {
  num_errors_ -= std::erase_if(entries_, [&](const Entry& entry) {
    return entry.diagnostic.id == id && entry.diagnostic.message == message && entry.place == place;
  });
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
