#include <fmt/format.h>

#include <chrono>

#include "command.hpp"
#include "embedded.hpp"
#include "kith/report/report.hpp"
#include "page.hpp"

namespace kith::cli {
namespace {

struct ReportCommandOptions {
  std::string folder;
  std::string out;  ///< "-" is standard output; empty: report.html in the folder.
};

// Tells people who wait what is being done: every step once, from the third second on.
class Steps {
 public:
  explicit Steps(Console& console) : console_{console} {}

  void show(std::string_view step) {
    constexpr std::chrono::seconds kBeforeProgress{2};
    if (step == shown_ || std::chrono::steady_clock::now() - begin_ < kBeforeProgress) return;
    shown_ = step;
    console_.info(fmt::format("{} ...", step));
  }

 private:
  Console& console_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::string shown_;
};

void declare(OptionList& list, ReportCommandOptions& options) {
  list.text("folder", options.folder, "DIR", "Run folder").required();
  list.text("-o,--out", options.out, "FILE", "Page to write (default: report.html in DIR); '-' is stdout");
  list.json();
}

int run(const ReportCommandOptions& options, Console& console) {
  Steps steps{console};
  ReportOptions report;
  report.on_step = [&](std::string_view step) { steps.show(step); };
  const auto document = build_report(options.folder, report);
  if (console.json()) {
    console.print(document + "\n");
    return 0;
  }
  const auto page = page_with(document, detail::kReportPage);
  if (!options.out.empty()) {
    write_page("report", page, options.out, console);
  } else {  // a link in the folder was not named by anybody
    write_page("report", page, options.folder + "/report.html", console, OldLink::kReplace);
  }
  return 0;
}

}  // namespace

void add_report(Commands& commands) {
  commands.add<ReportCommandOptions>("report", "Write a run's figures, tests and methods as one web page",
                                     {"kith report results/paper", "kith report results/paper -o paper.html"}, declare,
                                     run);
}

}  // namespace kith::cli
