#pragma once

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace kith {

/// As many threads as the system grants, at most `wanted`; each runs `body`. May be none.
[[nodiscard]] std::vector<std::jthread> start_threads(std::size_t wanted, const std::function<void()>& body);

}  // namespace kith
