#pragma once

#include <string_view>

namespace kith::detail {

// docs/errors*.md, one after the other, embedded when kith was built.
extern const std::string_view kErrorPages;

}  // namespace kith::detail
