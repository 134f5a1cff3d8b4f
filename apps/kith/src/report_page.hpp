#pragma once

#include <string_view>

namespace kith::detail {

// The page that shows a report, made from web/ and embedded when kith was built.
extern const std::string_view kReportPage;

}  // namespace kith::detail
