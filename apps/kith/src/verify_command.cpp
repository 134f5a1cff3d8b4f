#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "build_facts.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "kith/present/json.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/runs/verify.hpp"
#include "progress.hpp"

namespace kith::cli {

int run_verify(const VerifyCommandOptions& options, Console& console) {
  const std::filesystem::path folder{options.folder};
  auto reading = read_run_folder(folder);
  if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
  if (!Journal::exists(folder / kJournalFile)) {
    throw Error{ErrorKind::kIo,
                options.folder + " has no journal (" + kJournalFile + "); rerun the study to create one"};
  }
  watch_signals();
  Progress progress{options.progress, console};
  VerifyOptions how;
  how.sample = std::strtod(options.sample.c_str(), nullptr);
  how.threads = options.threads;
  how.on_progress = [&](std::size_t done, std::size_t total, std::size_t failed) {
    progress.update(done, total, failed);
  };
  how.stopped = [] { return stop_signal() != 0; };
  const auto result = verify_run(folder, reading, Atlas{*reading.domain}, how);
  progress.finish();
  if (result.program != program_name()) {
    console.warning("the run is by kith " + result.program + ", and this is " + program_name());
  }
  if (!result.mismatches.empty()) {
    throw Error{ErrorKind::kMismatch, counted(result.mismatches.size(), "mismatch"), result.mismatches};
  }
  if (result.stopped) {
    throw Error{ErrorKind::kPartial, fmt::format("interrupted after {} teams, all identical", result.checked)};
  }
  if (console.json()) {
    console.print_json(Json{{"schema", "kith.verify/1"},
                            {"teams", result.teams},
                            {"checked", result.checked},
                            {"files", result.files},
                            {"program", result.program}});
    return 0;
  }
  console.print(fmt::format("reran {} of {}, compared {}: all identical\n", result.checked,
                            counted(result.teams, "team"), counted(result.files, "file")));
  return 0;
}

}  // namespace kith::cli
