#include "kith/runs/verify.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "kith/core/error.hpp"
#include "kith/core/stream.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/study_run.hpp"
#include "kith/runs/team_codec.hpp"
#include "manifest.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Diagnostic mismatch(const char* id, const fs::path& file, std::string message, std::string hint) {
  return {.id = id, .message = std::move(message), .file = file.string(), .hint = std::move(hint)};
}

std::string hash_of_file(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) ? sha256(read_file(file)) : std::string{};
}

// What the manifest says of the run; nothing without one.
struct Manifest {
  std::map<std::string, std::string> files;  // hashes by place in the folder
  bool partial = false;
  std::string shard;  // such as "2/3"; empty for a whole study
};

std::optional<Manifest> read_manifest(const fs::path& folder, const std::string& digest, Verification& result) {
  const auto path = folder / kManifestFile;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {  // not finished
    if (fs::exists(folder / "tables", ignored)) {
      result.mismatches.push_back(mismatch("E0641", folder / "tables",
                                           "there are tables, but no manifest.json that describes them",
                                           "rerun the command that ran the study to rewrite them"));
    }
    return std::nullopt;
  }
  const auto text = read_file(path);
  if (fact_in_manifest(text, "run") != digest) {
    result.mismatches.push_back(mismatch("E0641", path,
                                         "this is not the manifest of the run, or it was changed after it was written",
                                         "rerun the command that ran the study"));
    return std::nullopt;
  }

  const auto document = Json::parse(text);
  Manifest manifest;
  manifest.partial = document.contains("missing");
  manifest.shard = document.value("shard", "");
  for (const auto* group : {"inputs", "tables"}) {
    for (const auto& [name, hash] : document.at(group).items())
      manifest.files[std::string{group} + "/" + name] = hash.get<std::string>();
  }
  return manifest;
}

void check_files(const fs::path& folder, const std::map<std::string, std::string>& named, Verification& result) {
  for (const auto& [name, hash] : named) {
    ++result.files;
    if (hash_of_file(folder / name) == hash) continue;
    result.mismatches.push_back(mismatch(
        "E0641", folder / name, "the file is not the one that the run wrote: its hash is not that in manifest.json",
        "rerun the command that ran the study"));
  }
}

// Whether the tables that the manifest names are those that the teams in the journal give.
void check_tables(const fs::path& folder, const Study& study, const Journal& journal,
                  const std::map<std::string, std::string>& named, Verification& result) {
  std::map<std::string, Sha256, std::less<>> hashes;
  write_study_tables(study, teams_of(study, journal), [&](std::string_view file, std::string_view piece) {
    auto found = hashes.find(file);
    if (found == hashes.end()) found = hashes.emplace(file, Sha256{}).first;
    found->second.update(piece);
  });
  for (auto& [file, hash] : hashes) {
    const auto found = named.find("tables/" + file);
    if (found != named.end() && std::move(hash).hex() == found->second) continue;
    result.mismatches.push_back(mismatch("E0642", folder / "tables" / file,
                                         "the table that the manifest names does not match the journal",
                                         "rerun the command that ran the study"));
  }
}

// Whether every team of the study, or of the shard, is in the journal or failed.
void check_complete(const Journal& journal, const Study& study, Verification& result) {
  auto known = journal.done();
  for (const auto& failure : journal.progress().failures) known[failure.team - 1] = true;
  for (const auto team : journal.damaged()) known[team - 1] = true;  // there is a mismatch of its own for it
  for (std::size_t team = 1; team <= known.size(); ++team) {
    if (known[team - 1] || !journal.identity().shard.contains(team)) continue;
    result.mismatches.push_back(
        mismatch("E0644", journal.path(),
                 describe_team(study, team_address(study, team)) + " is missing although the run is marked as finished",
                 "rerun the command that ran the study"));
  }
}

