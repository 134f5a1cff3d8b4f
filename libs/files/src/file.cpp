#include "kith/files/file.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include "kith/files/document.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

// The TOML files right in a folder, in the order of their names; only the first few.
std::vector<std::string> toml_files(const fs::path& folder) {
  constexpr std::size_t kMost = 4;
  std::vector<std::string> files;
  std::error_code failure;
  for (fs::directory_iterator entry{folder, failure}, end; !failure && entry != end; entry.increment(failure)) {
    if (entry->path().extension() == ".toml") files.push_back(entry->path().string());
  }
  std::sort(files.begin(), files.end());
  if (files.size() > kMost) files.resize(kMost);
  return files;
}

}  // namespace

std::optional<std::string> read_toml_text(const fs::path& path) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) return std::nullopt;
  std::ifstream file{path, std::ios::binary};
  if (!file) return std::nullopt;
  std::string text(kMaxTomlBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) return std::nullopt;
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

std::string why_unreadable(const fs::path& path) {
  std::error_code failure;
  if (fs::is_directory(path, failure)) {
    std::string text;
    for (const auto& file : toml_files(path)) text += (text.empty() ? "; name a file in it: " : ", ") + file;
    return "it is a folder" + text;
  }
  errno = 0;
  const std::ifstream file{path, std::ios::binary};
  return std::generic_category().message(errno != 0 ? errno : EIO);
}

}  // namespace kith
