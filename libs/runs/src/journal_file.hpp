#pragma once

#include <filesystem>

#include "kith/files/sqlite.hpp"
#include "kith/runs/journal.hpp"

// How the file of a journal comes to be, is read, and is replaced after damage; what is in it is the Journal's.
namespace kith {

// Whether there is a file of that name, whatever it is. @throws kith::Error (kIo) if that cannot be told.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

// The file that holds the journal at `path` right now: the one that a salvage has just made, or the one of that name.
// Nothing if there is neither. @throws kith::Error (kIo) if it is not a regular file, which could be waited for
// forever.
[[nodiscard]] std::optional<std::filesystem::path> current_file(const std::filesystem::path& path);

// A new journal at `path`, complete and on the disk before it has its name.
void make_journal_file(const std::filesystem::path& path, const JournalIdentity& identity);

// @throws kith::Error kUsage if it was written by another version, SqliteError if it cannot be read. Nothing if the
// file does not say it, or says it in a way that its checksum does not confirm.
[[nodiscard]] std::optional<JournalIdentity> read_identity(Database& database);

// Whether the team belongs to this study and shard.
[[nodiscard]] bool belongs(const JournalIdentity& identity, std::int64_t team);

// Copies every intact record of this identity that SQLite reads from the damaged journal at `path` to a new one, which
// takes its place; the old one is kept as `path`.damaged. Where this is ended, replace_by_salvaged() or the next call
// goes on. Returns false, and changes nothing, if there is no such record, unless the file is `known` to be of this
// identity.
[[nodiscard]] bool salvage_journal(const std::filesystem::path& path, const JournalIdentity& identity, bool known);

// Removes what was left of files that were being made for the journals in a folder when their program ended.
void remove_unfinished_journals(const std::filesystem::path& folder);

// The file that a salvage has made, until it has taken its place.
[[nodiscard]] std::filesystem::path salvaged_file(const std::filesystem::path& path);

// Finishes a salvage whose new file is complete; otherwise does nothing.
void replace_by_salvaged(const std::filesystem::path& path);

}  // namespace kith
