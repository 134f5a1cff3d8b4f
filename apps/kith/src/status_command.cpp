#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/generation.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/run_folder.hpp"
#include "progress.hpp"

namespace kith::cli {
namespace {

struct StatusOptions {
  std::string folder;
};

// How far a run is, its ranks together.
struct Status {
  std::string state;  // "running", "finished", "failed" or "interrupted"
  Shard shard;
  std::string program;
  std::size_t total = 0, done = 0, left = 0;
  std::vector<TeamFailure> failures;
  double rate = 0.0;  // teams per second in the last session; 0 if unknown
};

void add_rank(Status& status, JournalProgress& all, const std::filesystem::path& file) {
  const auto part = Journal::read(file).progress();
  status.done += part.done;
  status.failures.insert(status.failures.end(), part.failures.begin(), part.failures.end());
  all.session_teams += part.session_teams;
  all.last_write = std::max(all.last_write, part.last_write);
}

Status status_of(const std::filesystem::path& folder) {
  const auto file = folder / kJournalFile;
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) {
    throw Error{ErrorKind::kIo, error ? "cannot read " + folder.string() + ": " + error.message()
                                      : "there is no folder " + folder.string()};
  }
  if (!Journal::exists(file)) {
    throw Error{ErrorKind::kIo, folder.string() + " is not the folder of a run: it has no " + kJournalFile};
  }
  const bool busy = is_busy(folder);
  if (!busy) settle_for_reading(folder);
  const auto journal = Journal::read(file);
  auto progress = journal.progress();
  Status status;
  status.shard = journal.identity().shard;
  status.program = journal.identity().program;
  status.total = progress.total;
  status.done = progress.done;
  status.failures = progress.failures;
  for (const auto& part : rank_journals(folder)) add_rank(status, progress, part);
  status.left = status.total - std::min(status.total, status.done + status.failures.size());
  const double seconds = progress.last_write - progress.started;
  if (progress.session_teams > 0 && seconds > 0.0) status.rate = static_cast<double>(progress.session_teams) / seconds;
  const bool published = published_digest(folder) == journal.identity().inputs.digest();
  status.state = busy                      ? "running"
                 : status.left > 0         ? "interrupted"
                 : !published              ? "interrupted"
                 : status.failures.empty() ? "finished"
                                           : "failed";
  return status;
}

Json status_json(const Status& status, std::optional<double> seconds_left) {
  Json failures = Json::array();
  for (const auto& [team, message] : status.failures) failures.push_back({{"team", team}, {"message", message}});
  return {{"schema", "kith.status/1"},
          {"state", status.state},
          {"total", status.total},
          {"done", status.done},
          {"failed", status.failures.size()},
          {"left", status.left},
          {"rate", status.rate > 0.0 ? Json(status.rate) : Json{}},
          {"eta_s", seconds_left ? Json(*seconds_left) : Json{}},
          {"shard", {{"index", status.shard.index}, {"count", status.shard.count}}},
          {"program", status.program},
          {"failures", failures}};
}

void declare(OptionList& list, StatusOptions& options) {
  list.text("folder", options.folder, "DIR", "Run folder, also while the study is running").required();
  list.json();
}

int run(const StatusOptions& options, Console& console) {
  const auto status = status_of(options.folder);
  std::optional<double> seconds_left;
  if (status.state == "running" && status.rate > 0.0) seconds_left = static_cast<double>(status.left) / status.rate;
  if (console.json()) {
    console.print_json(status_json(status, seconds_left));
    return 0;
  }
  std::string text = fmt::format("{}: {} of {} done", status.state, status.done, counted(status.total, "team"));
  if (!status.failures.empty()) text += fmt::format(", {} failed", status.failures.size());
  if (status.left > 0) text += fmt::format(", {} left", status.left);
  if (status.shard.count > 1) text += fmt::format(" (shard {}/{})", status.shard.index, status.shard.count);
  if (status.rate > 0.0) text += fmt::format("\n{:.0f} teams a second", status.rate);
  if (seconds_left) text += ", about " + clock_text(*seconds_left) + " left";
  if (status.state == "interrupted") text += "\nto resume it, run the same command again";
  console.print(text + "\n");
  for (const auto& [team, message] : status.failures) console.print(fmt::format("team {} failed: {}\n", team, message));
  return 0;
}

}  // namespace

void add_status(Commands& commands) {
  commands.add<StatusOptions>("status", "Show the progress of a study: teams done, failed and left",
                              {"kith status results/paper", "watch -n 5 kith status results/paper"}, declare, run);
}

}  // namespace kith::cli
