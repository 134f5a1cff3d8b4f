#pragma once

#include <string>
#include <string_view>

namespace kith {

/// What printable() lets pass besides text.
enum class Keep {
  kText,        ///< Tabs and line breaks.
  kTextColors,  ///< Colours and bold too: `ESC [ NUMBERS m`, which changes nothing but how text looks.
  kLine,        ///< Tabs only.
};

/// The text with every control character (U+0000 to U+001F, U+007F to U+009F) written as `\xHH`, so that names and
/// values from files cannot command the terminal that shows them. All other bytes stay as they are. What was
/// made printable once stays the same.
[[nodiscard]] std::string printable(std::string_view text, Keep keep = Keep::kText);

}  // namespace kith
