// What becomes of runs whatever happens to them: every call that changes a file is the last one, or fails, once.
// Nothing that was there before is lost, nothing that is half done passes for whole, and the same command finishes the
// run.
#include <dlfcn.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <fstream>
#include <new>
#include <span>

#include "kith/files/published_run.hpp"
#include "kith/runs/merge.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/runs/verify.hpp"
#include "study_runs.hpp"

namespace kith::testing {
namespace {

constexpr int kStruck = 77;  // exit code of a process that ended in a call

enum class Strike { kKill, kTear, kFail, kFull, kShort };

// Counts the calls of this process that change files, and strikes one of them.
struct Calls {
  std::atomic<bool> counting = false;
  std::atomic<std::size_t> count = 0, struck_at = 0;  // 0: none
  std::atomic<std::size_t> struck = 0;
  Strike strike = Strike::kKill;

  // Whether this call is struck: the one, or where the disk is full it and all after it that need room.
  bool strikes(bool grows) {
    if (!counting) return false;
    const auto now = ++count;
    if (struck_at == 0) return false;
    const bool does = strike == Strike::kFull ? grows && now >= struck_at : now == struck_at;
    if (does) ++struck;
    if (does && strike == Strike::kKill) _exit(kStruck);
    return does;
  }
};

Calls& calls() {
  static Calls calls;
  return calls;
}

// The function of this name behind ours.
template <typename Function>
Function* behind(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// A call that is done as a whole or not at all.
template <typename Call>
int whole(bool grows, Call call) {
  if (!calls().strikes(grows) || calls().strike == Strike::kShort) return call();
  if (calls().strike == Strike::kTear) {
    (void)call();
    _exit(kStruck);
  }
  errno = calls().strike == Strike::kFull ? ENOSPC : EIO;
  return -1;
}

// A call that may write less than it is asked to.
template <typename Call>
ssize_t write_some(int descriptor, std::size_t size, Call call) {
  if (descriptor <= STDERR_FILENO || !calls().strikes(true)) return call(size);
  const auto half = size > 1 ? size / 2 : size;
  switch (calls().strike) {
    case Strike::kShort:
      return call(half);
    case Strike::kTear:
      (void)call(half);
      _exit(kStruck);
    default:
      errno = calls().strike == Strike::kFull ? ENOSPC : EIO;
      return -1;
  }
}

template <typename Open>
int open_there(int flags, Open open) {
  return (flags & O_CREAT) == 0 ? open() : whole(true, open);
}

mode_t mode_in(int flags, va_list arguments) { return (flags & O_CREAT) == 0 ? 0 : va_arg(arguments, mode_t); }

}  // namespace
}  // namespace kith::testing

using kith::testing::behind;
using kith::testing::mode_in;
using kith::testing::open_there;
using kith::testing::whole;
using kith::testing::write_some;

// In front of those of the C library, for this program and all libraries that it has loaded.
extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static const auto real = behind<decltype(write)>("write");
  return write_some(descriptor, size, [&](size_t n) { return real(descriptor, bytes, n); });
}
ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  static const auto real = behind<decltype(pwrite64)>("pwrite64");
  return write_some(descriptor, size, [&](size_t n) { return real(descriptor, bytes, n, at); });
}
ssize_t writev(int descriptor, const iovec* pieces, int number) {
  static const auto real = behind<decltype(writev)>("writev");
  return whole(true, [&] { return static_cast<int>(real(descriptor, pieces, number)); });
}
int fsync(int descriptor) {  // nothing here loses its power
  (void)descriptor;
  return whole(false, [] { return 0; });
}
int fdatasync(int descriptor) { return fsync(descriptor); }
int ftruncate64(int descriptor, off64_t size) noexcept {
  static const auto real = behind<decltype(ftruncate64)>("ftruncate64");
  return whole(false, [&] { return real(descriptor, size); });
}
int rename(const char* from, const char* to) noexcept {
  static const auto real = behind<decltype(rename)>("rename");
  return whole(false, [&] { return real(from, to); });
}
int unlink(const char* path) noexcept {
  static const auto real = behind<decltype(unlink)>("unlink");
  return whole(false, [&] { return real(path); });
}
int unlinkat(int folder, const char* path, int flags) noexcept {
  static const auto real = behind<decltype(unlinkat)>("unlinkat");
  return whole(false, [&] { return real(folder, path, flags); });
}
int remove(const char* path) noexcept {  // calls unlink() or rmdir() inside the C library
  static const auto real = behind<decltype(remove)>("remove");
  return whole(false, [&] { return real(path); });
}
int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = behind<decltype(mkdir)>("mkdir");
  return whole(true, [&] { return real(path, mode); });
}
int open(const char* path, int flags, ...) {
  static const auto real = behind<int(const char*, int, mode_t)>("open");
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_there(flags, [&] { return real(path, flags, mode); });
}
int open64(const char* path, int flags, ...) {
  static const auto real = behind<int(const char*, int, mode_t)>("open64");
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_there(flags, [&] { return real(path, flags, mode); });
}
int openat(int folder, const char* path, int flags, ...) {
  static const auto real = behind<int(int, const char*, int, mode_t)>("openat");
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = mode_in(flags, arguments);
  va_end(arguments);
  return open_there(flags, [&] { return real(folder, path, flags, mode); });
}

}  // extern "C"

