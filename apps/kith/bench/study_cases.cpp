// Whole studies, planning included.
#include <memory>
#include <string>

#include "cases.hpp"
#include "kith/core/error.hpp"
#include "kith/files/temporary_folder.hpp"
#include "kith/runs/study_run.hpp"
#include "kith/study/tables.hpp"

namespace kith::bench {
namespace {

using SharedReading = std::shared_ptr<const StudyReading>;

RunResult in_memory(const StudyReading& reading, std::size_t threads) {
  const Atlas atlas{*reading.domain};
  RunOptions options;
  options.threads = threads;
  return run_teams(atlas, *reading.study, team_addresses(*reading.study), options);
}

std::string tables_of(const StudyReading& reading, std::size_t threads) {
  const auto result = in_memory(reading, threads);
  std::string all;
  write_study_tables(*reading.study, result.teams,
                     [&](std::string_view file, std::string_view piece) { all.append(file).append(piece); });
  return all;
}

Work study_work(const SharedReading& reading, std::size_t threads) {
  return [=](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(in_memory(*reading, threads).teams.size());
  };
}

SharedReading shared(const std::string& name) { return std::make_shared<const StudyReading>(Workbench::study(name)); }

Prepared one_thread(Workbench& /*bench*/) {
  Prepared prepared;
  prepared.work = study_work(shared("paper"), 1);
  return prepared;
}

Prepared all_threads(Workbench& bench, const std::string& study) {
  const auto reading = shared(study);
  const auto threads = bench.threads();
  Prepared prepared;
  prepared.work = study_work(reading, threads);
  prepared.rival = study_work(reading, 1);
  prepared.disagreement = [=]() -> std::string {
    return tables_of(*reading, 1) == tables_of(*reading, threads) ? "" : "the tables differ";
  };
  return prepared;
}

Prepared with_folder(Workbench& bench) {
  const auto reading = shared("paper");
  const auto folder = std::make_shared<const TemporaryFolder>("kith-bench");
  Prepared prepared;
  prepared.work = [=, threads = bench.threads()](std::size_t rounds) {
    for (; rounds > 0; --rounds) {
      StudyRunOptions options;
      options.program = "kith bench";
      options.threads = threads;
      options.resume = Resume::kNever;
      options.replace = true;
      const Atlas atlas{*reading->domain};
      StudyRun run{folder->path() / "run", *reading, options};
      if (!run.teach(atlas) || !run.publish({})) throw Error{ErrorKind::kPartial, "the study was not finished"};
    }
  };
  return prepared;
}

}  // namespace

void add_study_cases(std::vector<Case>& cases) {
  const std::string one = "one thread";
  cases.push_back({"study.one-thread", "the paper's study, 300 teams, planned and taught in memory", "", Clock::kWall,
                   true, one_thread});
  cases.push_back({"study.all-threads", "the same on all threads", one, Clock::kWall, true,
                   [](Workbench& bench) { return all_threads(bench, "paper"); }});
  cases.push_back({"study.folder", "the same on all threads with its run folder: journal, tables, manifest", "",
                   Clock::kWall, true, with_folder});
  cases.push_back({"study.uncalibrated", "the paper's study with 1 000 particles a belief, on all threads", one,
                   Clock::kWall, true, [](Workbench& bench) { return all_threads(bench, "paper-uncalibrated"); }});
}

}  // namespace kith::bench
