#pragma once

#include <string_view>

// Texts of the files in studies/, embedded when kith is built.
namespace kith::detail {
extern const std::string_view kPaperText;
extern const std::string_view kPaperUncalibratedText;
extern const std::string_view kQuickText;
}  // namespace kith::detail
