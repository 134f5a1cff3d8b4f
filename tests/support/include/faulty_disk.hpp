#pragma once

#include <sqlite3.h>

#include <atomic>
#include <cstddef>

namespace kith::testing {

/// A disk that fails on demand: a layer in front of SQLite's own file system that counts every operation which can
/// change a file, and fails some of them. One per process; the default of all databases opened while it lives.
class FaultyDisk {
 public:
  enum class Fault { kInputOutput, kFull, kShortWrite };

  FaultyDisk() {
    real() = sqlite3_vfs_find(nullptr);
    auto& vfs = shim();
    vfs = *real();
    vfs.zName = "kith-faulty";
    vfs.szOsFile = static_cast<int>(sizeof(File)) + real()->szOsFile;
    vfs.xOpen = open;
    sqlite3_vfs_register(&vfs, 1);
    heal();
  }
  ~FaultyDisk() {
    sqlite3_vfs_unregister(&shim());
    sqlite3_vfs_register(real(), 1);
  }
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;

  /// From the n-th operation from now on (1: the next), `times` operations fail.
  static void fail(std::size_t n, std::size_t times, Fault fault) {
    state().fault = fault;
    state().first = state().count.load() + n;
    state().last = state().first + times - 1;
  }
  static void heal() { state().first = state().last = 0; }
  /// Operations so far.
  [[nodiscard]] static std::size_t count() { return state().count; }
  /// Operations that failed so far.
  [[nodiscard]] static std::size_t num_failed() { return state().failed; }

 private:
  struct State {
    std::atomic<std::size_t> count = 0, failed = 0, first = 0, last = 0;
    std::atomic<Fault> fault = Fault::kInputOutput;
  };
  struct File {
    sqlite3_file base;
    sqlite3_io_methods methods;
  };

  static State& state() {
    static State state;
    return state;
  }
  static sqlite3_vfs*& real() {
    static sqlite3_vfs* real = nullptr;
    return real;
  }
  static sqlite3_vfs& shim() {
    static sqlite3_vfs shim;
    return shim;
  }
  static sqlite3_file* real_file(sqlite3_file* file) {
    return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + sizeof(File));
  }
  // Whether this operation is to fail.
  static bool strikes() {
    const auto now = ++state().count;
    const bool does = state().first != 0 && now >= state().first && now <= state().last;
    if (does) ++state().failed;
    return does;
  }
  static int code(int of_input_output) { return state().fault == Fault::kInputOutput ? of_input_output : SQLITE_FULL; }

  static int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out) {
    file->pMethods = nullptr;
    if ((flags & SQLITE_OPEN_CREATE) != 0 && strikes()) return SQLITE_CANTOPEN;
    const int result = real()->xOpen(real(), name, real_file(file), flags, out);
    if (result != SQLITE_OK) return result;
    auto& methods = reinterpret_cast<File*>(file)->methods;
    methods = *real_file(file)->pMethods;
    methods.xClose = [](sqlite3_file* f) { return real_file(f)->pMethods->xClose(real_file(f)); };
    methods.xRead = [](sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
      return real_file(f)->pMethods->xRead(real_file(f), to, n, at);
    };
    methods.xWrite = write;
    methods.xTruncate = [](sqlite3_file* f, sqlite3_int64 size) {
      return strikes() ? SQLITE_IOERR_TRUNCATE : real_file(f)->pMethods->xTruncate(real_file(f), size);
    };
    methods.xSync = [](sqlite3_file* f, int how) {
      return strikes() ? SQLITE_IOERR_FSYNC : real_file(f)->pMethods->xSync(real_file(f), how);
    };
    methods.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
      return real_file(f)->pMethods->xFileSize(real_file(f), size);
    };
    methods.xLock = [](sqlite3_file* f, int how) { return real_file(f)->pMethods->xLock(real_file(f), how); };
    methods.xUnlock = [](sqlite3_file* f, int how) { return real_file(f)->pMethods->xUnlock(real_file(f), how); };
    methods.xCheckReservedLock = [](sqlite3_file* f, int* is) {
      return real_file(f)->pMethods->xCheckReservedLock(real_file(f), is);
    };
    methods.xFileControl = [](sqlite3_file* f, int what, void* with) {
      return real_file(f)->pMethods->xFileControl(real_file(f), what, with);
    };
    methods.xSectorSize = [](sqlite3_file* f) { return real_file(f)->pMethods->xSectorSize(real_file(f)); };
    methods.xDeviceCharacteristics = [](sqlite3_file* f) {
      return real_file(f)->pMethods->xDeviceCharacteristics(real_file(f));
    };
    methods.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** map) {
      return real_file(f)->pMethods->xShmMap(real_file(f), page, size, extend, map);
    };
    methods.xShmLock = [](sqlite3_file* f, int at, int n, int flags_of_lock) {
      return real_file(f)->pMethods->xShmLock(real_file(f), at, n, flags_of_lock);
    };
    methods.xShmBarrier = [](sqlite3_file* f) { real_file(f)->pMethods->xShmBarrier(real_file(f)); };
    methods.xShmUnmap = [](sqlite3_file* f, int remove) {
      return real_file(f)->pMethods->xShmUnmap(real_file(f), remove);
    };
    methods.iVersion = 2;  // without memory mapping
    file->pMethods = &methods;
    return SQLITE_OK;
  }

  static int write(sqlite3_file* file, const void* from, int n, sqlite3_int64 at) {
    if (!strikes()) return real_file(file)->pMethods->xWrite(real_file(file), from, n, at);
    if (state().fault == Fault::kShortWrite && n > 1)
      (void)real_file(file)->pMethods->xWrite(real_file(file), from, n / 2, at);
    return code(SQLITE_IOERR_WRITE);
  }
};

}  // namespace kith::testing
