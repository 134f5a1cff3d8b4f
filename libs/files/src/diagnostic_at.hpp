#pragma once

#include <string>
#include <utility>

#include "kith/core/diagnostic.hpp"
#include "kith/files/document.hpp"

namespace kith {

// An error at a place of a source, with the line of text it is in.
[[nodiscard]] inline Diagnostic diagnostic_at(const TomlSource& source, const TomlPlace& place, std::string id,
                                              std::string message, std::string hint = {}) {
  Diagnostic d;
  d.id = std::move(id);
  d.message = std::move(message);
  d.hint = std::move(hint);
  d.file = source.name;
  d.line = place.line;
  d.column = place.column;
  d.length = place.length;
  d.source_line = source.line(place.line);
  return d;
}

}  // namespace kith
