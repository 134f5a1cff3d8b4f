#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace kith::cli {

/// `kith -h` (short) and `kith --help`.
[[nodiscard]] std::string help_text(const std::vector<Command>& commands, bool full);
/// `kith COMMAND -h` (short) and `kith COMMAND --help`.
[[nodiscard]] std::string help_text(const Command& command, const std::vector<OptionDescription>& options, bool full);

}  // namespace kith::cli
