#pragma once

// Folders as inputs: what files they hold, and edits of these that an input's bytes stand for.

#include <filesystem>
#include <map>
#include <string>

#include "fuzzing.hpp"

namespace kith::fuzzing {

/// The files below a folder: contents by relative path.
using FolderContent = std::map<std::string, std::string>;
[[nodiscard]] FolderContent content_of(const std::filesystem::path& folder);
/// Makes the folder hold exactly this.
void put(const std::filesystem::path& folder, const FolderContent& content);

/// Bytes per edit: what is done, to which file, where (two bytes), and how (two).
inline constexpr std::size_t kEditSize = 6;
/// One edit after the other until the bytes are used up: bits flipped, bytes set, files cut off, removed, exchanged,
/// put in from the foreign folder, or mutated as what they are (TOML, CSV, JSON).
[[nodiscard]] FolderContent edited(FolderContent content, const FolderContent& foreign, Bytes& bytes);

/// The folder of a run whose manifest agrees with its files again, as if they had been written so.
[[nodiscard]] FolderContent with_matching_manifest(FolderContent content);

}  // namespace kith::fuzzing
