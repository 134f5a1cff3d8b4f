#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/files/document.hpp"

namespace kith {

/// Collects what is wrong with a document, each with file, line and column.
class TomlReport {
 public:
  /// At most so many errors of one file are reported.
  static constexpr std::size_t kMaxErrors = 20;

  /// `document` must outlive the report.
  explicit TomlReport(const TomlDocument& document) : document_{document} {}

  void error(std::string id, const TomlPlace& place, std::string message, std::string hint = {});
  /// An error of the kind "well-formed, but nothing can be done with it".
  void infeasible(std::string id, const TomlPlace& place, std::string message, std::string hint = {});
  void warning(std::string id, const TomlPlace& place, std::string message, std::string hint = {});
  /// Takes an error back, of which another one says more.
  void withdraw(std::string_view id, const TomlPlace& place, std::string_view message);

  [[nodiscard]] bool has_errors() const noexcept { return num_errors_ > 0; }
  /// Errors so far, also those beyond the cap.
  [[nodiscard]] std::size_t num_errors() const noexcept { return num_errors_; }
  [[nodiscard]] const TomlDocument& document() const noexcept { return document_; }

  /// The diagnostics in file order: the first kMaxErrors errors and all warnings.
  [[nodiscard]] std::vector<Diagnostic> diagnostics() const;

 private:
  void add(const Diagnostic& kind, const TomlPlace& place, std::string id, std::string message, std::string hint);

  struct Entry {
    TomlPlace place;
    Diagnostic diagnostic;
  };
  const TomlDocument& document_;
  std::vector<Entry> entries_;
  std::size_t num_errors_ = 0;
};

enum class Presence { kOptional, kRequired };

/// Allowed values of a real number; open ends exclude the bound itself.
struct RealRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;
  bool open_max = false;
};

/// Allowed values of an integer, both ends included.
struct IntegerRange {
  std::int64_t min = std::numeric_limits<std::int64_t>::min();
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
};

/// Typed access to one value. `what` names it in messages ("'discount'"). Each
/// returns nothing after reporting what is wrong; none throws.
[[nodiscard]] std::optional<bool> read_boolean(const TomlValue& value, std::string_view what, TomlReport& report);
[[nodiscard]] std::optional<std::string> read_string(const TomlValue& value, std::string_view what, TomlReport& report);
[[nodiscard]] std::optional<std::int64_t> read_integer(const TomlValue& value, std::string_view what,
                                                       const IntegerRange& range, TomlReport& report);
/// Integers count as reals; infinities and NaN never do.
[[nodiscard]] std::optional<double> read_real(const TomlValue& value, std::string_view what, const RealRange& range,
                                              TomlReport& report);
/// One of a few words; returns its index in `allowed`.
[[nodiscard]] std::optional<std::size_t> read_word(const TomlValue& value, std::string_view what,
                                                   const std::vector<std::string>& allowed, TomlReport& report);
[[nodiscard]] const TomlTable* read_table(const TomlValue& value, std::string_view what, TomlReport& report);
[[nodiscard]] const TomlArray* read_array(const TomlValue& value, std::string_view what, TomlReport& report);

/// Typed access to the keys of one table. Remembers which keys were asked for;
/// finish() reports the others as unknown, with the nearest known one.
class TomlReader {
 public:
  /// `name` is what people call the table ("[mdp]"); `place` is where a missing
  /// key is reported. Table and report must outlive the reader.
  TomlReader(const TomlTable& table, const TomlPlace& place, std::string name, TomlReport& report)
      : table_{table}, place_{place}, name_{std::move(name)}, report_{report} {}

  /// The value of `key`, or nullptr; a missing required key is reported.
  [[nodiscard]] const TomlValue* value(std::string_view key, Presence presence);

  [[nodiscard]] std::optional<bool> boolean(std::string_view key, Presence presence);
  [[nodiscard]] std::optional<std::string> string(std::string_view key, Presence presence);
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key, Presence presence,
                                                    const IntegerRange& range = {});
  [[nodiscard]] std::optional<double> real(std::string_view key, Presence presence, const RealRange& range = {});
  [[nodiscard]] std::optional<std::size_t> word(std::string_view key, Presence presence,
                                                const std::vector<std::string>& allowed);
  [[nodiscard]] const TomlArray* array(std::string_view key, Presence presence);
  /// Every element a string; nothing if any is not.
  [[nodiscard]] std::optional<std::vector<std::string>> strings(std::string_view key, Presence presence);
  /// A reader of the table under `key`, named "[NAME.key]" or "[key]" at the top.
  [[nodiscard]] std::optional<TomlReader> table(std::string_view key, Presence presence);

  /// Whether the table has the key; counts as asking for it.
  [[nodiscard]] bool has(std::string_view key);
  /// Makes the key known without reading it.
  void know(std::string_view key);
  /// Reports every key that nobody asked for. Call last.
  void finish();

  [[nodiscard]] const TomlTable& content() const noexcept { return table_; }
  [[nodiscard]] const TomlPlace& place() const noexcept { return place_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] TomlReport& report() const noexcept { return report_; }

 private:
  [[nodiscard]] std::string missing(std::string_view key) const;

  const TomlTable& table_;
  TomlPlace place_;
  std::string name_;
  TomlReport& report_;
  std::vector<std::string> known_;
};

/// "did you mean 'X'?" for the known word nearest to `word`, or, without one, the
/// list of the known words; empty if there are none.
[[nodiscard]] std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace kith
