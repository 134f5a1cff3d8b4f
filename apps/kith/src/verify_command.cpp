#include <fmt/format.h>

#include <filesystem>

#include "build_facts.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/runs/verify.hpp"
#include "progress.hpp"

namespace kith::cli {

namespace {

struct VerifyCommandOptions {
  std::string folder;
  double sample = 1.0;      ///< Share of the teams to teach again.
  std::size_t threads = 0;  ///< 0: as many as there are cores.
  ProgressMode progress = ProgressMode::kAuto;
};

void declare(OptionList& list, VerifyCommandOptions& options) {
  list.text("folder", options.folder, "DIR", "Run folder").required();
  list.number("--sample", options.sample, "P", {0.0, 1.0, NumberRange::kAbove},
              "Share of the teams to rerun, above 0, at most 1");
  list.threads(options.threads);
  list.progress(options.progress);
}

int run(const VerifyCommandOptions& options, Console& console) {
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
  how.sample = options.sample;
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
  console.print(fmt::format("reran {} of {}, compared {}: all identical\n", result.checked,
                            counted(result.teams, "team"), counted(result.files, "file")));
  return 0;
}

}  // namespace

void add_verify(Commands& commands) {
  commands.add<VerifyCommandOptions>("verify", "Repeat a run from its frozen inputs and compare all bytes",
                                     {"kith verify results/paper", "kith verify results/paper --sample 0.1"}, declare,
                                     run);
}

}  // namespace kith::cli
