#pragma once

#include <span>
#include <string_view>

#include "kith/core/parameter.hpp"

namespace kith {

/// The keys of the table "teacher", "stop", "pace" or "record" of study files, by which they are read, written and
/// explained. Other tables have none here. Words are those of built-in kinds.
[[nodiscard]] std::span<const Parameter> study_keys(std::string_view table);

}  // namespace kith
