#include "page.hpp"

#include <fmt/format.h>

#include "command.hpp"
#include "embedded.hpp"
#include "kith/core/error.hpp"
#include "kith/report/report.hpp"

namespace kith::cli {

std::string page_with(const std::string& document, std::string_view page) {
  if (page.empty()) {
    throw Error{ErrorKind::kInfeasible, "this program was built without pages for browsers",
                "install Node.js and npm and build it again, or use --json"};
  }
  return render_report(document, page);
}

void require_engine() {
  if (!detail::kLessonFilePage.empty()) return;
  throw Error{ErrorKind::kInfeasible, "this kith was built without the engine of lesson files",
              "build it with './run.sh --lesson', which says what it installs"};
}

std::string page_with_engine(std::string_view page) {
  constexpr std::string_view kFirst = "<script type=\"application/x-lzma\"",
                             kDocument = "<script type=\"application/json\"";
  constexpr std::string_view kStyles = "; style-src";
  const auto begin = detail::kLessonFilePage.find(kFirst);
  const auto parts = detail::kLessonFilePage.substr(begin, detail::kLessonFilePage.find(kDocument) - begin);
  std::string whole{page};
  whole.insert(whole.find(kDocument), parts);
  whole.insert(whole.find(kStyles), " 'wasm-unsafe-eval' blob:; worker-src blob:");
  return whole;
}

void write_page(std::string_view what, const std::string& page, const std::string& out, Console& console,
                OldLink link) {
  if (out == "-") {
    if (console.json()) refuse("--json and '-o -' would both write to standard output");
    console.print(page);
    return;
  }
  const auto extension = std::filesystem::path{out}.extension();
  if (!extension.empty() && extension != ".html" && extension != ".htm") {
    refuse(fmt::format("the {} is a page, not a file '*{}'", what, extension.string()), "name a file.html with -o");
  }
  write_file_atomically(out, page, FolderSync::kNow, link);
  constexpr double kKilobyte = 1e3;
  console.info(fmt::format("{} in {} ({:.0f} kB); open it in a browser (no network needed)", what, out,
                           static_cast<double>(page.size()) / kKilobyte));
}

void require_replaceable(const std::filesystem::path& file, bool may_replace) {
  std::error_code ignored;
  if (may_replace || !std::filesystem::is_regular_file(file, ignored)) return;
  refuse(file.string() + " exists; choose another name, or add --yes to replace it");
}

}  // namespace kith::cli
