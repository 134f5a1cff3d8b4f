#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "kith/files/atomic_file.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/generation.hpp"

namespace kith {

/// Files of a folder that are replaced together or not at all; other files of the folder stay as they are. Until
/// commit() the folder is what it was, also if the disk is full or the program ends, and what people call the folder
/// ("out", "out/", "out/.", a link to it) makes no difference. All errors are kith::Error: kIo with the path, kBusy if
/// another process is writing there.
class FileSet {
 public:
  /// Makes the folder if there is none.
  explicit FileSet(std::filesystem::path folder);
  /// Without commit() removes what was prepared, and the folder if this made it.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// Appends to the file of that name, which begins empty. Where a folder or a link has that name, kIo. @pre not
  /// committed.
  void write(const std::string& name, std::string_view piece);
  /// Puts all files in place. Once. @param removed  names that the folder no longer holds; those that it does not hold
  /// and those that were written are ignored.
  void commit(const std::set<std::string>& removed = {});

 private:
  std::filesystem::path folder_;
  bool made_ = false;
  std::optional<FolderLock> lock_;
  std::optional<Generation> generation_;
  std::map<std::string, std::unique_ptr<AtomicFile>> files_;
};

}  // namespace kith
