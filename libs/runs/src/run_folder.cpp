#include "kith/runs/run_folder.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <system_error>

#include "extend.hpp"
#include "journal_file.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"
#include "kith/runs/journal.hpp"
#include "manifest.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrozenDomain = "domain.toml";

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw Error{ErrorKind::kIo, "cannot make the folder " + path.string() + ": " + error.message()};
}

// A file's text, or nothing if there is no such file.
std::optional<std::string> text_if_any(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  return read_file(path);
}

// Whose journal it is, if that can be told.
std::optional<JournalIdentity> identity_if_any(const fs::path& journal) try {
  return Journal::identify(journal);
} catch (const Error&) {  // for whoever opens it to say
  return std::nullopt;
}

// The inputs that a folder holds, as far as they are named like those.
RunInputs frozen_inputs(const fs::path& path, const std::vector<InputFile>& files) {
  RunInputs frozen{text_if_any(path / "inputs" / "study.toml").value_or(""),
                   text_if_any(path / "inputs" / kFrozenDomain).value_or(""),
                   {}};
  for (const auto& file : files) {
    const auto text = text_if_any(path / "inputs" / file.name).value_or("");
    frozen.files.push_back({file.name, sha256(text), text});
  }
  return frozen;
}

// What write_tables() leaves behind.
struct WrittenTables {
  std::map<std::string, std::string> hashes;  // by name
  std::size_t teams = 0;
};

// The tables and the codebook, in `folder`.
WrittenTables write_tables(const fs::path& folder, const Study& study, const std::string& run,
                           const TeamSource& teams) {
  struct Table {
    explicit Table(const fs::path& path) : file{path} {}
    AtomicFile file;
    Sha256 hash;
  };
  make_folder(folder);
  WrittenTables written;
  std::map<std::string, std::unique_ptr<Table>, std::less<>> tables;
  const TeamSource counted = [&](const std::function<void(const TeamRecord& team)>& visit) {
    teams([&](const TeamRecord& team) {
      ++written.teams;
      visit(team);
    });
  };
  write_study_tables(study, counted, [&](std::string_view name, std::string_view piece) {
    auto found = tables.find(name);
    if (found == tables.end()) found = tables.emplace(name, std::make_unique<Table>(folder / name)).first;
    found->second->file.write(piece);
    found->second->hash.update(piece);
  });
  for (auto& [name, table] : tables) {
    table->file.commit(FolderSync::kLater);
    written.hashes[name] = std::move(table->hash).hex();
  }
  const auto codebook = study_codebook(study, run);
  write_file_atomically(folder / "codebook.json", codebook, FolderSync::kLater);
  written.hashes["codebook.json"] = sha256(codebook);
  return written;
}

// What the manifest or, without one, the journal says that the run was asked.
std::optional<std::string> run_digest(const fs::path& folder) {
  if (auto digest = published_digest(folder)) return digest;
  std::error_code ignored;
  if (fs::exists(folder / kManifestFile, ignored)) refuse_unsealed(folder);
  const auto identity = Journal::identify(folder / kJournalFile);
  return identity ? std::optional{identity->inputs.digest()} : std::nullopt;
}

