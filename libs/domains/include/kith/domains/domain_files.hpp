#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kith {

/// A file that a domain file names: a part of an explicit model.
struct DomainFile {
  std::string name;  ///< As the domain file says it, relative to its folder.
  std::string text;
  friend bool operator==(const DomainFile&, const DomainFile&) = default;
};

/// Where the files are that a domain file names.
struct DomainFiles {
  std::filesystem::path folder{};      ///< That of the domain file; empty: the working directory.
  std::vector<DomainFile> known = {};  ///< Files that need not be read any more.
};

}  // namespace kith
