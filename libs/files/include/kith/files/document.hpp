#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/files/value.hpp"

namespace kith {

/// A text that values of a document came from: the file, or an assignment made
/// on the command line.
struct TomlSource {
  std::string name;  ///< As the user named it; used in messages.
  std::string text;

  /// Line `line` (1-based) without its end; empty if there is no such line.
  [[nodiscard]] std::string_view line(std::size_t line) const noexcept;
};

/// A parsed TOML text that remembers where everything stands.
struct TomlDocument {
  std::vector<TomlSource> sources;
  TomlTable root;

  /// The place of character `offset` (0-based) of the string `value`, `length`
  /// characters long; of the whole value if the text as written differs from
  /// the string (escapes, several lines).
  [[nodiscard]] TomlPlace inside(const TomlValue& value, std::size_t offset, std::size_t length = 1) const;
};

/// What came of parsing: a document unless the text is no TOML or breaks a limit.
struct TomlParsing {
  std::optional<TomlDocument> document;
  std::vector<Diagnostic> diagnostics;
};

/// Largest file that is read, in bytes.
inline constexpr std::size_t kMaxTomlBytes = std::size_t{1} << 20;
/// Deepest nesting of tables and arrays that is read.
inline constexpr std::size_t kMaxTomlDepth = 16;

/// Parses TOML 1.0. Beyond that standard, characters outside strings and
/// comments must be ASCII, and the two limits above hold. Never throws for bad
/// content; syntax errors stop at the first one. `name` is used in messages.
[[nodiscard]] TomlParsing parse_toml(std::string_view text, const std::string& name);

/// `KEY=VALUE` as given on a command line, where KEY may be dotted and VALUE is
/// any TOML value ("teacher.process_noise=0.5").
struct TomlAssignment {
  std::vector<std::string> keys;  ///< At least one.
  TomlPlace place;                ///< Of the last key.
  TomlValue value;
  TomlSource source;  ///< The text as given.
};

struct TomlAssignmentParsing {
  std::optional<TomlAssignment> assignment;
  std::vector<Diagnostic> diagnostics;
};

/// Parses one assignment. `name` is used in messages ("--set").
[[nodiscard]] TomlAssignmentParsing parse_assignment(std::string_view text, const std::string& name);

/// Sets the assigned key in the document, making tables on the way where there
/// are none. A key that goes through something that is no table changes nothing
/// and is reported.
[[nodiscard]] std::vector<Diagnostic> assign(TomlDocument& document, const TomlAssignment& assignment);

/// The table as TOML: in its order, except that plain values come before
/// tables; numbers in shortest round-trip form. Parsing it gives an equal table.
[[nodiscard]] std::string to_toml(const TomlTable& table);
/// A single value on one line, tables and arrays inline.
[[nodiscard]] std::string to_toml(const TomlValue& value);

}  // namespace kith
