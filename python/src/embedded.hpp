#pragma once

#include <string_view>

namespace kith::detail {

// The page that shows a report, made from web/; empty if kith was built without pages.
extern const std::string_view kReportPage;

}  // namespace kith::detail
