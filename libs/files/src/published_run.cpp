#include "kith/files/published_run.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "kith/files/atomic_file.hpp"
#include "kith/files/generation.hpp"
#include "kith/files/sha256.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kRunAgain = "rerun the command that ran the study";
constexpr const char* kChecksum = "checksum";

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

void check_folder(const fs::path& folder) {
  std::error_code error;
  const auto status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found)
    refuse_run(ErrorKind::kIo, "E0601", folder, "there is no such folder", Remedy::kRunStudy);
  if (error)
    refuse_run(ErrorKind::kIo, "E0601", folder, "the folder cannot be read: " + error.message(), Remedy::kRunStudy);
  if (!fs::is_directory(status))
    refuse_run(ErrorKind::kIo, "E0601", folder, "this is a file, not the folder of a run", Remedy::kRunStudy);
  bool empty = true, unfinished = false;
  for (fs::directory_iterator entry{folder, error}, end; !error && entry != end; entry.increment(error)) {
    const auto name = entry->path().filename().string();
    unfinished = unfinished || is_generation(name) || name == "study.sqlite";
    empty = empty && is_generation(name);
  }
  if (error)
    refuse_run(ErrorKind::kIo, "E0601", folder, "the folder cannot be read: " + error.message(), Remedy::kRunStudy);
  if (empty && !unfinished)
    refuse_run(ErrorKind::kInvalidInput, "E0602", folder, "the folder is empty", Remedy::kRunStudy);
  if (is_there(folder / kManifestFile)) return;
  if (unfinished || is_there(folder / "inputs")) {
    refuse_run(ErrorKind::kInvalidInput, "E0603", folder, "the study has not finished: it has no manifest.json",
               "if it was interrupted, rerun the command that started it");
  }
  refuse_run(ErrorKind::kInvalidInput, "E0602", folder, "this is not a run folder: it has no manifest.json",
             Remedy::kRunStudy);
}

// The manifest without its checksum, if that is right.
std::optional<Json> unsealed(std::string_view text) {
  // Ours is shallow; writing a very deep one again would take more stack than there is.
  constexpr int kDeepest = 8;
  const auto is_shallow = [](int depth, Json::parse_event_t, Json&) { return depth <= kDeepest; };
  auto manifest = Json::parse(text, is_shallow, false);
  if (!manifest.is_object() || !manifest.contains(kChecksum)) return std::nullopt;
  const auto checksum = manifest.at(kChecksum);
  manifest.erase(kChecksum);
  if (checksum != sha256(manifest.dump())) return std::nullopt;
  return manifest;
}

std::string text_in(const Json& manifest, const char* key) {
  const auto found = manifest.find(key);
  return found != manifest.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

void check_finished(const fs::path& folder, const Json& manifest) {
  if (manifest.contains("shard")) {
    refuse_run(ErrorKind::kInvalidInput, "E0603", folder,
               "this is shard " + text_in(manifest, "shard") + " of a study, which has no tables of its own",
               Remedy::kMergeShards);
  }
  const auto reason = text_in(manifest, "exit_reason");
  if (reason == "finished" || reason == "partial") return;
  refuse_run(ErrorKind::kInvalidInput, "E0603", folder / kManifestFile, "the run did not finish: " + reason, kRunAgain);
}

}  // namespace

void refuse_run(ErrorKind kind, const std::string& id, const fs::path& file, const std::string& message,
                const Advice& advice) {
  const Diagnostic diagnostic{
      .id = id, .message = message, .file = file.string(), .hint = advice.hint, .remedy = advice.remedy};
  auto text = to_text(diagnostic);
  text.pop_back();
  throw Error{kind, text, {diagnostic}};
}

void refuse_unsealed(const fs::path& folder) {
  refuse_run(ErrorKind::kMismatch, "E0605", folder / kManifestFile,
             "the manifest is damaged, was changed, or is of an older kith: it lacks the checksum at its end",
             kRunAgain);
}

std::string sealed_manifest(std::string_view manifest) {
  auto document = Json::parse(manifest);
  document[kChecksum] = sha256(document.dump());
  return document.dump(2) + "\n";
}

bool is_sealed(std::string_view manifest) { return unsealed(manifest).has_value(); }

PublishedRun PublishedRun::open(const fs::path& folder) {
  settle_for_reading(folder);
  check_folder(folder);
  PublishedRun run;
  run.folder_ = folder;
  run.manifest_ = read_file(folder / kManifestFile);
  const auto manifest = unsealed(run.manifest_);
  if (!manifest) refuse_unsealed(folder);
  if (text_in(*manifest, "schema") != "kith.manifest/2") {
    refuse_run(ErrorKind::kInvalidInput, "E0605", folder / kManifestFile,
               "this is not a manifest that this version of kith can read (kith.manifest/2)", kRunAgain);
  }
  check_finished(folder, *manifest);
  run.digest_ = text_in(*manifest, "run");
  for (const auto* group : {"inputs", "tables"}) {
    const auto found = manifest->find(group);
    if (found == manifest->end() || !found->is_object()) continue;
    for (const auto& [name, hash] : found->items()) {
      if (hash.is_string()) run.hashes_[std::string{group} + "/" + name] = hash.get<std::string>();
    }
  }
  if (const auto missing = manifest->find("missing"); missing != manifest->end() && missing->is_array()) {
    for (const auto& file : *missing) {
      if (file.is_string()) run.missing_.push_back(file.get<std::string>());
    }
  }
  for (const auto& [name, hash] : run.hashes_) {
    if (name.rfind("inputs/", 0) == 0) (void)run.read(name);
  }
  return run;
}

std::string PublishedRun::read(const std::string& name) const {
  const auto found = hashes_.find(name);
  const auto file = folder_ / name;
  const bool is_table = name.rfind("tables/", 0) == 0;
  if (found == hashes_.end())
    refuse_run(ErrorKind::kInvalidInput, "E0604", file, "the run has no such file", kRunAgain);
  std::error_code error;
  if (!fs::exists(file, error)) {
    refuse_run(ErrorKind::kInvalidInput, "E0604", file, is_table ? "the table is missing" : "the file is missing",
               kRunAgain);
  }
  if (!fs::is_regular_file(file, error))
    refuse_run(ErrorKind::kInvalidInput, "E0604", file, "this is not a regular file", kRunAgain);
  auto text = read_file(file);
  if (sha256(text) != found->second) {
    refuse_run(ErrorKind::kMismatch, "E0607", file,
               "the file is not the one that the run wrote: its hash is not that in manifest.json",
               Advice{kRunAgain, is_table ? Remedy::kAnalyseTable : Remedy::kNone});
  }
  return text;
}

}  // namespace kith
