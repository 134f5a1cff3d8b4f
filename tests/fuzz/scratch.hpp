#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzzing.hpp"

namespace kith::fuzzing {

/// A folder of its own, in memory where there is such a place, removed at the end.
class Scratch {
 public:
  Scratch() {
    namespace fs = std::filesystem;
    std::error_code failure;
    const fs::path memory = "/dev/shm";
    std::string name =
        ((fs::is_directory(memory, failure) ? memory : fs::temp_directory_path()) / "kith-XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr, "there is a place for a folder");
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace kith::fuzzing
