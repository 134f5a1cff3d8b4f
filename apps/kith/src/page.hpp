#pragma once

#include <string>
#include <string_view>

namespace kith::cli {

/// The page that shows a JSON document.
/// @param page  kReportPage or kLessonPage. @throws kith::Error (kInfeasible) if kith was built without pages.
[[nodiscard]] std::string page_with(const std::string& document, std::string_view page);

}  // namespace kith::cli
