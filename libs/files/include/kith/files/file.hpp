#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace kith {

/// The text of a TOML file; at most one byte more than is parsed, so that too large a file is told from the right
/// size. Nothing if it cannot be read.
[[nodiscard]] std::optional<std::string> read_toml_text(const std::filesystem::path& path);

/// Why read_toml_text() gives nothing: "Permission denied", "it is a folder; name a file in it: robot/domain.toml".
[[nodiscard]] std::string why_unreadable(const std::filesystem::path& path);

}  // namespace kith
