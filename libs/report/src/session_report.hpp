#pragma once

#include <filesystem>

#include "kith/report/report.hpp"
#include "run_files.hpp"

namespace kith::detail {

// The document about live sessions, from an export of their tables. It has the parts of a report that can be known of
// people: their answers, how long they were taught, and what the teacher estimated; nothing about what they believed.
// @throws kith::Error as read_session_tables().
[[nodiscard]] Json session_report(const std::filesystem::path& folder, const ReportOptions& options);

}  // namespace kith::detail
