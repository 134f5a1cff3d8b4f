#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "build_facts.hpp"
#include "command.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/runs/merge.hpp"
#include "kith/runs/study_run.hpp"
#include "run_outcome.hpp"

namespace kith::cli {

namespace {

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out;
  bool yes = false;            ///< Replace the results of a different study.
  bool allow_partial = false;  ///< Leave out what is missing or damaged, and say so.
};

void declare(OptionList& list, MergeOptions& options) {
  list.texts("folders", options.folders, "DIR", "Run folders of all shards, in any order").required();
  list.text("-o,--out", options.out, "DIR", "Run folder to create or to update");
  list.flag("--yes", options.yes, "Replace the results of a different study in the run folder");
  list.flag("--allow-partial", options.allow_partial,
            "Merge what can be read where shards or teams are missing; the manifest and reports say what is left out, "
            "and the exit code is 6");
  list.json();
}

int run(const MergeOptions& options, Console& console) {
  if (options.out.empty()) refuse("kith merge needs -o DIR, the folder for the results");
  RunPlace place{options.out, std::chrono::steady_clock::now()};
  auto facts = facts_of_build();
  facts.started = utc_now();
  const std::vector<std::filesystem::path> folders{options.folders.begin(), options.folders.end()};
  for (const auto& folder : folders) {
    std::error_code ignored;
    if (std::filesystem::equivalent(folder, options.out, ignored)) {
      refuse("kith merge cannot write to " + options.out + ", which is one of the shards");
    }
  }
  const auto shards = open_shards(folders, program_name(), options.allow_partial);
  auto reading = read_run_folder(folders.front());
  if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
  if (freeze(reading) != shards.journals.front().identity().inputs) {
    throw Error{ErrorKind::kMismatch, folders.front().string() + ": its inputs do not match its journal"};
  }
  place.num_features = reading.domain->num_features();
  StudyRunOptions how;
  how.program = program_name();
  how.replace = options.yes;
  how.rebuild = true;
  StudyRun run{options.out, std::move(reading), std::move(how)};
  for (const auto& shard : shards.journals) run.take_up(shard);
  facts.missing = shards.missing;
  for (const auto& what : shards.missing) console.warning("left out: " + what);
  facts.domain = published_fact(folders.front(), "domain").value_or(run.study().variants.front().domain);
  for (const auto& note : run.notes()) console.warning(note);
  const auto text =
      fmt::format("merged {} of {}", counted(shards.journals.size(), "shard"), counted(run.num_teams(), "team"));
  facts.log.push_back(utc_now() + " " + text);
  console.detail(text);
  return publish_run(run, std::move(facts), place, console);
}

}  // namespace

void add_merge(Commands& commands) {
  commands.add<MergeOptions>(
      "merge", "Merge the shards of a study and write its tables",
      {"kith merge results/part-* -o results/paper", "kith merge part-1 part-2 part-3 -o paper --json"}, declare, run);
}

}  // namespace kith::cli
