#include "kith/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {
namespace {

// Repeats a system call while a signal interrupts it.
template <typename Call>
auto uninterrupted(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

[[noreturn]] void fail(const std::string& action, const std::filesystem::path& path, int error) {
  throw Error{ErrorKind::kIo, "cannot " + action + " " + path.string() + ": " + std::generic_category().message(error)};
}

// The path that a chain of symbolic links ends in, which need not exist.
std::filesystem::path behind_links(std::filesystem::path path) {
  std::error_code error;
  for (int hops = 0; hops < 40 && std::filesystem::is_symlink(path, error); ++hops) {
    const auto to = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / to;  // an absolute `to` replaces the left side
  }
  return path;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  const auto folder = path.parent_path();
  return folder.empty() ? std::filesystem::path{"."} : folder;
}

// A file of a new name beside the target. The number makes names differ between
// threads, the process id between processes.
int open_beside(const std::filesystem::path& target, std::filesystem::path& temporary) {
  for (int attempt = 0; attempt < 10'000; ++attempt) {
    std::string name{'.'};
    name += target.filename().string();
    name.append(".").append(std::to_string(getpid())).append(".").append(std::to_string(attempt)).append(".tmp");
    temporary = folder_of(target) / name;
    const int descriptor =
        uninterrupted([&] { return open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  errno = EEXIST;
  return -1;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_{path}, target_{behind_links(path)} {
  std::error_code ignored;
  const auto status = std::filesystem::status(target_, ignored);
  if (std::filesystem::is_directory(status)) fail("write", EISDIR);
  const bool is_special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  if (is_special) {
    descriptor_ = uninterrupted([&] { return open(target_.c_str(), O_WRONLY | O_CLOEXEC); });
  } else {
    descriptor_ = open_beside(target_, temporary_);
  }
  if (descriptor_ < 0) {
    const int error = errno;
    temporary_.clear();
    fail("write", error);
  }
  if (std::filesystem::is_regular_file(status)) {
    // What is replaced passes its permissions on; if it cannot be, those of a new file will do.
    (void)fchmod(descriptor_, static_cast<mode_t>(status.permissions()) & 07777);
  }
}

AtomicFile::~AtomicFile() { abandon(); }

void AtomicFile::fail(const std::string& action, int error) const { kith::fail(action, path_, error); }

void AtomicFile::abandon() noexcept {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::write(std::string_view text) {
  while (!text.empty()) {
    const auto written = uninterrupted([&] { return ::write(descriptor_, text.data(), text.size()); });
    if (written < 0) fail("write", errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit(FolderSync folder) {
  // Terminals and pipes cannot be synchronised, which is no failure.
  if (uninterrupted([&] { return fsync(descriptor_); }) < 0 && !temporary_.empty()) fail("write", errno);
  const int descriptor = std::exchange(descriptor_, -1);
  if (close(descriptor) < 0 && errno != EINTR) fail("write", errno);
  if (temporary_.empty()) return;
  if (rename(temporary_.c_str(), target_.c_str()) < 0) fail("replace", errno);
  temporary_.clear();
  if (folder == FolderSync::kNow) synchronise_folder(folder_of(target_));
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content, FolderSync folder) {
  AtomicFile file{path};
  file.write(content);
  file.commit(folder);
}

void synchronise_folder(const std::filesystem::path& folder) {
  const int handle = uninterrupted([&] { return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (handle < 0) fail("synchronise the folder", folder, errno);
  const bool synchronised = uninterrupted([&] { return fsync(handle); }) == 0;
  const int error = errno;
  close(handle);
  if (!synchronised && error != EINVAL) fail("synchronise the folder", folder, error);
}

std::string read_file(const std::filesystem::path& path) {
  const int descriptor = uninterrupted([&] { return open(path.c_str(), O_RDONLY | O_CLOEXEC); });
  if (descriptor < 0) fail("read", path, errno);
  std::string content;
  std::array<char, 64 * 1024> piece;
  for (;;) {
    const auto count = uninterrupted([&] { return read(descriptor, piece.data(), piece.size()); });
    if (count < 0) {
      const int error = errno;
      close(descriptor);
      fail("read", path, error);
    }
    if (count == 0) break;
    content.append(piece.data(), static_cast<std::size_t>(count));
  }
  close(descriptor);
  return content;
}

}  // namespace kith
