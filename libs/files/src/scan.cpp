#include "scan.hpp"

#include "kith/files/document.hpp"

namespace kith::detail {
namespace {

// Walks over the text once. Strings and comments are skipped; brackets and dots
// of everything else are counted.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& name) : text_{text}, name_{name} {}

  std::optional<Diagnostic> run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        skip_comment();
      } else if (c == '"' || c == '\'') {
        skip_string(c);
      } else {
        if (static_cast<unsigned char>(c) >= 0x80) return beyond_ascii();
        count(c);
        if (depth_ > kMaxTomlDepth || dots_ > kMaxTomlDepth) return too_deep();
        ++at_;
      }
    }
    return std::nullopt;
  }

 private:
  void skip_comment() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  // A string that never ends runs to the end of its line (or of the text, for
  // three quotes); the parser proper will complain.
  void skip_string(char quote) {
    const std::string three(3, quote);
    if (text_.substr(at_, 3) == three) {
      at_ += 3;
      while (at_ < text_.size() && text_.substr(at_, 3) != three) at_ += step(quote);
      at_ += 3;
      // Up to two quotes may stand right before the closing three.
      while (at_ < text_.size() && text_[at_] == quote) ++at_;
      return;
    }
    ++at_;
    while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') at_ += step(quote);
    if (at_ < text_.size() && text_[at_] == quote) ++at_;
  }

  // An escape sequence is stepped over as two characters.
  [[nodiscard]] std::size_t step(char quote) const { return quote == '"' && text_[at_] == '\\' ? 2 : 1; }

  void count(char c) {
    if (c == '[' || c == '{') ++depth_;
    if ((c == ']' || c == '}') && depth_ > 0) --depth_;
    if (c == '.') {
      ++dots_;
    } else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') {
      dots_ = 0;
    }
  }

  [[nodiscard]] Diagnostic here(std::string id, std::string message, std::string hint) const {
    Diagnostic d;
    d.id = std::move(id);
    d.message = std::move(message);
    d.hint = std::move(hint);
    d.file = name_;
    d.line = 1;
    d.column = 1;
    for (std::size_t i = 0; i < at_; ++i) {
      if (text_[i] == '\n') {
        ++d.line;
        d.column = 1;
      } else if ((static_cast<unsigned char>(text_[i]) & 0xC0U) != 0x80U) {
        ++d.column;
      }
    }
    d.source_line = TomlSource{name_, std::string{text_}}.line(d.line);
    return d;
  }

  [[nodiscard]] Diagnostic beyond_ascii() const {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF" && at_ == 0) {
      return here("E0105", "the file starts with a byte order mark", "save it as plain UTF-8");
    }
    if (at_ == 0 && (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))) {
      return here("E0105", "the file is UTF-16", "save it as UTF-8");
    }
    return here("E0105", "non-ASCII character outside strings and comments", "put keys and text into \"quotes\"");
  }

  [[nodiscard]] Diagnostic too_deep() const {
    return here("E0104", "nested deeper than " + std::to_string(kMaxTomlDepth) + " levels", "");
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  std::size_t dots_ = 0;
};

}  // namespace

std::optional<Diagnostic> scan_toml(std::string_view text, const std::string& name) {
  if (text.size() > kMaxTomlBytes) {
    Diagnostic d;
    d.id = "E0103";
    d.file = name;
    d.message = "the file has " + std::to_string(text.size()) + " bytes; at most " + std::to_string(kMaxTomlBytes) +
                " are read";
    return d;
  }
  return Scanner{text, name}.run();
}

}  // namespace kith::detail
