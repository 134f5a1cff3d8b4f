#pragma once

#include <filesystem>
#include <optional>

namespace kith {

/// Keeps other processes that lock the same folder out, as long as it lives or until the process ends (flock). Network
/// file systems without locks are let be.
class FolderLock {
 public:
  /// @return nothing if another process holds the folder. @throws kith::Error (kIo) if it cannot be opened.
  [[nodiscard]] static std::optional<FolderLock> try_acquire(const std::filesystem::path& folder);

  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

  /// Whether `folder` still names the folder that was locked: false once it was moved, removed or replaced.
  [[nodiscard]] bool is_at(const std::filesystem::path& folder) const;

 private:
  explicit FolderLock(int descriptor) noexcept : descriptor_{descriptor} {}
  int descriptor_;
};

/// Whether a process holds the folder right now.
[[nodiscard]] bool is_busy(const std::filesystem::path& folder);

}  // namespace kith
