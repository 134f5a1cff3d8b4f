#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kith/core/diagnostic.hpp"

namespace kith::detail {

// Looks at a text before the TOML parser does and refuses what the parser must
// not see: too many bytes, characters beyond ASCII outside strings and
// comments (they take paths of the parser that are not robust), and nesting so
// deep that recursion could exhaust the stack.
[[nodiscard]] std::optional<Diagnostic> scan_toml(std::string_view text, const std::string& name);

}  // namespace kith::detail
