#include "kith/files/file_set.hpp"

#include <system_error>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {

FileSet::FileSet(std::filesystem::path folder) : folder_{std::move(folder)} {
  std::error_code failure;
  // A link that leads nowhere is somebody's, too.
  made_ = !std::filesystem::exists(std::filesystem::symlink_status(folder_, failure));
  std::filesystem::create_directories(folder_, failure);
  // A name with a slash behind it is reported as no folder although it was made.
  if (failure && !std::filesystem::is_directory(folder_))
    throw Error{ErrorKind::kIo, "cannot make the folder " + folder_.string() + ": " + failure.message()};
  try {
    lock_ = FolderLock::try_acquire(folder_);
    if (!lock_) throw Error{ErrorKind::kBusy, "another process is writing to " + folder_.string()};
    settle(folder_);
    generation_.emplace(folder_);
  } catch (...) {
    if (made_) std::filesystem::remove(folder_, failure);  // only if it is empty
    throw;
  }
}

FileSet::~FileSet() {
  files_.clear();
  const bool is_done = !generation_;
  generation_.reset();
  std::error_code ignored;
  if (made_ && !is_done) std::filesystem::remove(folder_, ignored);  // only if it is empty
}

void FileSet::write(const std::string& name, std::string_view piece) {
  auto& file = files_[name];
  if (!file) {
    std::error_code ignored;
    const auto path = folder_ / name;
    const auto there = std::filesystem::symlink_status(path, ignored);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
      throw Error{ErrorKind::kIo, "cannot write " + path.string() + ": something else than a file is there"};
    file = std::make_unique<AtomicFile>(generation_->path() / name);
  }
  file->write(piece);
}

void FileSet::commit(const std::set<std::string>& removed) {
  for (auto& [name, file] : files_) file->commit(FolderSync::kLater);
  std::vector<std::string> gone;
  for (const auto& name : removed) {
    if (files_.count(name) == 0) gone.push_back(name);
  }
  generation_->commit(gone);
  generation_.reset();
}

}  // namespace kith
