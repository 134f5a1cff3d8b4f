#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/error.hpp"

namespace kith {

/// Names in the folder of a run.
inline constexpr const char* kManifestFile = "manifest.json";

/// The results of a study in their folder: what manifest.json says of them, and the files that it names, each compared
/// with its hash when it is read. All that is read is therefore of one run, and complete.
class PublishedRun {
 public:
  /// Reads the manifest, after finishing a publication that was interrupted.
  /// @throws kith::Error  kIo E0601 (there is no such folder, or it cannot be read); kInvalidInput E0602 (not a run),
  /// E0603 (not finished, or a shard); kMismatch E0605 (the manifest is damaged), E0607 (the inputs are not those of
  /// the run); kBusy.
  [[nodiscard]] static PublishedRun open(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  /// The text of manifest.json.
  [[nodiscard]] const std::string& manifest() const noexcept { return manifest_; }
  /// The digest of what the study was asked, 64 hexadecimal digits.
  [[nodiscard]] const std::string& digest() const noexcept { return digest_; }
  /// What is missing in the tables, in words; empty if nothing is.
  [[nodiscard]] const std::vector<std::string>& missing() const noexcept { return missing_; }
  /// Whether the run has a file of that name, such as "tables/teams.csv".
  [[nodiscard]] bool has(const std::string& name) const { return hashes_.find(name) != hashes_.end(); }
  /// SHA-256 of its inputs and tables by name ("inputs/study.toml").
  [[nodiscard]] const std::map<std::string, std::string>& hashes() const noexcept { return hashes_; }
  /// The text of such a file. @throws kith::Error kInvalidInput E0604 (there is none), kMismatch E0607 (it is not the
  /// one that the run wrote); kIo.
  [[nodiscard]] std::string read(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::string manifest_;
  std::string digest_;
  std::vector<std::string> missing_;
  std::map<std::string, std::string> hashes_;
};

/// A manifest without its checksum, as JSON text, with that put at its end: SHA-256 of the text without it.
[[nodiscard]] std::string sealed_manifest(std::string_view manifest);
/// Whether the text is JSON that ends with the checksum of the rest.
[[nodiscard]] bool is_sealed(std::string_view manifest);

/// A complaint about a file or folder of a run. @throws kith::Error of that kind, with the diagnostic.
[[noreturn]] void refuse_run(ErrorKind kind, const std::string& id, const std::filesystem::path& file,
                             const std::string& message, const Advice& advice);
/// The same about a manifest in a folder that is not sealed. @throws kith::Error kMismatch E0605.
[[noreturn]] void refuse_unsealed(const std::filesystem::path& folder);

}  // namespace kith
