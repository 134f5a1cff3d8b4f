#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "console.hpp"
#include "kith/files/atomic_file.hpp"

namespace kith::cli {

/// The page that shows a JSON document.
/// @param page  kReportPage, kLessonPage or kAuditPage. @throws kith::Error (kInfeasible) if kith was built without
/// pages.
[[nodiscard]] std::string page_with(const std::string& document, std::string_view page);

/// @throws kith::Error (kInfeasible) if kith was built without the engine of lesson files.
void require_engine();
/// The page with the engine of lesson files in it, which its policy allows. @pre require_engine()
[[nodiscard]] std::string page_with_engine(std::string_view page);

/// Writes a page to a file and says so, or prints it if `out` is "-".
/// @param what  What the page is, for the message: "report". @param link  What to do if `out` is a link.
/// @throws kith::Error (kUsage) if `out` is "-" and standard output is for JSON; (kIo) if the file cannot be written.
void write_page(std::string_view what, const std::string& page, const std::string& out, Console& console,
                OldLink link = OldLink::kFollow);

/// @throws kith::Error (kUsage) if the file is there and may not be replaced.
void require_replaceable(const std::filesystem::path& file, bool may_replace);

}  // namespace kith::cli
