#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kith/study/records.hpp"

namespace kith {

/// The record as bytes, for the journal: the same record always gives the same bytes, on any machine. The team's
/// address is left out, since its number tells it; the number is part of the checksum at the end.
[[nodiscard]] std::string encode_team(const TeamRecord& record);

/// Whether these are the bytes of that team's record, as they were written.
[[nodiscard]] bool is_intact(std::size_t team, std::string_view bytes);

/// The record of the team at `address`, or nothing if the bytes are not an intact record of it.
[[nodiscard]] std::optional<TeamRecord> decode_team(const TeamAddress& address, std::string_view bytes);

}  // namespace kith
