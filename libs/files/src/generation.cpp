#include "kith/files/generation.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/folder_lock.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStagingPrefix = ".kith-staging-";
constexpr const char* kCommitted = ".kith-committed";  // the name of a generation from its commit until all is moved
constexpr const char* kContents = ".contents";         // in it: what is put in place and what is removed
constexpr const char* kReplaced = ".replaced";         // in it: what was there before

[[noreturn]] void fail_at(const std::string& action, const fs::path& path, int error) {
  throw Error{ErrorKind::kIo, "cannot " + action + " " + path.string() + ": " + std::generic_category().message(error)};
}

bool is_entry(const fs::path& path) {
  struct stat status = {};
  return lstat(path.c_str(), &status) == 0;
}

void move(const fs::path& from, const fs::path& to) {
  if (rename(from.c_str(), to.c_str()) != 0) fail_at("replace", to, errno);
}

void make_folder(const fs::path& path) {
  if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) fail_at("write to", path, errno);
}

// A line for each name: a sign, which tells what becomes of it, and the name.
constexpr char kPut = '+';
constexpr char kRemove = '-';

std::string contents_of(const fs::path& staging, const std::vector<std::string>& removed) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry{staging, error}, end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) fail_at("read", staging, error.value());
  std::sort(names.begin(), names.end());
  std::string text;
  for (const auto& name : names) text += kPut + name + "\n";
  for (const auto& name : removed) text += kRemove + name + "\n";
  return text;
}

// The bytes of files are on the disk; now the entries of all folders, the innermost first.
void synchronise_folders(const fs::path& folder) {
  std::vector<fs::path> inside;
  std::error_code error;
  for (fs::directory_iterator entry{folder, error}, end; !error && entry != end; entry.increment(error)) {
    if (entry->is_directory(error)) inside.push_back(entry->path());
  }
  if (error) fail_at("read", folder, error.value());
  for (const auto& one : inside) synchronise_folders(one);
  synchronise_folder(folder);
}

void remove_tree(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) fail_at("remove", path, error.value());
}

}  // namespace

bool is_generation(const std::string& name) { return name == kCommitted || name.rfind(kStagingPrefix, 0) == 0; }

Generation::Generation(fs::path folder) : folder_{std::move(folder)} {
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry{folder_, error}, end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().rfind(kStagingPrefix, 0) == 0) left.push_back(entry->path());
  }
  if (error) fail_at("read", folder_, error.value());
  for (const auto& one : left) remove_tree(one);  // by a run that was killed; we hold the lock
  staging_ = folder_ / (kStagingPrefix + std::to_string(getpid()));
  if (mkdir(staging_.c_str(), 0777) != 0) fail_at("write to", folder_, errno);
}

Generation::~Generation() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
}

void Generation::commit(const std::vector<std::string>& removed) {
  write_file_atomically(staging_ / kContents, contents_of(staging_, removed), FolderSync::kLater);
  make_folder(staging_ / kReplaced);
  synchronise_folders(staging_);
  move(staging_, folder_ / kCommitted);
  staging_.clear();
  synchronise_folder(folder_);
  settle(folder_);
}

bool is_unsettled(const fs::path& folder) { return is_entry(folder / kCommitted); }

void settle(const fs::path& folder) {
  const auto committed = folder / kCommitted;
  if (!is_entry(committed)) return;
  const auto contents = read_file(committed / kContents);
  for (std::size_t begin = 0; begin < contents.size();) {
    const auto end = std::min(contents.find('\n', begin), contents.size());
    const auto name = contents.substr(begin + 1, end - begin - 1);
    const bool put = contents[begin] == kPut;
    begin = end + 1;
    if (put && !is_entry(committed / name)) continue;  // it is in place
    if (is_entry(folder / name)) {
      remove_tree(committed / kReplaced / name);
      move(folder / name, committed / kReplaced / name);
    }
    if (put) move(committed / name, folder / name);
  }
  synchronise_folder(folder);
  // Under this name nobody takes it for something to finish; the next Generation removes what is left of it.
  const auto done = folder / (kStagingPrefix + std::to_string(getpid()) + "-done");
  move(committed, done);
  std::error_code ignored;
  fs::remove_all(done, ignored);
}

void settle_for_reading(const fs::path& folder) {
  constexpr int kAttempts = 20;  // of a tenth of a second each, in which a live process has long finished
  for (int attempt = 0; is_unsettled(folder); ++attempt) {
    if (const auto lock = FolderLock::try_acquire(folder)) return settle(folder);
    if (attempt == kAttempts) throw Error{ErrorKind::kBusy, "another process is writing to " + folder.string()};
  }
}

}  // namespace kith