// The same where nothing can be said about a damaged folder because its study cannot be read either.
std::optional<std::string> digest_if_any(const fs::path& folder) try {
  return run_digest(folder);
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace

RunInputs freeze(const StudyReading& reading) {
  auto study = reading.study.value();
  for (auto& variant : study.variants) variant.domain = kFrozenDomain;
  RunInputs inputs{to_toml(study, reading.domain.value()), reading.domain_text, {}};
  for (const auto& file : reading.domain_files) inputs.files.push_back({file.name, sha256(file.text), file.text});
  return inputs;
}

std::string RunInputs::digest() const {
  Sha256 hash;
  const auto add = [&](std::string_view text) {
    hash.update(std::to_string(text.size()) + ":");
    hash.update(text);
  };
  add("kith.run/1");
  add(study);
  add(domain);
  for (const auto& file : files) {
    add(file.name);
    add(file.sha256);
  }
  return std::move(hash).hex();
}

RunFolder::RunFolder(fs::path path, RunInputs inputs, bool replace)
    : path_{std::move(path)}, inputs_{std::move(inputs)} {
  std::error_code error;
  made_ = !fs::exists(fs::symlink_status(path_, error));  // a link that leads nowhere is somebody's
  make_folder(path_);
  try {
    lock_ = FolderLock::try_acquire(path_);
    if (!lock_) throw Error{ErrorKind::kBusy, "another process is writing to " + path_.string()};
    settle(path_);
    { const Generation writable{path_}; }  // removes what earlier ones left, and finds out whether we may write
    remove_unfinished_journals(path_);
    check_content(replace);
  } catch (...) {
    if (made_) fs::remove(path_, error);  // only if it is empty
    throw;
  }
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (made_ && !published_) fs::remove(path_, ignored);  // only if it is empty
}

void RunFolder::require_in_place() const {
  if (lock_->is_at(path_)) return;
  throw Error{ErrorKind::kIo,
              path_.string() +
                  " was moved, removed or replaced while the study ran; the finished teams are saved in "
                  "the " +
                  kJournalFile + " of the folder as it was"};
}

void RunFolder::check_content(bool replace) {
  std::error_code error;
  const bool empty = fs::is_empty(path_, error);
  if (error) throw Error{ErrorKind::kIo, "cannot read " + path_.string() + ": " + error.message()};
  if (empty) return;
  const auto study = text_if_any(path_ / "inputs" / "study.toml");
  const auto domain = text_if_any(path_ / "inputs" / kFrozenDomain);
  const bool same_files = std::all_of(inputs_.files.begin(), inputs_.files.end(), [&](const InputFile& file) {
    return text_if_any(path_ / "inputs" / file.name) == file.text;
  });
  const bool same_inputs = study == inputs_.study && domain == inputs_.domain && same_files;
  has_results_ = same_inputs && fs::exists(path_ / kManifestFile, error);

  // A run that has begun to replace another one's results has a journal of its own.
  const bool has_journal = Journal::exists(path_ / kJournalFile);
  const auto begun = has_journal ? identity_if_any(path_ / kJournalFile) : std::nullopt;
  if (replace || (begun ? begun->inputs == inputs_ : same_inputs)) return;
  if (!study && !has_journal) {
    throw Error{ErrorKind::kUsage, path_.string() + " is not empty and is not a run folder", Remedy::kReplaceContents};
  }
  if (!study && !begun) return;  // only a journal that cannot be read, which is for whoever opens it to say
  auto earlier = frozen_inputs(path_, inputs_.files);
  if (begun) earlier = begun->inputs;
  if (extends(earlier, inputs_)) return;
  constexpr std::size_t kMost = 6;
  auto different = differences(earlier, inputs_);
  const auto more = different.size() > kMost ? different.size() - kMost : 0;
  if (more > 0) different.resize(kMost);
  auto listed = joined(different);
  if (more > 0) listed += " and " + std::to_string(more) + " more";
  throw Error{ErrorKind::kUsage,
              path_.string() + " holds the results of a different study" + (study ? "" : ", unfinished") +
                  (listed.empty() ? "" : "; it differs in " + listed),
              Remedy::kReplaceContents};
}

void RunFolder::freeze_inputs() {
  std::error_code ignored;
  if (fs::exists(path_ / "inputs", ignored)) return;
  Generation generation{path_};
  write_inputs(generation.path());
  generation.commit();
  froze_ = true;
}

void RunFolder::write_inputs(const fs::path& folder) const {
  make_folder(folder / "inputs");
  write_file_atomically(folder / "inputs" / "study.toml", inputs_.study, FolderSync::kLater);
  for (const auto& file : inputs_.files) {
    make_folder((folder / "inputs" / file.name).parent_path());
    write_file_atomically(folder / "inputs" / file.name, file.text, FolderSync::kLater);
  }
  write_file_atomically(folder / "inputs" / kFrozenDomain, inputs_.domain, FolderSync::kLater);
}

void RunFolder::discard() {
  std::error_code ignored;
  Journal::remove(path_ / kJournalFile);
  if (froze_ && !published_) fs::remove_all(path_ / "inputs", ignored);
}

void RunFolder::publish(const Study& study, std::span<const TeamRecord> teams, const RunFacts& facts) {
  publish(
      study,
      [&](const std::function<void(const TeamRecord& team)>& visit) {
        for (const auto& team : teams) visit(team);
      },
      facts);
}

void RunFolder::publish(const Study& study, const TeamSource& teams, const RunFacts& facts) {
  require_in_place();
  Generation generation{path_};
  const auto written = write_tables(generation.path() / "tables", study, inputs_.digest(), teams);
  const auto before = text_if_any(path_ / kManifestFile);
  const auto grown = before ? growth_of(*before, inputs_, extends(frozen_inputs(path_, inputs_.files), inputs_))
                            : std::vector<std::string>{};
  commit(generation, manifest(study, {inputs_, written.teams, {}, written.hashes, grown}, facts), facts, {});
}

void RunFolder::publish_shard(const Study& study, const std::string& shard, std::size_t num_teams,
                              const RunFacts& facts) {
  require_in_place();
  Generation generation{path_};
  commit(generation, manifest(study, {inputs_, num_teams, shard, {}}, facts), facts, {"tables"});
}

void RunFolder::commit(Generation& generation, const std::string& manifest, const RunFacts& facts,
                       const std::vector<std::string>& removed) {
  write_inputs(generation.path());
  std::string log;
  for (const auto& line : facts.log) log += line + "\n";
  write_file_atomically(generation.path() / "log.txt", log, FolderSync::kLater);
  write_file_atomically(generation.path() / "timings.csv", timings_table(facts), FolderSync::kLater);
  write_file_atomically(generation.path() / kManifestFile, manifest, FolderSync::kLater);
  require_in_place();
  published_ = true;
  generation.commit(removed);
}

std::optional<std::string> published_fact(const fs::path& folder, const std::string& key) {
  const auto text = text_if_any(folder / kManifestFile);
  return text ? fact_in_manifest(*text, key) : std::nullopt;
}

std::optional<std::string> published_digest(const fs::path& folder) { return published_fact(folder, "run"); }

namespace {

// The inputs as they are in the folder, whatever this version makes of them. Which files the domain names comes from
// its reading.
RunInputs inputs_as_written(const fs::path& path, const StudyReading& reading) {
  const auto folder = path / "inputs";
  RunInputs inputs{
      text_if_any(folder / "study.toml").value_or(""), text_if_any(folder / kFrozenDomain).value_or(""), {}};
  for (const auto& file : reading.domain_files) {
    const auto text = text_if_any(folder / file.name).value_or("");
    inputs.files.push_back({file.name, sha256(text), text});
  }
  return inputs;
}

// "kith 0.1.0 (d64a5f4)", as the manifest or, without one, the journal says.
std::string program_of(const fs::path& path) {
  if (const auto version = published_fact(path, "version")) {
    const auto git = published_fact(path, "git");
    return "kith " + *version + (git && !git->empty() ? " (" + *git + ")" : "");
  }
  const auto identity = identity_if_any(path / kJournalFile);
  return identity ? "kith " + identity->program : "another version of kith";
}

// The files are those of the run, and yet this program reads another study in them, or none.
[[noreturn]] void refuse_other_version(const fs::path& path, const StudyReading& reading) {
  const auto error = std::find_if(reading.diagnostics.begin(), reading.diagnostics.end(),
                                  [](const Diagnostic& d) { return d.severity == Severity::kError; });
  if (error != reading.diagnostics.end()) {
    refuse_run(
        ErrorKind::kMismatch, "E0608", path / "inputs",
        "this run was made by " + program_of(path) + ", and this program cannot read its study: " + error->message,
        "use that version; what was defined in Python is known only there");
  }
  refuse_run(
      ErrorKind::kMismatch, "E0608", path / "inputs",
      "this run was made by " + program_of(path) + ", and the study that it froze means something else to this version",
      "use that version, or run the study again into another folder");
}

}  // namespace

StudyReading read_run_folder(const fs::path& path, const StudyKinds& kinds) {
  settle_for_reading(path);
  const auto file = path / "inputs" / "study.toml";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {  // a named pipe would keep us waiting
    throw Error{ErrorKind::kIo, path.string() + " is not a run folder: it has no inputs/study.toml"};
  }
  auto reading = load_study(file.string(), {.kinds = kinds});
  const bool is_read = reading.study && reading.domain;
  const auto expected = is_read ? run_digest(path) : digest_if_any(path);
  const bool is_as_written = expected && *expected == inputs_as_written(path, reading).digest();
  if (!is_read) {
    if (is_as_written) refuse_other_version(path, reading);
    return reading;
  }
  if (expected && *expected != freeze(reading).digest()) {
    if (is_as_written) refuse_other_version(path, reading);
    refuse_run(ErrorKind::kMismatch, "E0607", path / "inputs",
               "the inputs are not those of the run: they do not give the digest in its manifest or journal",
               "rerun the command that ran the study; if it was replacing other results, that finishes it");
  }
  return reading;
}

}  // namespace kith
