#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "commands.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/report/report.hpp"
#include "page.hpp"
#include "report_page.hpp"

namespace kith::cli {
namespace {

// Tells people who wait what is being done: every step once, from the third second on.
class Steps {
 public:
  explicit Steps(Console& console) : console_{console} {}

  void show(std::string_view step) {
    constexpr std::chrono::seconds kPatience{2};
    if (step == shown_ || std::chrono::steady_clock::now() - begin_ < kPatience) return;
    shown_ = step;
    console_.info(fmt::format("{} ...", step));
  }

 private:
  Console& console_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::string shown_;
};

}  // namespace

int run_report(const ReportCommandOptions& options, Console& console) {
  Steps steps{console};
  ReportOptions report;
  report.on_step = [&](std::string_view step) { steps.show(step); };
  const auto document = build_report(options.folder, report);
  if (console.json()) {
    console.print(document + "\n");
    return 0;
  }
  const auto page = page_with(document, detail::kReportPage);
  if (options.out == "-") {
    console.print(page);
    return 0;
  }
  const bool is_ours = options.out.empty();  // a link that lies in the folder was not named by anybody
  const auto file =
      is_ours ? std::filesystem::path{options.folder} / "report.html" : std::filesystem::path{options.out};
  write_file_atomically(file, page, FolderSync::kNow, is_ours ? OldLink::kReplace : OldLink::kFollow);
  constexpr double kMegabyte = 1e6;
  console.info(fmt::format("report in {} ({:.1f} MB); open it in a browser, it needs no network", file.string(),
                           static_cast<double>(page.size()) / kMegabyte));
  return 0;
}

}  // namespace kith::cli
