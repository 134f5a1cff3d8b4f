#pragma once

#include <string_view>

namespace kith::detail {

// docs/errors.md, embedded when kith was built.
extern const std::string_view kErrorPage;

}  // namespace kith::detail
