#pragma once

#include <exception>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"

namespace kith::cli {

enum class ColorMode { kAuto, kAlways, kNever };
enum class ProgressMode { kAuto, kBar, kJson, kNone };

/// What every command understands.
struct CommonOptions {
  bool json = false;
  ColorMode color = ColorMode::kAuto;
  bool quiet = false;
  bool verbose = false;
};

/// Whoever reads our output has stopped reading: exit 141, quietly.
class BrokenPipe : public std::exception {};

/// The two places that commands write to: results to standard output, everything
/// else to standard error, as `kith: LEVEL: TEXT` with control characters escaped.
class Console {
 public:
  explicit Console(const CommonOptions& options);

  /// Writes a result: to a terminal with control characters escaped, which may come from files; else as it is. @throws
  /// BrokenPipe, or kith::Error (kIo) if it cannot be written.
  void print(std::string_view text) const;
  /// Writes one JSON document, indented, with a line break at the end.
  void print_json(const nlohmann::ordered_json& document) const;
  /// Makes and prints the document if --json asks for it, else the text.
  template <typename Document, typename Text>
  void print(Document document, Text text) const {
    if (json()) {
      print_json(document());
    } else {
      print(text());
    }
  }

  void info(std::string_view text);     ///< Unless -q.
  void detail(std::string_view text);   ///< With -v.
  void warning(std::string_view text);  ///< Unless -q.
  /// Warnings and errors of a file, as they are.
  void show(const std::vector<Diagnostic>& diagnostics) const;

  [[nodiscard]] bool json() const noexcept { return options_.json; }
  [[nodiscard]] bool quiet() const noexcept { return options_.quiet; }
  /// Whether standard error is a terminal that can move its cursor.
  [[nodiscard]] bool log_is_terminal() const noexcept { return log_is_terminal_; }

  /// The text in bold, dim or red where standard output shows colours.
  [[nodiscard]] std::string bold(std::string_view text) const { return styled(text, "1"); }
  [[nodiscard]] std::string dim(std::string_view text) const { return styled(text, "2"); }

 private:
  static void write_result(std::string_view text);
  [[nodiscard]] std::string styled(std::string_view text, std::string_view code) const;
  void log(std::string_view level, std::string_view text);

  CommonOptions options_;
  bool result_has_color_ = false;
  bool result_is_terminal_ = false;
  bool log_has_color_ = false;
  bool log_is_terminal_ = false;
};

/// Writes to standard error as far as that can be done: where there is none, or it is full, there is nobody to tell.
void write_log(std::string_view text) noexcept;

/// Whether file descriptor `fd` should get colours: NO_COLOR, TERM and --color decide.
[[nodiscard]] bool wants_color(int fd, ColorMode mode);

/// Columns of text, aligned; numbers to the right.
class TextTable {
 public:
  /// One letter per column: 'l' or 'r'.
  explicit TextTable(std::string alignment) : alignment_{std::move(alignment)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// The rows, one a line; the first in bold, if it is a header.
  [[nodiscard]] std::string text(const Console& console, bool header = true) const;

 private:
  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace kith::cli
