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

/// What becomes of a symbolic link under the name of the file.
enum class OldLink {
  kFollow,   ///< It stays, and its target is replaced: people name files as they like.
  kReplace,  ///< It is replaced itself: in folders of our own a link must not lead us to other files.
};

/// A file that appears under its name complete or not at all: what is written
/// goes to a file without a name in the same folder, and commit() brings it to the
/// disk and puts it in place of what was there. A reader, a crash or a power cut
/// never finds half of it. Without commit() nothing remains, even if the process is killed. (Where the file system has
/// no files without a name, it is `.NAME.PID.N.tmp` until then, and a kill leaves that; where a file is to be replaced,
/// so does a kill between its getting this name and the other.)
///
/// What exists and is no regular file (a terminal, /dev/stdout, a pipe) is written to directly. A named pipe that
/// nobody reads is an error: nothing waits for a reader.
///
/// All errors are kith::Error (kIo) with the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path, OldLink link = OldLink::kFollow);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. @pre not committed.
  void write(std::string_view text);
  /// Flushes the file to the disk, puts it in place, and flushes the folder, unless that is to be done later. Once.
  void commit(FolderSync folder = FolderSync::kNow);

 private:
  [[noreturn]] void fail(const std::string& action, int error) const;
  void abandon() noexcept;
  void open_new();
  void open_directly();
  void give_name();

  std::filesystem::path path_;       // as people named it, for messages
  std::filesystem::path target_;     // behind symbolic links that are followed
  std::filesystem::path temporary_;  // empty while the file has no name, or where it is written to directly
  bool is_direct_ = false;
  int descriptor_ = -1;
};

/// AtomicFile in one call.
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           FolderSync folder = FolderSync::kNow, OldLink link = OldLink::kFollow);

/// Brings the entries of a folder to the disk. File systems that cannot do so for folders are let be.
void synchronise_folder(const std::filesystem::path& folder);

/// The content of a regular file: a named pipe or a device would keep us waiting. @throws kith::Error (kIo) with the
/// path and the system's reason.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace kith
