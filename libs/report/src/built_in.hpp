#pragma once

#include <string_view>

namespace kith::detail {

// docs/references.bib, embedded when kith was built.
extern const std::string_view kReferencesText;

}  // namespace kith::detail
