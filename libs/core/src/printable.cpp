#include "kith/core/printable.hpp"

#include <algorithm>

namespace kith {
namespace {

bool is_kept(char c, Keep keep) { return c == '\t' || (c == '\n' && keep != Keep::kLine); }

// How many bytes at the beginning of the text are a colour; 0: none.
std::size_t color_length(std::string_view text) {
  if (text.substr(0, 2) != "\033[") return 0;
  const auto end = text.find_first_not_of("0123456789;", 2);
  return end != std::string_view::npos && text[end] == 'm' ? end + 1 : 0;
}

// How many bytes at the beginning of the text are a control character; 0: none.
std::size_t control_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x20 || first == 0x7f) return 1;
  const bool high = first == 0xc2 && text.size() > 1;  // U+0080 to U+009F in UTF-8
  return high && static_cast<unsigned char>(text[1]) >= 0x80 && static_cast<unsigned char>(text[1]) < 0xa0 ? 2 : 0;
}

}  // namespace

std::string printable(std::string_view text, Keep keep) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto color = keep == Keep::kTextColors ? color_length(text) : 0;
    const auto control = color > 0 || is_kept(text[0], keep) ? 0 : control_length(text);
    if (control > 0) {
      const auto code = static_cast<unsigned char>(text[control - 1]);
      result.append("\\x");
      result += kDigits[code / 16];
      result += kDigits[code % 16];
      text.remove_prefix(control);
    } else {
      const auto length = std::max<std::size_t>(color, 1);
      result.append(text.substr(0, length));
      text.remove_prefix(length);
    }
  }
  return result;
}

}  // namespace kith
