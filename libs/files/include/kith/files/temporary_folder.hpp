#pragma once

#include <filesystem>
#include <string_view>

namespace kith {

/// A new folder among temporary files, removed at the end with everything in it.
class TemporaryFolder {
 public:
  /// @param name  how the folder's name begins. @throws kith::Error (kIo) if it cannot be made.
  explicit TemporaryFolder(std::string_view name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace kith