namespace kith::testing {
namespace {

namespace fs = std::filesystem;

// How many teams are saved, also by a process that has ended.
std::atomic<std::size_t>& saved() {
  static auto* const kSaved =
      new (mmap(nullptr, sizeof(std::atomic<std::size_t>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
          std::atomic<std::size_t>{0};
  return *kSaved;
}

StudyRunOptions alone() {
  auto options = how();
  options.threads = 1;
  options.on_progress = [](std::size_t, std::size_t, std::size_t) { ++saved(); };
  return options;
}

// A run in a folder: what is there when it begins, and what is done.
struct Story {
  std::string name;
  std::function<void(const fs::path&)> before = [](const fs::path&) {};
  std::function<std::size_t(const fs::path&)> act;  // the teams that it took up
  bool is_anew = false;                             // whether teams that were saved are not
};

std::size_t finish_in(const fs::path& folder, StudyRunOptions options = alone()) {
  StudyRun run{folder, quick_study(), std::move(options)};
  const auto resumed = run.num_resumed();
  EXPECT_TRUE(run.teach(item_delivery()));
  (void)run.publish({});
  return resumed;
}

void finish_other_in(const fs::path& folder) {
  StudyRun run{folder, quick_study({"seed=2"}), how()};
  EXPECT_TRUE(run.teach(item_delivery()));
  (void)run.publish({});
}

std::vector<fs::path> shards_beside(const fs::path& folder) {
  return {folder.parent_path() / "1", folder.parent_path() / "2"};
}

void make_shard(const fs::path& folder, std::size_t which) {
  auto options = how();
  options.shard = {which, 2};
  StudyRun run{folder, quick_study(), options};
  EXPECT_TRUE(run.teach(item_delivery()));
  run.publish_shard({});
}

std::vector<Story> stories() {
  std::vector<Story> all;
  const auto act = [](const fs::path& folder) { return finish_in(folder); };
  all.push_back({"plain", [](const fs::path&) {}, act});
  all.push_back({"resume", [](const fs::path& folder) { run_partly(folder, 3); }, act});
  all.push_back({"salvage",
                 [](const fs::path& folder) {
                   run_partly(folder, 5);
                   fs::resize_file(folder / kJournalFile, fs::file_size(folder / kJournalFile) - 4096);
                 },
                 act});
  all.push_back({"grow",
                 [](const fs::path& folder) {
                   StudyRun fewer{folder, quick_study({"replicates=2"}), how()};
                   EXPECT_TRUE(fewer.teach(item_delivery()));
                   (void)fewer.publish({});
                 },
                 act});
  auto replace = alone();
  replace.replace = true;
  all.push_back({"replace", finish_other_in, [replace](const fs::path& folder) { return finish_in(folder, replace); }});
  auto anew = alone();
  anew.resume = Resume::kNever;
  all.push_back({"anew", [](const fs::path& folder) { (void)run(folder); },
                 [anew](const fs::path& folder) { return finish_in(folder, anew); }, true});
  all.push_back({"merge",
                 [](const fs::path& folder) {
                   for (const std::size_t which : {1u, 2u}) make_shard(shards_beside(folder)[which - 1], which);
                 },
                 [](const fs::path& folder) {
                   StudyRun merged{folder, quick_study(), alone()};
                   for (const auto& shard : open_shards(shards_beside(folder), "kith test").journals)
                     merged.take_up(shard);
                   (void)merged.publish({});
                   return merged.num_resumed();
                 },
                 true});
  return all;
}

Tables tables_if_any(const fs::path& folder) { return fs::exists(folder / "tables") ? tables_in(folder) : Tables{}; }

// Acts in a process of its own, or in this one. @return whether it came to its end without an error.
bool acts(const Story& story, const fs::path& folder, bool apart) {
  if (!apart) {
    calls().counting = true;
    bool ended = false;
    try {
      (void)story.act(folder);
      ended = true;
    } catch (const Error&) {
    }
    calls().counting = false;
    return ended;
  }
  const auto child = fork();
  if (child == 0) {
    calls().counting = true;
    (void)story.act(folder);
    _exit(0);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == kStruck)) << status;
  return WEXITSTATUS(status) == 0;
}

// From what is in `ready`: call n is struck, then the same is done in peace. @return whether there was such a call.
bool survives(const Story& story, const fs::path& ready, Strike strike, std::size_t n) {
  const ScratchFolder scratch;
  const auto folder = scratch / "run";
  fs::copy(ready, scratch.path(), fs::copy_options::recursive);
  const auto before = tables_if_any(folder);
  calls().strike = strike;
  calls().count = calls().struck = saved() = 0;
  calls().struck_at = n;
  const bool apart = strike == Strike::kKill || strike == Strike::kTear;
  const bool ended = acts(story, folder, apart);
  const bool was_struck = apart ? !ended : calls().struck > 0;
  calls().struck_at = 0;
  const auto told = ::testing::Message() << story.name << ", strike " << static_cast<int>(strike) << " at call " << n;
  const auto between = tables_if_any(folder);
  if (ended) {
    EXPECT_EQ(between, expected()) << told;
  } else {
    EXPECT_NE(strike, Strike::kShort) << told;
    EXPECT_TRUE(between.empty() || between == before || between == expected()) << told;
  }
  if (n % 2 == 0 && fs::exists(folder / kManifestFile)) {  // then all that it names is of one run
    const auto published = PublishedRun::open(folder);
    for (const auto& [name, hash] : published.hashes()) EXPECT_NO_THROW((void)published.read(name)) << told;
  }
  const std::size_t kept = saved();
  try {
    const auto resumed = story.act(folder);
    EXPECT_TRUE(story.is_anew || resumed >= std::min<std::size_t>(kept, 6))
        << told << ": " << resumed << " of " << kept;
  } catch (const Error& error) {
    ADD_FAILURE() << told << ", then " << error.what();
  }
  EXPECT_EQ(tables_if_any(folder), expected()) << told;
  return was_struck;
}

std::size_t calls_of(const Story& story, const fs::path& ready) {
  const ScratchFolder scratch;
  fs::copy(ready, scratch.path(), fs::copy_options::recursive);
  calls().count = 0;
  EXPECT_TRUE(acts(story, scratch / "run", false));
  return calls().count;
}

// One call of `stride` of every story, each with one of the strikes: the next one with the next.
void sweep(std::span<const Strike> strikes, std::size_t first, std::size_t stride) {
  std::size_t offset = first;
  for (const auto& story : stories()) {
    const ScratchFolder ready;
    story.before(ready / "run");
    const auto most = calls_of(story, ready.path());
    EXPECT_GT(most, 20u) << story.name;
    std::size_t struck = 0, tried = 0;
    for (auto n = 1 + offset++ % stride; n <= most && !::testing::Test::HasFailure(); n += stride) {
      struck += survives(story, ready.path(), strikes[(first + tried++) % strikes.size()], n) ? 1u : 0u;
    }
    EXPECT_GT(struck, tried / 2) << story.name;
  }
}

// Whether a run is refused, or does not pass for what its program would write again.
bool is_refused(const fs::path& folder) {
  try {
    const auto reading = read_run_folder(folder);
    return !reading.study || !verify_run(folder, reading, item_delivery(), {}).mismatches.empty();
  } catch (const Error&) {
    return true;
  }
}

// A finished run of which a file is cut, changed or another run's: a file that results follow from is the one that was
// written, or the run is refused. A page of the journal may hold nothing; nothing follows from times and the log.
TEST(EveryFile, CanBeDamaged) {
  const ScratchFolder scratch;
  const auto sound = scratch / "sound", other = scratch / "other", folder = scratch / "run";
  (void)run(sound);
  finish_other_in(other);
  for (const auto& entry : fs::recursive_directory_iterator{sound}) {
    const auto name = entry.path().lexically_relative(sound);
    for (int how = 0; how < 3 && entry.is_regular_file(); ++how) {
      fs::remove_all(folder);
      fs::copy(sound, folder, fs::copy_options::recursive);
      auto text = read_file(how == 2 ? other / name : sound / name);
      if (how == 0) text.resize(text.size() / 2);
      if (how == 1 && !text.empty()) text[text.size() / 2] = static_cast<char>(text[text.size() / 2] ^ 4);
      std::ofstream{folder / name, std::ios::binary} << text;
      auto options = alone();
      options.replace = options.rebuild = true;
      const bool is_named = name != "timings.csv" && name != "log.txt" && name != kJournalFile;
      EXPECT_TRUE(is_refused(folder) || (is_named ? text == read_file(sound / name) : tables_in(folder) == expected()))
          << name << how;
      (void)finish_in(folder, options);
      EXPECT_EQ(tables_in(folder), expected()) << name << how;
    }
  }
}

constexpr std::array kEnds{Strike::kKill, Strike::kTear};
constexpr std::array kFailures{Strike::kFail, Strike::kFull, Strike::kShort};

TEST(EveryWrite, CanBeTheLast) { sweep(kEnds, 0, 15); }

TEST(EveryWrite, CanFail) { sweep(kFailures, 0, 15); }

TEST(EveryWriteSlow, CanBeTheLast) {
  for (const std::size_t first : {0u, 1u}) sweep(kEnds, first, 1);
}

TEST(EveryWriteSlow, CanFail) {
  for (const std::size_t first : {0u, 1u, 2u}) sweep(kFailures, first, 1);
}

}  // namespace
}  // namespace kith::testing
