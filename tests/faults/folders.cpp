#include "folders.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kRoom = std::uintmax_t{256} << 20;  // bytes

fs::path place() {
  std::error_code error;
  const auto space = fs::space("/dev/shm", error);
  return !error && space.available > kRoom ? fs::path{"/dev/shm"} : fs::temp_directory_path();
}

}  // namespace

Scratch::Scratch() {
  std::string name = (place() / "kith-faults-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw Error{ErrorKind::kIo, "cannot make the folder " + name + ": " + std::generic_category().message(errno)};
  }
  path_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  if (!kept_) fs::remove_all(path_, ignored);
}

void copy_folder(const fs::path& from, const fs::path& to) {
  fs::copy(from, to, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
}

std::vector<std::string> names_below(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::is_directory(folder)) return names;
  for (const auto& entry : fs::recursive_directory_iterator{folder}) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Files files_below(const fs::path& folder) {
  Files files;
  for (const auto& name : names_below(folder)) files[name] = read_file(folder / name);
  return files;
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file{path, std::ios::binary | std::ios::trunc};
  file << text;
  file.close();
  if (!file) throw Error{ErrorKind::kIo, "cannot write " + path.string()};
}

}  // namespace kith::faults
