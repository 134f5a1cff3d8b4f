#include "kith/files/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {

TemporaryFolder::TemporaryFolder(std::string_view name) {
  auto path = (std::filesystem::temp_directory_path() / (std::string{name} + "-XXXXXX")).string();
  if (mkdtemp(path.data()) == nullptr) {
    const auto why = std::generic_category().message(errno);
    throw Error{ErrorKind::kIo, "cannot make a temporary folder " + path + ": " + why};
  }
  path_ = std::move(path);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace kith
