#include "run_files.hpp"

#include <algorithm>

#include "kith/files/atomic_file.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/run_folder.hpp"

namespace kith::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMakeOne = "make one with: kith study STUDY -o DIR";
constexpr const char* kRunAgain = "run the study again with the same -o";

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

void check_folder(const fs::path& folder) {
  std::error_code error;
  if (!is_there(folder)) refuse_run(ErrorKind::kIo, "E0601", folder, "there is no such folder", kMakeOne);
  if (!fs::is_directory(folder, error)) {
    refuse_run(ErrorKind::kIo, "E0601", folder, "this is a file, not the folder of a run", kMakeOne);
  }
  bool empty = true, staging = false;
  for (const auto& entry : fs::directory_iterator{folder, error}) {
    const bool hidden = entry.path().filename().string().rfind(".kith-staging-", 0) == 0;
    staging = staging || hidden;
    empty = empty && hidden;
  }
  if (error) refuse_run(ErrorKind::kIo, "E0601", folder, "the folder cannot be read: " + error.message(), kMakeOne);
  if (empty && staging) {
    refuse_run(ErrorKind::kInvalidInput, "E0603", folder, "the study has not finished; there are no results yet",
               "wait for it, or run it again if it was interrupted");
  }
  if (empty) refuse_run(ErrorKind::kInvalidInput, "E0602", folder, "the folder is empty", kMakeOne);
  if (!is_there(folder / "inputs" / "study.toml")) {
    refuse_run(ErrorKind::kInvalidInput, "E0602", folder, "this is no run folder: it has no inputs/study.toml",
               kMakeOne);
  }
}

void check_complete(const fs::path& folder) {
  for (const auto& name : {fs::path{"inputs"} / "domain.toml", fs::path{"tables"}, fs::path{"manifest.json"}}) {
    if (is_there(folder / name)) continue;
    refuse_run(ErrorKind::kInvalidInput, "E0603", folder, "the run is not complete: it has no " + name.string(),
               kRunAgain);
  }
}

Json read_manifest(const fs::path& file) {
  auto manifest = Json::parse(read_file(file), nullptr, false);
  const auto says = [&](const char* key, const char* value) {
    const auto found = manifest.find(key);
    return found != manifest.end() && *found == value;
  };
  if (!manifest.is_object() || !says("schema", "kith.manifest/1")) {
    refuse_run(ErrorKind::kInvalidInput, "E0605", file, "this is no manifest of a run (schema kith.manifest/1)",
               kRunAgain);
  }
  if (!says("exit_reason", "finished")) {
    refuse_run(ErrorKind::kInvalidInput, "E0603", file, "the run did not finish", kRunAgain);
  }
  return manifest;
}

}  // namespace

void refuse_run(ErrorKind kind, const std::string& id, const fs::path& file, const std::string& message,
                const std::string& hint) {
  const Diagnostic diagnostic{.id = id, .message = message, .file = file.string(), .hint = hint};
  auto text = to_text(diagnostic);
  text.pop_back();
  throw Error{kind, text, {diagnostic}};
}

RunFiles open_run(const fs::path& folder) {
  check_folder(folder);
  check_complete(folder);
  auto manifest = read_manifest(folder / "manifest.json");
  auto reading = read_run_folder(folder);
  if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
  auto teams = register_teams(*reading.study);
  return {folder,
          *std::move(reading.study),
          *std::move(reading.domain),
          std::move(teams),
          read_file(folder / "inputs" / "study.toml"),
          read_file(folder / "inputs" / "domain.toml"),
          std::move(manifest)};
}

std::string table_text(const RunFiles& run, const std::string& table, std::vector<std::string>& notes) {
  const auto file = run.folder / "tables" / table;
  if (!is_there(file)) {
    refuse_run(ErrorKind::kInvalidInput, "E0604", file, "the table is missing",
               "restore it, or run the study again with the same -o");
  }
  auto text = read_file(file);
  const auto tables = run.manifest.find("tables");
  const bool known = tables != run.manifest.end() && tables->is_object() && tables->contains(table);
  if (known && tables->at(table) != sha256(text)) {
    notes.push_back("tables/" + table + " was changed after the run: it does not have the hash in manifest.json.");
  }
  return text;
}

std::string manifest_text(const RunFiles& run, const std::string& key) {
  const auto found = run.manifest.find(key);
  return found != run.manifest.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

}  // namespace kith::detail
