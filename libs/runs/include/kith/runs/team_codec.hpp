#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "kith/study/records.hpp"

namespace kith {

/// `content` with a checksum behind it: the first bytes of SHA-256 over the key, the team's number and the content. The
/// key says whose work it is (JournalIdentity::key()), so bytes of another study, program or team are never taken for
/// it.
[[nodiscard]] std::string seal_record(std::size_t team, std::string content, std::string_view key);

/// The content, or nothing if the bytes were not sealed for this team with this key.
[[nodiscard]] std::optional<std::string_view> unseal_record(std::size_t team, std::string_view bytes,
                                                            std::string_view key);

/// The record as sealed bytes, for the journal: the same record always gives the same bytes, on any machine. The team's
/// address is left out, since its number tells it.
/// @param layout  as a kith of that layout wrote it, which leaves out what came later (RecordColumn::since); from 8.
[[nodiscard]] std::string encode_team(const TeamRecord& record, std::string_view key,
                                      std::optional<int> layout = std::nullopt);

/// Whether these are the bytes of that team's record, as they were written.
[[nodiscard]] bool is_intact(std::size_t team, std::string_view bytes, std::string_view key);

/// The record of the team at `address`, or nothing if the bytes are not an intact record of it.
[[nodiscard]] std::optional<TeamRecord> decode_team(const TeamAddress& address, std::string_view bytes,
                                                    std::string_view key);

}  // namespace kith
