#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kith::faults {

using Files = std::map<std::string, std::string>;  ///< Contents by name.

/// A folder of its own, removed at the end unless it is to be kept.
class Scratch {
 public:
  /// Below /dev/shm where that has room for it, else below TMPDIR. @throws kith::Error
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void keep() { kept_ = true; }

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

/// Copies a folder with all that is in it.
void copy_folder(const std::filesystem::path& from, const std::filesystem::path& to);

/// The files of a folder, those of its folders included, by relative name; none where there is no folder.
[[nodiscard]] Files files_below(const std::filesystem::path& folder);

/// The relative names of these files, sorted.
[[nodiscard]] std::vector<std::string> names_below(const std::filesystem::path& folder);

void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace kith::faults
