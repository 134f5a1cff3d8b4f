// The calls that the shim puts itself in front of. Each asks the plan and then makes the call of the C library, makes
// half of it, fails, or kills the process.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>

#include "shim_plan.hpp"

namespace kith::faults {
namespace {

Plan& plan() noexcept {
  static Plan plan;
  return plan;
}

struct AtExit {
  AtExit() = default;
  AtExit(const AtExit&) = delete;
  AtExit& operator=(const AtExit&) = delete;
  ~AtExit() { plan().write_counts(); }
};

// The function of this name behind ours.
template <typename Function>
Function* next(const char* name) noexcept {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// Makes a call that is done as a whole or not at all.
template <typename Call>
auto make(Kind kind, bool concerns, bool grows, Call call) noexcept -> decltype(call()) {
  if (!concerns) return call();
  switch (plan().count(kind, grows)) {
    case Action::kKill:
      Plan::kill_process();
    case Action::kKillAfter:
    case Action::kTorn:
      (void)call();
      Plan::kill_process();
    case Action::kFail:
      errno = plan().error();
      return decltype(call())(-1);
    case Action::kNone:
    case Action::kShort:
      break;
  }
  return call();
}

// Makes a call that may write less than it is asked to; `call` is given the number of bytes.
template <typename Call>
ssize_t make_write(Kind kind, bool concerns, bool grows, size_t size, Call call) noexcept {
  if (!concerns) return call(size);
  const size_t half = size > 1 ? size / 2 : size;
  switch (plan().count(kind, grows)) {
    case Action::kKill:
      Plan::kill_process();
    case Action::kKillAfter:
      (void)call(size);
      Plan::kill_process();
    case Action::kTorn:
      (void)call(half);
      Plan::kill_process();
    case Action::kShort:
      return call(half);
    case Action::kFail:
      errno = plan().error();
      return -1;
    case Action::kNone:
      break;
  }
  return call(size);
}

// Whether writing there makes the file longer; what is overwritten has its space.
bool grows(int descriptor, off_t end) noexcept {
  struct stat status = {};
  return fstat(descriptor, &status) != 0 || end > status.st_size;
}

bool write_grows(int descriptor, size_t size) noexcept {
  const off_t at = lseek(descriptor, 0, SEEK_CUR);
  const int flags = fcntl(descriptor, F_GETFL);
  return at < 0 || (flags & O_APPEND) != 0 || grows(descriptor, at + static_cast<off_t>(size));
}

size_t size_of(const iovec* pieces, int number) noexcept {
  size_t size = 0;
  for (int i = 0; i < number; ++i) size += pieces[i].iov_len;
  return size;
}

// Calls `write` with pieces that hold `size` bytes together, at most eight of them.
template <typename Write>
ssize_t write_pieces(const iovec* pieces, int number, size_t size, Write write) noexcept {
  constexpr int kMost = 8;
  iovec some[kMost] = {};
  int used = 0;
  for (; used < std::min(number, kMost) && size > 0; ++used) {
    some[used] = {pieces[used].iov_base, std::min(size, pieces[used].iov_len)};
    size -= some[used].iov_len;
  }
  return write(some, used);
}

template <typename Open>
int make_open(int folder, const char* path, int flags, Open open) noexcept {
  const bool creates = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return make(Kind::kOpen, creates && plan().concerns_path_at(folder, path), true, open);
}

template <typename Call>
int make_allocate(int descriptor, Call call) noexcept {
  return make(Kind::kFallocate, plan().concerns_descriptor(descriptor), true, call);
}

bool is_folder(const char* path) noexcept {
  struct stat status = {};
  return lstat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

const AtExit at_exit;

}  // namespace
}  // namespace kith::faults

using kith::faults::Kind;
using kith::faults::make;
using kith::faults::make_allocate;
using kith::faults::make_open;
using kith::faults::make_write;
using kith::faults::next;
using kith::faults::plan;

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static const auto real = next<decltype(write)>("write");
  const bool concerns = plan().concerns_descriptor(descriptor);
  return make_write(Kind::kWrite, concerns, concerns && kith::faults::write_grows(descriptor, size), size,
                    [&](size_t n) { return real(descriptor, bytes, n); });
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t at) {
  static const auto real = next<decltype(pwrite)>("pwrite");
  const bool concerns = plan().concerns_descriptor(descriptor);
  return make_write(Kind::kPwrite, concerns, concerns && kith::faults::grows(descriptor, at + static_cast<off_t>(size)),
                    size, [&](size_t n) { return real(descriptor, bytes, n, at); });
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  return pwrite(descriptor, bytes, size, at);
}

ssize_t writev(int descriptor, const iovec* pieces, int number) {
  static const auto real = next<decltype(writev)>("writev");
  const bool concerns = plan().concerns_descriptor(descriptor);
  const auto size = kith::faults::size_of(pieces, number);
  return make_write(Kind::kWritev, concerns, concerns && kith::faults::write_grows(descriptor, size), size,
                    [&](size_t n) {
                      if (n == size) return real(descriptor, pieces, number);
                      return kith::faults::write_pieces(
                          pieces, number, n, [&](const iovec* some, int used) { return real(descriptor, some, used); });
                    });
}

ssize_t pwritev(int descriptor, const iovec* pieces, int number, off_t at) {
  static const auto real = next<decltype(pwritev)>("pwritev");
  const bool concerns = plan().concerns_descriptor(descriptor);
  const auto size = kith::faults::size_of(pieces, number);
  return make_write(Kind::kPwritev, concerns,
                    concerns && kith::faults::grows(descriptor, at + static_cast<off_t>(size)), size, [&](size_t n) {
                      if (n == size) return real(descriptor, pieces, number, at);
                      return kith::faults::write_pieces(pieces, number, n, [&](const iovec* some, int used) {
                        return real(descriptor, some, used, at);
                      });
                    });
}

ssize_t pwritev64(int descriptor, const iovec* pieces, int number, off64_t at) {
  return pwritev(descriptor, pieces, number, at);
}

int fsync(int descriptor) {
  static const auto real = next<decltype(fsync)>("fsync");
  return make(Kind::kFsync, plan().concerns_descriptor(descriptor), false, [&] { return real(descriptor); });
}

int fdatasync(int descriptor) {
  static const auto real = next<decltype(fdatasync)>("fdatasync");
  return make(Kind::kFdatasync, plan().concerns_descriptor(descriptor), false, [&] { return real(descriptor); });
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("rename");
  return make(Kind::kRename, plan().concerns_path(to) || plan().concerns_path(from), false,
              [&] { return real(from, to); });
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  static const auto real = next<int(int, const char*, int, const char*)>("renameat");
  return make(Kind::kRename, plan().concerns_path_at(to_folder, to), false,
              [&] { return real(from_folder, from, to_folder, to); });
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  static const auto real = next<int(int, const char*, int, const char*, unsigned)>("renameat2");
  return make(Kind::kRename, plan().concerns_path_at(to_folder, to), false,
              [&] { return real(from_folder, from, to_folder, to, flags); });
}

int link(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("link");
  return make(Kind::kLink, plan().concerns_path(to), true, [&] { return real(from, to); });
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  static const auto real = next<int(int, const char*, int, const char*, int)>("linkat");
  return make(Kind::kLink, plan().concerns_path_at(to_folder, to), true,
              [&] { return real(from_folder, from, to_folder, to, flags); });
}

int unlink(const char* path) noexcept {
  static const auto real = next<int(const char*)>("unlink");
  return make(Kind::kUnlink, plan().concerns_path(path), false, [&] { return real(path); });
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  static const auto real = next<int(int, const char*, int)>("unlinkat");
  const auto kind = (flags & AT_REMOVEDIR) != 0 ? Kind::kRmdir : Kind::kUnlink;
  return make(kind, plan().concerns_path_at(folder, path), false, [&] { return real(folder, path, flags); });
}

int rmdir(const char* path) noexcept {
  static const auto real = next<int(const char*)>("rmdir");
  return make(Kind::kRmdir, plan().concerns_path(path), false, [&] { return real(path); });
}

int remove(const char* path) noexcept {  // inside the C library it calls unlink() or rmdir() past us
  static const auto real = next<int(const char*)>("remove");
  const auto kind = kith::faults::is_folder(path) ? Kind::kRmdir : Kind::kUnlink;
  return make(kind, plan().concerns_path(path), false, [&] { return real(path); });
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = next<int(const char*, mode_t)>("mkdir");
  return make(Kind::kMkdir, plan().concerns_path(path), true, [&] { return real(path, mode); });
}

int mkdirat(int folder, const char* path, mode_t mode) noexcept {
  static const auto real = next<int(int, const char*, mode_t)>("mkdirat");
  return make(Kind::kMkdir, plan().concerns_path_at(folder, path), true, [&] { return real(folder, path, mode); });
}

int open(const char* path, int flags, ...) {
  static const auto real = next<int(const char*, int, ...)>("open");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);  // whatever it is where nothing is created
  va_end(rest);
  return make_open(AT_FDCWD, path, flags, [&] { return real(path, flags, mode); });
}

