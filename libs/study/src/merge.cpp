#include "kith/study/merge.hpp"

#include <algorithm>
#include <optional>

#include "kith/core/error.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

class Complaints {
 public:
  void add(const char* id, const fs::path& folder, const std::string& message, const std::string& hint) {
    diagnostics_.push_back({.id = id, .message = message, .file = folder.string(), .hint = hint});
  }
  void throw_if_any() const {
    if (!diagnostics_.empty()) throw Error{diagnostics_};
  }

 private:
  std::vector<Diagnostic> diagnostics_;
};

std::string name_of(const Shard& shard) { return std::to_string(shard.index) + "/" + std::to_string(shard.count); }

// What keeps one shard from being put together with the first one.
void compare(const fs::path& folder, const JournalIdentity& one, const JournalIdentity& first, const fs::path& first_in,
             const std::string& program, Complaints& complaints) {
  if (one.inputs != first.inputs || one.teams != first.teams) {
    complaints.add("E0631", folder, "this is a shard of another study than " + first_in.string(),
                   "compare their inputs/study.toml");
  }
  if (one.program != program) {
    complaints.add("E0632", folder, "this shard was run by kith " + one.program + ", and this is " + program,
                   "run and merge all shards with one program: another one may give other results");
  }
  if (one.shard.count != first.shard.count) {
    complaints.add(
        "E0633", folder,
        "this is shard " + name_of(one.shard) + ", but " + first_in.string() + " is shard " + name_of(first.shard),
        "all shards must be parts of the same number");
  }
}

void check_finished(const fs::path& folder, const Journal& journal, Complaints& complaints) {
  const auto progress = journal.progress();
  const auto tried = progress.done + progress.failures.size();
  if (tried >= progress.total && rank_journals(folder).empty()) return;
  complaints.add("E0636", folder,
                 "shard " + name_of(journal.identity().shard) +
                     " is not finished: " + std::to_string(progress.total - std::min(tried, progress.total)) + " of " +
                     std::to_string(progress.total) + " teams are left",
                 "wait for it, or go on with it by the command that began it");
}

}  // namespace

std::vector<fs::path> rank_journals(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator{folder, ignored}) {
    const auto name = entry.path().filename().string();
    if (name.rfind(kRankJournalPrefix, 0) == 0 && entry.path().extension() == ".sqlite") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Journal> open_shards(std::span<const fs::path> folders, const std::string& program) {
  Complaints complaints;
  std::vector<Journal> journals;
  std::vector<fs::path> found;
  for (const auto& folder : folders) {
    std::error_code ignored;
    if (!fs::exists(folder / kJournalFile, ignored)) {
      complaints.add("E0630", folder, "there is no shard of a study in this folder: it has no study.sqlite",
                     "make one with: kith study STUDY --shard I/N -o DIR");
      continue;
    }
    journals.push_back(Journal::read(folder / kJournalFile));
    found.push_back(folder);
  }
  complaints.throw_if_any();
  for (std::size_t i = 0; i < journals.size(); ++i) {
    compare(found[i], journals[i].identity(), journals[0].identity(), found[0], program, complaints);
  }
  complaints.throw_if_any();
  const auto count = journals.at(0).identity().shard.count;
  std::vector<std::optional<std::size_t>> holders(count);
  for (std::size_t i = 0; i < journals.size(); ++i) {
    const auto shard = journals[i].identity().shard;
    auto& holder = holders.at(shard.index - 1);
    if (holder) {
      complaints.add("E0634", found[i], "this is shard " + name_of(shard) + ", and so is " + found[*holder].string(),
                     "name every shard once");
    }
    holder = i;
    check_finished(found[i], journals[i], complaints);
  }
  for (std::size_t index = 1; index <= count; ++index) {
    if (holders[index - 1]) continue;
    complaints.add("E0635", found[0], "shard " + name_of({index, count}) + " of the same study is missing",
                   "run it, and name its folder too");
  }
  complaints.throw_if_any();
  std::vector<Journal> ordered;
  for (const auto& holder : holders) ordered.push_back(std::move(journals[*holder]));
  return ordered;
}

}  // namespace kith
