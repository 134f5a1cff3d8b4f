#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kith {

/// Files and folders that change together. They are prepared aside, in a hidden folder inside the one that they are
/// for; commit() is one rename, after which they are what the folder holds, whatever happens. What is left to do then,
/// moving each into place, is finished by settle(): by commit() itself or, if the program ended meanwhile, by whoever
/// opens the folder next. Until commit() nothing changes.
///
/// Whoever makes one holds the lock of the folder (FolderLock). All errors are kith::Error (kIo) with the path.
class Generation {
 public:
  /// An empty one. Removes what earlier ones left that were never committed. @pre settled.
  explicit Generation(std::filesystem::path folder);
  /// Removes what was not committed.
  ~Generation();
  Generation(const Generation&) = delete;
  Generation& operator=(const Generation&) = delete;

  /// Where to put its files and folders.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staging_; }

  /// Puts them in place of those of the same name. Their bytes must be on the disk; the entries of folders are brought
  /// there now.
  /// @param removed  names that the folder no longer holds afterwards.
  void commit(const std::vector<std::string>& removed = {});

 private:
  std::filesystem::path folder_;
  std::filesystem::path staging_;
};

/// Whether a commit is not finished.
[[nodiscard]] bool is_unsettled(const std::filesystem::path& folder);

/// Finishes a commit that was interrupted; otherwise does nothing. The lock must be held.
/// @throws kith::Error (kIo)
void settle(const std::filesystem::path& folder);

/// The same for readers, who hold no lock. @throws kith::Error kBusy if another process is at it for too long, kIo if
/// it cannot be finished by this process.
void settle_for_reading(const std::filesystem::path& folder);

/// Whether this name is one of the hidden ones that a Generation uses.
[[nodiscard]] bool is_generation(const std::string& name);

}  // namespace kith