// The teams in the journal, and those of them to teach again: the first of a random order that depends on nothing else.
std::vector<std::uint32_t> choose(const Journal& journal, double share, const Study& study, Verification& result) {
  std::vector<std::uint32_t> teams;
  for (std::size_t team = 1; team <= journal.identity().teams; ++team) {
    const auto bytes = journal.find(team);
    if (!bytes) continue;
    ++result.teams;
    if (is_intact(team, *bytes, journal.key())) {
      teams.push_back(static_cast<std::uint32_t>(team));
    } else {
      result.mismatches.push_back(mismatch(
          "E0643", journal.path(), "the record of " + describe_team(study, team_address(study, team)) + " is damaged",
          "rerun the command that ran the study"));
    }
  }
  const auto n = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(share * static_cast<double>(teams.size()))),
                                         std::min<std::size_t>(1, teams.size()), teams.size());
  RandomStream random{stream_tag("verify")};
  for (std::size_t i = 0; i < n; ++i) std::swap(teams[i], teams[i + random() % (teams.size() - i)]);
  teams.resize(n);
  std::sort(teams.begin(), teams.end());
  return teams;
}

}  // namespace

Verification verify_run(const fs::path& folder, const StudyReading& reading, const Atlas& atlas,
                        const VerifyOptions& options) {
  const auto& study = reading.study.value();
  auto journal = Journal::read(folder / kJournalFile);
  Verification result;
  result.program = journal.identity().program;
  const auto inputs = freeze(reading);
  if (journal.identity().inputs != inputs || journal.identity().teams != num_teams(study)) {
    throw Error{ErrorKind::kIo, folder.string() +
                                    " holds the results of one study and the journal of another, unfinished "
                                    "one; finish that first"};
  }
  if (!journal.check()) {
    result.mismatches.push_back(
        mismatch("E0643", journal.path(), "the file is damaged", "rerun the command that ran the study"));
  }
  const auto manifest = read_manifest(folder, inputs.digest(), result);
  if (manifest) check_files(folder, manifest->files, result);
  if (manifest && !manifest->partial) check_complete(journal, study, result);
  const auto teams = choose(journal, options.sample, study, result);
  const auto& shard = journal.identity().shard;
  const bool is_shard = shard.count > 1;  // which has no tables
  const auto name = is_shard ? std::to_string(shard.index) + "/" + std::to_string(shard.count) : std::string{};
  if (manifest && manifest->shard != name) {
    result.mismatches.push_back(mismatch("E0644", journal.path(),
                                         "the journal holds " + (is_shard ? "shard " + name : "the whole study") +
                                             ", but the manifest is about " +
                                             (manifest->shard.empty() ? "the whole study" : "shard " + manifest->shard),
                                         "rerun the command that ran the study"));
  }
  if (manifest && !is_shard && result.mismatches.empty()) check_tables(folder, study, journal, manifest->files, result);

  std::mutex mutex;
  StreamOptions stream;
  stream.threads = options.threads;
  stream.stopped = options.stopped;
  stream_teams(atlas, study, teams, stream, [&](TeamOutcome outcome) {
    const auto team = outcome.address.team;
    const auto bytes = outcome.record ? encode_team(*outcome.record, journal.key()) : std::string{};
    const std::lock_guard lock{mutex};
    ++result.checked;
    // Records of earlier programs have an earlier layout.
    const auto stored = journal.find(team);
    const auto kept = stored ? decode_team(outcome.address, *stored, journal.key()) : std::nullopt;
    if (!kept || bytes != encode_team(*kept, journal.key())) {
      result.mismatches.push_back(mismatch("E0640", journal.path(),
                                           describe_team(study, outcome.address) + " does not come out the same again",
                                           "the program differs or this machine is faulty; run kith doctor"));
    }
    if (options.on_progress) options.on_progress(result.checked, teams.size(), 0);
  });
  result.stopped = options.stopped && options.stopped();
  std::sort(result.mismatches.begin(), result.mismatches.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.id, a.file, a.message) < std::tie(b.id, b.file, b.message);
  });
  return result;
}

}  // namespace kith
