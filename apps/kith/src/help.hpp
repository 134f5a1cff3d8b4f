#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"

namespace kith::cli {

/// `kith -h` (short) and `kith --help`.
[[nodiscard]] std::string help_text(const std::vector<CommandDescription>& commands, bool full);
/// `kith COMMAND -h` (short) and `kith COMMAND --help`.
[[nodiscard]] std::string help_text(const CommandDescription& command, bool full);

/// How a command is typically called: two examples. @pre there is such a command.
[[nodiscard]] const std::vector<std::string>& examples_of(const std::string& command);

}  // namespace kith::cli