int open64(const char* path, int flags, ...) {
  static const auto real = next<int(const char*, int, ...)>("open64");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return make_open(AT_FDCWD, path, flags, [&] { return real(path, flags, mode); });
}

int openat(int folder, const char* path, int flags, ...) {
  static const auto real = next<int(int, const char*, int, ...)>("openat");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return make_open(folder, path, flags, [&] { return real(folder, path, flags, mode); });
}

int openat64(int folder, const char* path, int flags, ...) {
  static const auto real = next<int(int, const char*, int, ...)>("openat64");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return make_open(folder, path, flags, [&] { return real(folder, path, flags, mode); });
}

int creat(const char* path, mode_t mode) {
  static const auto real = next<int(const char*, mode_t)>("creat");
  return make_open(AT_FDCWD, path, O_CREAT, [&] { return real(path, mode); });
}

int creat64(const char* path, mode_t mode) { return creat(path, mode); }

// Streams open their files inside the C library, past us.
FILE* fopen(const char* path, const char* mode) {
  static const auto real = next<FILE*(const char*, const char*)>("fopen");
  const bool creates = std::strpbrk(mode, "wa") != nullptr && plan().concerns_path(path);
  FILE* file = nullptr;
  const int made = make(Kind::kOpen, creates, true, [&] {
    file = real(path, mode);
    return 0;
  });
  return made < 0 ? nullptr : file;
}

FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

int ftruncate(int descriptor, off_t size) noexcept {
  static const auto real = next<int(int, off_t)>("ftruncate");
  return make(Kind::kFtruncate, plan().concerns_descriptor(descriptor), false, [&] { return real(descriptor, size); });
}

int ftruncate64(int descriptor, off64_t size) noexcept { return ftruncate(descriptor, size); }

int fallocate(int descriptor, int mode, off_t at, off_t size) {
  static const auto real = next<int(int, int, off_t, off_t)>("fallocate");
  return make_allocate(descriptor, [&] { return real(descriptor, mode, at, size); });
}

int fallocate64(int descriptor, int mode, off64_t at, off64_t size) { return fallocate(descriptor, mode, at, size); }

int posix_fallocate(int descriptor, off_t at, off_t size) {  // returns the error instead of setting errno
  static const auto real = next<int(int, off_t, off_t)>("posix_fallocate");
  const int result = make_allocate(descriptor, [&] { return real(descriptor, at, size); });
  return result < 0 ? errno : result;
}

int posix_fallocate64(int descriptor, off64_t at, off64_t size) { return posix_fallocate(descriptor, at, size); }

int close(int descriptor) {
  static const auto real = next<decltype(close)>("close");
  // A close that fails closes all the same.
  int closed = 0;
  bool made = false;
  const int result = make(Kind::kClose, plan().concerns_descriptor(descriptor), false, [&] {
    made = true;
    return closed = real(descriptor);
  });
  if (!made) {
    const int error = errno;
    (void)real(descriptor);
    errno = error;
  }
  return result;
}

long syscall(long number, ...) noexcept {
  static const auto real = next<long(long, ...)>("syscall");
  va_list rest;
  va_start(rest, number);
  long a[6];
  for (auto& one : a) one = va_arg(rest, long);
  va_end(rest);
  const auto call = [&] { return real(number, a[0], a[1], a[2], a[3], a[4], a[5]); };
  if (number != SYS_renameat2) return call();
  const auto* const to = reinterpret_cast<const char*>(a[3]);
  return make(Kind::kRename, plan().concerns_path_at(static_cast<int>(a[2]), to), false, call);
}

}  // extern "C"
