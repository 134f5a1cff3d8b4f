#pragma once

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace kith::testing {

[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in{path, std::ios::binary};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The texts of all tests of a layer.
[[nodiscard]] inline std::string tests_of(const std::string& layer) {
  std::string text;
  for (const auto& file :
       std::filesystem::directory_iterator{std::filesystem::path{KITH_SOURCE_DIR} / "libs" / layer / "tests"}) {
    if (file.path().extension() == ".cpp") text += text_of(file.path());
  }
  return text;
}

/// Every diagnostic id ("E0312") that stands as a string in the sources of a layer.
[[nodiscard]] inline std::set<std::string> error_ids_in(const std::string& layer) {
  static const std::regex kId{R"re("([EW][01][0-9]{3})")re"};
  std::set<std::string> ids;
  for (const auto& file :
       std::filesystem::directory_iterator{std::filesystem::path{KITH_SOURCE_DIR} / "libs" / layer / "src"}) {
    const std::string text = text_of(file.path());
    for (std::sregex_iterator it{text.begin(), text.end(), kId}; it != std::sregex_iterator{}; ++it) {
      ids.insert((*it)[1]);
    }
  }
  return ids;
}

}  // namespace kith::testing
