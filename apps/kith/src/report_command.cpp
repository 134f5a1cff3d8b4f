#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "analysis_in_r.hpp"
#include "command.hpp"
#include "embedded.hpp"
#include "kith/core/error.hpp"
#include "kith/live/room.hpp"
#include "kith/report/report.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/store/session_study.hpp"
#include "kith/teaching/strategy.hpp"
#include "page.hpp"

namespace kith::cli {
namespace {

struct ReportCommandOptions {
  std::string folder;
  std::string out;    ///< "-" is standard output; empty: report.html in the folder.
  bool runs = false;  ///< With the engine, to teach teams again.
};

// What the page needs to teach the teams that it lists: {"inputs", "teams": {number: the setup of a room of simulated
// people}}.
Json taught_again(const std::string& folder, const Json& report) {
  if (!report.contains("lessons")) {
    throw Error{ErrorKind::kInfeasible, "--run teaches simulated teams again, and this report lists no lessons of any",
                "leave --run out"};
  }
  const auto reading = read_run_folder(folder);
  if (!reading.study) throw Error{reading.diagnostics};
  if (reading.study->variants.size() != 1) {
    throw Error{ErrorKind::kInfeasible, "--run cannot teach teams of a study with varied keys again",
                "leave --run out; 'kith teach --from' replays any team"};
  }
  const auto addresses = team_addresses(*reading.study);
  Json teams = Json::object();
  for (const auto& team : report.at("lessons").at("teams")) {
    const auto number = team.at("team").get<std::size_t>();
    const auto& address = addresses.at(number - 1);
    if (address.strategy == kBaseline && address.composition.size() > 1) continue;  // a session per member, no room
    const RoomSetup setup{.id = "team " + std::to_string(number),
                          .strategy = address.strategy,
                          .composition = address.composition,
                          .simulated = std::vector<bool>(address.composition.size(), true),
                          .replicate = address.replicate};
    teams[std::to_string(number)] = to_json(setup);
  }
  return {{"inputs", make_session_study(reading).inputs}, {"teams", std::move(teams)}};
}

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
  list.text("-o,--out", options.out, "FILE", "Page to write (default: report.html in DIR); '-' is standard output");
  list.flag("--run", options.runs,
            "With the engine of lesson files (850 kB more): teams can be taught again in the page");
  list.json();
}

int run(const ReportCommandOptions& options, Console& console) {
  Steps steps{console};
  ReportOptions report;
  report.test_model = [](const Dataset& data, const ModelQuestion& question) {
    return analyze_in_r_or_alone(data, question, {});
  };
  report.on_step = [&](std::string_view step) { steps.show(step); };
  auto document = build_report(options.folder, report);
  if (options.runs) {
    require_engine();
    auto json = Json::parse(document);
    json["again"] = taught_again(options.folder, json);
    document = json.dump(-1, ' ', true);
  }
  if (console.json()) {
    console.print(document + "\n");
    return 0;
  }
  const auto page = page_with(document, options.runs ? page_with_engine(detail::kReportPage) : detail::kReportPage);
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
                                     {"kith report results/paper", "kith report results/paper -o paper.html",
                                      "kith report results/quick --run -o quick.html"},
                                     declare, run);
}

}  // namespace kith::cli
