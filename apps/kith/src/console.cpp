#include "console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/core/printable.hpp"

namespace kith::cli {
namespace {

bool terminal(int fd) {
  const char* term = std::getenv("TERM");
  return isatty(fd) == 1 && term != nullptr && std::strcmp(term, "dumb") != 0;
}

}  // namespace

void write_log(std::string_view text) noexcept {
  while (!text.empty()) {
    const auto n = ::write(STDERR_FILENO, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

bool wants_color(int fd, ColorMode mode) {
  if (mode != ColorMode::kAuto) return mode == ColorMode::kAlways;
  const char* no_color = std::getenv("NO_COLOR");
  return (no_color == nullptr || *no_color == '\0') && terminal(fd);
}

Console::Console(const CommonOptions& options)
    : options_{options},
      result_has_color_{wants_color(STDOUT_FILENO, options.color)},
      result_is_terminal_{isatty(STDOUT_FILENO) == 1},
      log_has_color_{wants_color(STDERR_FILENO, options.color)},
      log_is_terminal_{terminal(STDERR_FILENO)} {}

void Console::print(std::string_view text) const {
  if (result_is_terminal_) {
    write_result(printable(text, Keep::kTextColors));
  } else {
    write_result(text);
  }
}

void Console::write_result(std::string_view text) {
  while (!text.empty()) {
    const auto n = ::write(STDOUT_FILENO, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EPIPE) throw BrokenPipe{};
    if (n < 0)
      throw Error{ErrorKind::kIo,
                  std::string{"cannot write to standard output: "} + std::generic_category().message(errno)};
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

void Console::log(std::string_view level, std::string_view text) {
  std::string line{"kith: "};
  if (!level.empty()) line.append(level).append(": ");
  write_log(line.append(printable(text)).append("\n"));
}

void Console::print_json(const nlohmann::ordered_json& document) const {
  // File names may be any bytes; the document is UTF-8 whatever they are.
  print(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

void Console::info(std::string_view text) {
  if (!options_.quiet) log("info", text);
}

void Console::detail(std::string_view text) {
  if (options_.verbose && !options_.quiet) log("debug", text);
}

void Console::warning(std::string_view text) {
  if (!options_.quiet) log("warning", text);
}

void Console::show(const std::vector<Diagnostic>& diagnostics) const {
  std::string text;
  for (const auto& diagnostic : diagnostics) {
    if (diagnostic.severity == Severity::kWarning && options_.quiet) continue;
    auto one = to_text(diagnostic);
    const std::string word = diagnostic.severity == Severity::kError ? "error" : "warning";
    const auto at = one.find(word);
    if (log_has_color_ && at != std::string::npos) {
      one.replace(at, word.size(), (word == "error" ? "\033[1;31m" : "\033[1;33m") + word + "\033[0m");
    }
    text += one;
  }
  write_log(text);
}

std::string Console::styled(std::string_view text, std::string_view code) const {
  if (!result_has_color_) return std::string{text};
  return std::string{"\033["}.append(code).append("m").append(text).append("\033[0m");
}

std::string TextTable::text(const Console& console, bool header) const {
  // Characters of UTF-8: bytes but those that continue one.
  const auto width_of = [](const std::string& text) {
    const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    return text.size() - static_cast<std::size_t>(std::count_if(text.begin(), text.end(), continues));
  };
  std::vector<std::size_t> widths(alignment_.size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string all;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < rows_[r].size(); ++i) {
      const std::string blank(widths[i] - width_of(rows_[r][i]), ' ');
      line += (i > 0 ? "  " : "") + (alignment_[i] == 'r' ? blank + rows_[r][i] : rows_[r][i] + blank);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    all += (header && r == 0 ? console.bold(line) : line) + "\n";
  }
  return all;
}

}  // namespace kith::cli
