#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace kith {

// "team 3" or "teams 3, 7-9, 12" of ascending numbers; of very many only the first ones.
[[nodiscard]] std::string team_list(std::span<const std::size_t> teams);

}  // namespace kith
