#include "kith/runs/merge.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "kith/core/error.hpp"
#include "kith/files/generation.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sqlite.hpp"
#include "team_list.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostAbsent = 20;  // shards that are named when many are missing

// Everything that prevents the merge; the error is of the worst kind (the last in ErrorKind).
class Complaints {
 public:
  void add(ErrorKind kind, const char* id, const fs::path& folder, const std::string& message, const Advice& advice) {
    diagnostics_.push_back(
        {.id = id, .message = message, .file = folder.string(), .hint = advice.hint, .remedy = advice.remedy});
    kind_ = std::max(kind_, kind);
  }
  void add(const char* id, const fs::path& folder, const std::string& message, const Advice& advice) {
    add(ErrorKind::kInvalidInput, id, folder, message, advice);
  }
  void throw_if_any() const {
    if (diagnostics_.empty()) return;
    std::string text;
    for (const auto& diagnostic : diagnostics_) text += to_text(diagnostic);
    text.pop_back();
    throw Error{kind_, text, diagnostics_};
  }

 private:
  std::vector<Diagnostic> diagnostics_;
  ErrorKind kind_ = ErrorKind::kInvalidInput;
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
                   "run and merge all shards with the same program; others may give different results");
  }
  if (one.shard.count != first.shard.count) {
    complaints.add(
        "E0633", folder,
        "this is shard " + name_of(one.shard) + ", but " + first_in.string() + " is shard " + name_of(first.shard),
        "all shards must have the same number of parts");
  }
}

constexpr const char* kGoOn = "resume it with the command that started it";

// The teams of the shard that the journal neither holds intact nor says to have failed; those of which something is
// there, but damaged, apart.
struct Lacking {
  std::vector<std::size_t> damaged, untaught;
};

Lacking find_lacking(const Journal& journal) {
  Lacking lacking{journal.damaged(), {}};
  std::vector<bool> known = journal.done();
  for (const auto& failure : journal.progress().failures) known[failure.team - 1] = true;
  for (const auto team : lacking.damaged) known[team - 1] = true;
  for (std::size_t team = 1; team <= known.size(); ++team) {
    if (journal.identity().shard.contains(team) && !known[team - 1]) lacking.untaught.push_back(team);
  }
  return lacking;
}

// Checks every record of a shard; what is missing is a complaint, or goes to `missing` if that is given.
void check_complete(const fs::path& folder, Journal& journal, std::vector<std::string>* missing,
                    Complaints& complaints) {
  const auto shard = "shard " + name_of(journal.identity().shard);
  const bool sound = journal.check();
  const auto lacking = find_lacking(journal);
  if (!lacking.damaged.empty() || (!sound && !lacking.untaught.empty())) {
    const auto& teams = lacking.damaged.empty() ? lacking.untaught : lacking.damaged;
    const auto what = "the record" + std::string{teams.size() == 1 ? "" : "s"} + " of " + team_list(teams) + " in " +
                      shard + " cannot be read: the journal is damaged";
    if (missing != nullptr) {
      missing->push_back(what);
    } else {
      complaints.add(ErrorKind::kMismatch, "E0637", folder, what, kGoOn);
    }
  }
  const bool unfinished = (sound && !lacking.untaught.empty()) || !rank_journals(folder).empty();
  if (!unfinished) return;
  const auto what = shard + " is not finished: " + team_list(lacking.untaught) + " of " +
                    std::to_string(journal.progress().total) + " are left";
  if (missing != nullptr) {
    missing->push_back(what);
  } else {
    complaints.add(ErrorKind::kInfeasible, "E0636", folder, what, std::string{"wait for it, or "} + kGoOn);
  }
}

// The journal of a shard, if the folder holds one that belongs to what else it says of itself.
std::optional<Journal> open_shard(const fs::path& folder, Complaints& complaints) {
  if (!Journal::exists(folder / kJournalFile)) {
    complaints.add("E0630", folder, "there is no shard of a study in this folder: it has no study.sqlite",
                   Remedy::kRunShard);
    return std::nullopt;
  }

  settle_for_reading(folder);
  const auto identity = Journal::identify(folder / kJournalFile);
  if (!identity) {
    complaints.add(ErrorKind::kMismatch, "E0637", folder,
                   "the journal is damaged: it does not say to which study it belongs", kGoOn);
    return std::nullopt;
  }

  std::error_code ignored;
  if (fs::exists(folder / kManifestFile, ignored) && published_digest(folder) != identity->inputs.digest()) {
    complaints.add(ErrorKind::kMismatch, "E0638", folder,
                   "its manifest.json does not belong to the study of its journal, or is damaged", kGoOn);
    return std::nullopt;
  }

  try {
    return Journal::read(folder / kJournalFile);
  } catch (const SqliteError& error) {
    if (!error.damaged()) throw;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kIo) throw;
  }
  complaints.add(ErrorKind::kMismatch, "E0637", folder, "the journal is damaged", kGoOn);
  return std::nullopt;
}

}  // namespace

std::vector<fs::path> rank_journals(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator{folder, ignored}) {
    auto file = entry.path();
    if (file.filename().string().rfind(kRankJournalPrefix, 0) != 0) continue;
    if (file.extension() == ".salvaged") file.replace_extension();  // it was about to take its place
    if (file.extension() == ".sqlite") files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

Shards open_shards(std::span<const fs::path> folders, const std::string& program, bool allow_partial) {
  Complaints complaints;
  std::vector<Journal> journals;
  std::vector<fs::path> found;
  for (const auto& folder : folders) {
    auto journal = open_shard(folder, complaints);
    if (!journal) continue;
    journals.push_back(*std::move(journal));
    found.push_back(folder);
  }

  complaints.throw_if_any();
  for (std::size_t i = 0; i < journals.size(); ++i) {
    compare(found[i], journals[i].identity(), journals[0].identity(), found[0], program, complaints);
  }
  complaints.throw_if_any();
  Shards shards;
  auto* missing = allow_partial ? &shards.missing : nullptr;
  const auto count = journals.at(0).identity().shard.count;
  std::map<std::size_t, std::size_t> holders;  // where each shard is, by its index
  for (std::size_t i = 0; i < journals.size(); ++i) {
    const auto shard = journals[i].identity().shard;
    const auto [holder, fresh] = holders.emplace(shard.index, i);
    if (!fresh) {
      complaints.add("E0634", found[i],
                     "this is shard " + name_of(shard) + ", and so is " + found[holder->second].string(),
                     "name every shard once");
    }
    check_complete(found[i], journals[i], missing, complaints);
  }

  std::vector<std::size_t> absent;
  for (std::size_t index = 1; index <= count && absent.size() < kMostAbsent; ++index) {
    if (holders.count(index) == 0) absent.push_back(index);
  }
  for (const auto index : absent) {
    const auto name = "shard " + name_of({index, count});
    if (missing != nullptr) {
      missing->push_back(name + " was not given");
    } else {
      complaints.add(ErrorKind::kInfeasible, "E0635", found[0], name + " of the same study is missing",
                     Advice{"run it, and name its folder too", Remedy::kMergePart});
    }
  }

  complaints.throw_if_any();
  for (const auto& [index, holder] : holders) shards.journals.push_back(std::move(journals[holder]));
  return shards;
}

}  // namespace kith
