#include "kith/files/document.hpp"

#include <algorithm>

#include "diagnostic_at.hpp"

namespace kith {
namespace {

// The same value as if it had been read from source number `source`.
TomlValue moved_to_source(const TomlValue& value, std::size_t source) {
  TomlPlace place = value.place();
  place.source = source;
  TomlValue::Content content = value.content();
  if (auto* array = std::get_if<TomlArray>(&content)) {
    for (TomlValue& element : *array) element = moved_to_source(element, source);
  } else if (const auto* table = std::get_if<TomlTable>(&content)) {
    TomlTable moved;
    for (const TomlEntry& entry : table->entries()) {
      TomlEntry copy{entry.key, entry.place, moved_to_source(entry.value, source)};
      copy.place.source = source;
      moved.append(std::move(copy));
    }
    content = std::move(moved);
  }
  return TomlValue{std::move(content), place};
}

// Whether the text has an '=' outside quotes.
bool has_equals_sign(std::string_view text) {
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '=') {
      return true;
    }
  }
  return false;
}

}  // namespace

std::string_view TomlSource::line(std::size_t line) const noexcept {
  std::string_view rest{text};
  for (std::size_t i = 1; i < line; ++i) {
    const auto end = rest.find('\n');
    if (end == std::string_view::npos) return {};
    rest.remove_prefix(end + 1);
  }
  if (line == 0) return {};
  rest = rest.substr(0, rest.find('\n'));
  if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
  return rest;
}

TomlPlace TomlDocument::inside(const TomlValue& value, std::size_t offset, std::size_t length) const {
  TomlPlace place = value.place();
  const std::string* string = value.string();
  if (string == nullptr || place.source >= sources.size()) return place;
  // Single-line strings without escapes are their text plus two quotes; ASCII
  // only, because columns count characters and strings hold bytes.
  const bool ascii = std::all_of(string->begin(), string->end(), [](char c) { return c >= 0x20 && c < 0x7F; });
  if (!ascii || place.length != string->size() + 2) return place;
  place.column += 1 + std::min(offset, string->size());
  place.length = std::max<std::size_t>(length, 1);
  return place;
}

TomlAssignmentParsing parse_assignment(std::string_view text, const std::string& name) {
  const TomlSource source{name, std::string{text}};
  const std::string form = "write KEY=VALUE, for instance teacher.process_noise=0.5; text values need \"quotes\"";
  const auto refuse = [&](const TomlPlace& place, const std::string& message) {
    return TomlAssignmentParsing{std::nullopt, {diagnostic_at(source, place, "E0113", message, form)}};
  };
  if (text.find('\n') != std::string_view::npos || !has_equals_sign(text)) {
    return refuse({0, 1, 1, std::max<std::size_t>(text.size(), 1)}, "not an assignment KEY=VALUE");
  }
  TomlParsing parsing = parse_toml(text, name);
  if (!parsing.document) {
    for (Diagnostic& d : parsing.diagnostics) {
      if (d.id != "E0110") d.hint = form;
    }
    return {std::nullopt, std::move(parsing.diagnostics)};
  }
  if (parsing.document->root.entries().size() != 1) return refuse({0, 1, 1, 1}, "not an assignment KEY=VALUE");

  TomlAssignment assignment{{}, {}, {}, source};
  const TomlEntry* entry = &parsing.document->root.entries().front();
  assignment.keys.push_back(entry->key);
  // A dotted key is a chain of tables that begin where their key does; an
  // inline table begins at its brace, behind the '='.
  while (entry->value.table() != nullptr && entry->value.place().column == entry->place.column &&
         entry->value.table()->entries().size() == 1) {
    entry = &entry->value.table()->entries().front();
    assignment.keys.push_back(entry->key);
  }
  assignment.place = entry->place;
  assignment.value = entry->value;
  return {std::move(assignment), {}};
}

std::vector<Diagnostic> assign(TomlDocument& document, const TomlAssignment& assignment) {
  // Check first, so that a failed assignment changes nothing.
  const TomlTable* walk = &document.root;
  for (std::size_t i = 0; i + 1 < assignment.keys.size() && walk != nullptr; ++i) {
    const TomlValue* next = walk->find(assignment.keys[i]);
    if (next != nullptr && next->table() == nullptr) {
      return {diagnostic_at(assignment.source, assignment.place, "E0114",
                            "'" + assignment.keys[i] + "' is " + std::string{next->kind_name()} +
                                ", so it has no key '" + assignment.keys[i + 1] + "'",
                            "")};
    }
    walk = next == nullptr ? nullptr : next->table();
  }

  const std::size_t source = document.sources.size();
  document.sources.push_back(assignment.source);
  TomlPlace place = assignment.place;
  place.source = source;
  TomlTable* table = &document.root;
  for (std::size_t i = 0; i + 1 < assignment.keys.size(); ++i) {
    const std::string& key = assignment.keys[i];
    if (table->find(key) == nullptr) table->append(TomlEntry{key, place, TomlValue{TomlTable{}, place}});
    table = table->find(key)->table();
  }
  table->set(TomlEntry{assignment.keys.back(), place, moved_to_source(assignment.value, source)});
  return {};
}

}  // namespace kith
