#pragma once

#include "kith/files/reader.hpp"
#include "kith/files/value.hpp"
#include "kith/study/group_options.hpp"

namespace kith {

/// Reads every key of `[group]`; what is wrong goes to the report, and its key keeps its default.
[[nodiscard]] GroupOptions read_group(TomlReader& group, TomlReport& report);

/// The table with every key written out; reading it gives the same options again.
[[nodiscard]] TomlTable discussion_table(const GroupDiscussion& discussion);
[[nodiscard]] TomlTable group_table(const GroupOptions& group);

}  // namespace kith
