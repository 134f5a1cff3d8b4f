#include "run_outcome.hpp"

#include "exit_codes.hpp"

#include <fmt/format.h>

#include "build_facts.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "study_summary.hpp"

namespace kith::cli {

void report_failures(const Study& study, const std::vector<TeamFailure>& failures, Console& console) {
  for (const auto& [team, message] : failures) {
    console.warning(describe_team(study, team_address(study, team)) + " failed: " + message);
  }
  if (!failures.empty()) console.warning(counted(failures.size(), "team") + " failed; rerun the command to retry them");
}

int publish_run(StudyRun& run, RunFacts facts, const RunPlace& place, Console& console) {
  facts.stopped = utc_now();
  const bool partial = !facts.missing.empty();
  const auto summary = run.publish(std::move(facts));
  if (!summary) return 0;  // another process does it
  const int code = run.failures().empty() && !partial ? 0 : exit_code(ErrorKind::kPartial);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - place.begin).count();
  report_failures(run.study(), run.failures(), console);
  std::vector<std::string> failed;
  for (const auto& [team, message] : run.failures()) {
    failed.push_back(describe_team(run.study(), team_address(run.study(), team)) + ": " + message);
  }
  console.print([&] { return summary_json(run.study(), *summary, run.num_done(), failed, seconds); },
                [&] { return summary_table(run.study(), place.num_features, *summary, console); });
  if (console.json()) return code;
  console.info(fmt::format("{} in {:.2f} s; tables in {}/tables, columns in codebook.json",
                           counted(run.num_done(), "team"), seconds, place.folder));
  return code;
}

}  // namespace kith::cli
