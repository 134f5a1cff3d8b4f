#pragma once

#include <vector>

#include "kith/core/diagnostic.hpp"

namespace kith::cli {

/// The diagnostics with their remedies added to the hints, as options and commands of this program.
[[nodiscard]] std::vector<Diagnostic> with_remedies(std::vector<Diagnostic> diagnostics);

}  // namespace kith::cli
