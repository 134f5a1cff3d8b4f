#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace kith {

// Reads what can be read of a damaged journal without SQLite's help, which gives up on a file whose header, length or
// inner pages are wrong: looks at every place of every page, in the file at `path` and in the write-ahead log beside
// it, for a row of the table `units`, and hands on those whose record was sealed for that team with this key. Whatever
// else is in the files, of another journal for instance, fails that test. A record may be handed on several times, each
// time with the same bytes. Pages that cannot be read are passed over.
// @throws kith::Error (kIo) if the file cannot be opened.
void salvage_records(const std::filesystem::path& path, std::string_view key, std::size_t teams,
                     const std::function<void(std::size_t team, std::string_view bytes)>& visit);

}  // namespace kith
