#pragma once

#include <string>
#include <vector>

namespace kith::cli {

/// A library that kith was built with.
struct Library {
  std::string name;
  std::string version;
};
[[nodiscard]] std::vector<Library> library_versions();

}  // namespace kith::cli
