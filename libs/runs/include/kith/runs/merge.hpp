#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kith/runs/journal.hpp"

namespace kith {

/// The shards of a study, ready to be put together.
struct Shards {
  std::vector<Journal> journals;     ///< In the order of the shards, to be read; every record was checked.
  std::vector<std::string> missing;  ///< What they lack of the whole study, in words; only if that was allowed.
};

/// Opens the shards in these folders and checks that they make up one whole study.
/// @param program        the program that asks, see JournalIdentity.
/// @param allow_partial  whether missing, unfinished and damaged parts are listed instead of refused.
/// @throws kith::Error with everything that stands in the way. kInvalidInput: a folder without a journal (E0630),
/// shards of different studies (E0631), by another program (E0632), of different numbers of shards (E0633), the same
/// shard twice (E0634). kInfeasible: a shard is missing (E0635), is not finished (E0636). kMismatch: damaged records or
/// a damaged journal (E0637), a manifest that is not of the same study as the journal beside it (E0638).
[[nodiscard]] Shards open_shards(std::span<const std::filesystem::path> folders, const std::string& program,
                                 bool allow_partial = false);

}  // namespace kith
