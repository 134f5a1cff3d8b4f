#include "kith/files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {

std::optional<FolderLock> FolderLock::try_acquire(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) {
    throw Error{ErrorKind::kIo,
                "cannot open the folder " + folder.string() + ": " + std::generic_category().message(errno)};
  }
  FolderLock lock{descriptor};
  // Whoever looks whether the folder is busy holds it for an instant; a run holds it for longer than that.
  for (int attempt = 0; attempt < 5; ++attempt) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return lock;
    if (errno != EWOULDBLOCK && errno != EINTR) return lock;  // a file system without locks
    usleep(20'000);
  }
  return std::nullopt;
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_{std::exchange(other.descriptor_, -1)} {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool FolderLock::is_at(const std::filesystem::path& folder) const {
  struct stat mine = {}, there = {};
  return fstat(descriptor_, &mine) == 0 && stat(folder.c_str(), &there) == 0 && mine.st_dev == there.st_dev &&
         mine.st_ino == there.st_ino;
}

bool is_busy(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool busy = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return busy;
}

}  // namespace kith
