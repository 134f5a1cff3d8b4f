#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kith {

/// How many characters wide the program writes its text.
inline constexpr std::size_t kTextWidth = 80;

/// The words of a text on lines of at most `width` characters, where words are not longer. The first line begins with
/// `first`, the others with `indent`. Without a line break at the end.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t width, std::string_view indent = "",
                                  std::string_view first = "");

/// A line that begins with blanks on lines of at most kTextWidth characters; those after the first are indented by two
/// more. Lines that fit stay as they are.
[[nodiscard]] std::string wrapped_line(std::string_view line);

}  // namespace kith
