#pragma once

#include <string>

#include "kith/domains/domain.hpp"

namespace kith::detail {

// The words of [words] for more than once, by rule: "a step on the path" -> "{n} steps on the path",
// "crossing a blue tile" -> "crossing {n} blue tiles", "crossing rubble" -> "crossing rubble {n} times".
[[nodiscard]] std::string several_by_rule(const std::string& once);

// Fills in what the file leaves out.
[[nodiscard]] Wording completed(Wording wording);

}  // namespace kith::detail
