#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kith/study/journal.hpp"

namespace kith {

/// The journals of the shards in these folders, in the order of the shards, to be read.
/// @param program  the program that asks, see JournalIdentity.
/// @throws kith::Error (kInvalidInput) with everything that stands in the way: a folder without a journal (E0630),
/// shards of different studies (E0631), by another program (E0632), of different numbers of shards (E0633), the same
/// shard twice (E0634), a missing one (E0635), an unfinished one (E0636).
[[nodiscard]] std::vector<Journal> open_shards(std::span<const std::filesystem::path> folders,
                                               const std::string& program);

}  // namespace kith
