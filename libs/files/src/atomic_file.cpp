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

// Calls make(path) with names that are new beside the target until it succeeds or fails for another reason than the
// name being taken; `temporary` is then the name. The number makes names differ between threads, the process id between
// processes.
template <typename Make>
int with_new_name(const std::filesystem::path& target, std::filesystem::path& temporary, const Make& make) {
  for (int attempt = 0; attempt < 10'000; ++attempt) {
    std::string name{'.'};
    name += target.filename().string();
    name.append(".").append(std::to_string(getpid())).append(".").append(std::to_string(attempt)).append(".tmp");
    temporary = folder_of(target) / name;
    const int result = uninterrupted([&] { return make(temporary.c_str()); });
    if (result >= 0 || errno != EEXIST) return result;
  }
  errno = EEXIST;
  return -1;
}

// The name under which the system knows an open file without a name.
std::string name_of(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

// A file without a name in the folder of the target; -1 where there is no such thing.
int open_unnamed(const std::filesystem::path& target) {
  const auto folder = folder_of(target);
  const int descriptor = uninterrupted([&] { return open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666); });
  if (descriptor < 0) return -1;
  if (access(name_of(descriptor).c_str(), F_OK) == 0) return descriptor;  // else it could not be given a name later
  close(descriptor);
  return -1;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path, OldLink link)
    : path_{path}, target_{link == OldLink::kFollow ? behind_links(path) : path} {
  std::error_code ignored;
  const auto status = link == OldLink::kFollow ? std::filesystem::status(path_, ignored)
                                               : std::filesystem::symlink_status(path_, ignored);
  if (std::filesystem::is_directory(status)) fail("write", EISDIR);
  const bool is_regular = std::filesystem::is_regular_file(status);
  if (std::filesystem::exists(status) && !is_regular && !std::filesystem::is_symlink(status)) {
    open_directly();
  } else {
    open_new();
  }
  if (is_regular) {
    // What is replaced passes its permissions on; if it cannot be, those of a new file will do.
    (void)fchmod(descriptor_, static_cast<mode_t>(status.permissions()) & 07777);
  }
}

AtomicFile::~AtomicFile() { abandon(); }

void AtomicFile::fail(const std::string& action, int error) const { kith::fail(action, path_, error); }

void AtomicFile::open_new() {
  descriptor_ = open_unnamed(target_);
  if (descriptor_ >= 0) return;
  descriptor_ = with_new_name(
      target_, temporary_, [](const char* name) { return open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
  if (descriptor_ >= 0) return;
  const int error = errno;
  temporary_.clear();
  fail("write", error);
}

// Opened without waiting, so that a named pipe without a reader is an error; written to as usual.
void AtomicFile::open_directly() {
  is_direct_ = true;
  descriptor_ = uninterrupted([&] { return open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC); });
  if (descriptor_ < 0 && errno == ENXIO) {
    throw Error{ErrorKind::kIo,
                "cannot write " + path_.string() + ": no program reads from this pipe, or the device does not exist"};
  }
  if (descriptor_ < 0) fail("write", errno);
  const int flags = fcntl(descriptor_, F_GETFL);
  if (flags >= 0) (void)fcntl(descriptor_, F_SETFL, flags & ~O_NONBLOCK);
}

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

// Its own name where that is free, so that there is no other at any time; else a temporary one.
void AtomicFile::give_name() {
  const auto unnamed = name_of(descriptor_);
  const auto link_to = [&](const char* name) {
    return linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW);
  };
  if (link_to(target_.c_str()) == 0) return;
  if (errno != EEXIST) fail("write", errno);
  if (with_new_name(target_, temporary_, link_to) == 0) return;
  const int error = errno;
  temporary_.clear();
  fail("write", error);
}

void AtomicFile::commit(FolderSync folder) {
  // Terminals and pipes cannot be synchronised, which is no failure.
  if (uninterrupted([&] { return fsync(descriptor_); }) < 0 && !is_direct_) fail("write", errno);
  if (!is_direct_ && temporary_.empty()) give_name();
  const int descriptor = std::exchange(descriptor_, -1);
  if (close(descriptor) < 0 && errno != EINTR) fail("write", errno);
  if (is_direct_) return;
  if (!temporary_.empty() && rename(temporary_.c_str(), target_.c_str()) < 0) fail("replace", errno);
  temporary_.clear();
  if (folder == FolderSync::kNow) synchronise_folder(folder_of(target_));
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content, FolderSync folder,
                           OldLink link) {
  AtomicFile file{path, link};
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

namespace {

// Closes what was opened.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_{value} {}
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

void require_regular_file(int descriptor, const std::filesystem::path& path) {
  struct stat status = {};
  if (fstat(descriptor, &status) < 0) fail("read", path, errno);
  if (S_ISDIR(status.st_mode)) fail("read", path, EISDIR);
  if (!S_ISREG(status.st_mode))
    throw Error{ErrorKind::kIo, "cannot read " + path.string() + ": it is not a regular file"};
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  constexpr int kAtOnce = O_NONBLOCK | O_NOCTTY;  // else a pipe waits for a writer
  const Descriptor file{uninterrupted([&] { return open(path.c_str(), O_RDONLY | O_CLOEXEC | kAtOnce); })};
  if (file.value() < 0) fail("read", path, errno);
  require_regular_file(file.value(), path);
  std::string content;
  std::array<char, 64 * 1024> piece;
  for (;;) {
    const auto count = uninterrupted([&] { return read(file.value(), piece.data(), piece.size()); });
    if (count < 0) fail("read", path, errno);
    if (count == 0) return content;
    content.append(piece.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace kith
