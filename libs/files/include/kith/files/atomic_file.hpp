#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kith {

/// When the entry of a committed file in its folder is on the disk too.
enum class FolderSync {
  kNow,    ///< When commit() returns.
  kLater,  ///< After synchronise_folder(), once for many files.
};

/// A file that appears under its name complete or not at all: what is written
/// goes to a temporary file in the same folder, and commit() brings it to the
/// disk and puts it in place of what was there. A reader, a crash or a power cut
/// never finds half of it. Without commit() nothing remains.
///
/// A symbolic link stays, and its target is replaced. What exists and is no
/// regular file (a terminal, /dev/stdout) is written to directly.
///
/// All errors are kith::Error (kIo) with the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. @pre not committed.
  void write(std::string_view text);
  /// Flushes the file to the disk, renames it, and flushes the folder, unless that is to be done later. Once.
  void commit(FolderSync folder = FolderSync::kNow);

 private:
  [[noreturn]] void fail(const std::string& action, int error) const;
  void abandon() noexcept;

  std::filesystem::path path_;       // as people named it, for messages
  std::filesystem::path target_;     // behind symbolic links
  std::filesystem::path temporary_;  // empty when written to directly
  int descriptor_ = -1;
};

/// AtomicFile in one call.
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           FolderSync folder = FolderSync::kNow);

/// Brings the entries of a folder to the disk. File systems that cannot do so for folders are let be.
void synchronise_folder(const std::filesystem::path& folder);

/// The content of a file. @throws kith::Error (kIo) with the path and the system's reason.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace kith
