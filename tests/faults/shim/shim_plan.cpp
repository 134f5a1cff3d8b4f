#include "shim_plan.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace kith::faults {
namespace {

constexpr std::array<std::string_view, kNumKinds> kNames{"write",     "pwrite", "pwritev",   "writev",    "fsync",
                                                         "fdatasync", "rename", "link",      "unlink",    "rmdir",
                                                         "mkdir",     "open",   "ftruncate", "fallocate", "close"};

// The path behind a link of /proc/self; its length, or 0.
std::size_t read_link(const char* link, char* path, std::size_t room) noexcept {
  const auto length = readlink(link, path, room);
  return length > 0 ? static_cast<std::size_t>(length) : 0;
}

std::size_t path_of_descriptor(int descriptor, char* path, std::size_t room) noexcept {
  char link[40] = "/proc/self/fd/";
  char* const digits = link + std::strlen(link);
  *std::to_chars(digits, link + sizeof link - 1, descriptor).ptr = '\0';
  return read_link(link, path, room);
}

int error_named(std::string_view name) noexcept {
  return name == "EIO" ? EIO : name == "ENOSPC" ? ENOSPC : name == "EINTR" ? EINTR : 0;
}

}  // namespace

Plan::Plan() noexcept {
  root_ = std::getenv("KITH_FAULT_ROOT");
  root_length_ = root_ == nullptr ? 0 : std::strlen(root_);
  count_file_ = std::getenv("KITH_FAULT_COUNT");
  const char* rank = std::getenv("KITH_FAULT_RANK");
  const char* mine = std::getenv("OMPI_COMM_WORLD_RANK");
  if (rank != nullptr && (mine == nullptr || std::strcmp(rank, mine) != 0)) return;
  const char* fault = std::getenv("KITH_FAULT");
  if (fault != nullptr) parse_fault(fault);
}

// KIND:N:ACTION
void Plan::parse_fault(std::string_view text) noexcept {
  const auto first = text.find(':');
  const auto second = text.find(':', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return;
  const auto kind = text.substr(0, first);
  for (std::size_t i = 0; i < kNumKinds; ++i) {
    if (kNames[i] == kind) kind_ = static_cast<Kind>(i);
  }
  if (kind_ == Kind::kAny && kind != "any") return;
  const auto action = text.substr(second + 1);
  error_ = error_named(action);
  fills_disk_ = action == "full";
  action_ = action == "kill"        ? Action::kKill
            : action == "killafter" ? Action::kKillAfter
            : action == "short"     ? Action::kShort
            : action == "torn"      ? Action::kTorn
            : error_ != 0           ? Action::kFail
                                    : Action::kNone;
  if (action_ == Action::kNone && !fills_disk_) return;
  std::uint64_t number = 0;
  std::from_chars(text.data() + first + 1, text.data() + second, number);
  number_ = number;
}

int Plan::full_error() noexcept { return ENOSPC; }

bool Plan::is_below_root(const char* path, std::size_t length) const noexcept {
  return length > root_length_ && std::memcmp(path, root_, root_length_) == 0 && path[root_length_] == '/';
}

bool Plan::concerns_path(const char* path) const noexcept { return concerns_path_at(AT_FDCWD, path); }

bool Plan::concerns_path_at(int folder, const char* path) const noexcept {
  if (root_length_ == 0 || path == nullptr) return false;
  const auto length = std::strlen(path);
  if (path[0] == '/') return is_below_root(path, length);
  char base[PATH_MAX + 1];
  const auto found =
      folder == AT_FDCWD ? read_link("/proc/self/cwd", base, PATH_MAX) : path_of_descriptor(folder, base, PATH_MAX);
  if (found == 0) return false;
  base[found] = '/';
  return is_below_root(base, found + 1);
}

bool Plan::concerns_descriptor(int descriptor) const noexcept {
  if (root_length_ == 0 || descriptor < 0) return false;
  char path[PATH_MAX];
  return is_below_root(path, path_of_descriptor(descriptor, path, sizeof path));
}

Action Plan::count(Kind kind, bool grows) noexcept {
  counts_[static_cast<std::size_t>(kind)].fetch_add(1);
  if (number_ == 0) return Action::kNone;
  if (full_.load()) return grows ? Action::kFail : Action::kNone;
  if (kind_ != Kind::kAny && kind_ != kind) return Action::kNone;
  if (matching_.fetch_add(1) + 1 != number_) return Action::kNone;
  note_strike(kind);
  if (!fills_disk_) return action_;
  full_.store(true);
  const bool writes = kind == Kind::kWrite || kind == Kind::kPwrite || kind == Kind::kWritev || kind == Kind::kPwritev;
  return !grows ? Action::kNone : writes ? Action::kShort : Action::kFail;  // half of it had room
}

void Plan::append(const char* text, std::size_t length) const noexcept {
  if (count_file_ == nullptr) return;
  // Past our own open() and write(), which would count them.
  const long file = syscall(SYS_openat, AT_FDCWD, count_file_, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) return;
  (void)syscall(SYS_write, file, text, length);
  (void)syscall(SYS_close, file);
}

namespace {

// A line made in place.
struct Line {
  char text[96] = {};
  std::size_t length = 0;

  void add(std::string_view piece) noexcept {
    for (const char c : piece) {
      if (length < sizeof text) text[length++] = c;
    }
  }
  void add(std::uint64_t number) noexcept {
    length = static_cast<std::size_t>(std::to_chars(text + length, text + sizeof text, number).ptr - text);
  }
};

}  // namespace

void Plan::note_strike(Kind kind) const noexcept {
  Line line;
  line.add("struck ");
  line.add(kNames[static_cast<std::size_t>(kind)]);
  line.add(" ");
  line.add(number_);
  line.add("\n");
  append(line.text, line.length);
}

void Plan::write_counts() const noexcept {
  for (std::size_t i = 0; i < kNumKinds; ++i) {
    const auto number = counts_[i].load();
    if (number == 0) continue;
    Line line;
    line.add(kNames[i]);
    line.add(" ");
    line.add(number);
    line.add("\n");
    append(line.text, line.length);
  }
}

void Plan::kill_process() noexcept {
  for (;;) (void)kill(getpid(), SIGKILL);
}

}  // namespace kith::faults
