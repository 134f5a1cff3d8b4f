#pragma once

#include <filesystem>
#include <fstream>
#include <map>
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

/// The texts of the files directly in a folder of the source whose names begin and end like this, one after the other.
[[nodiscard]] inline std::string text_of_files(const std::filesystem::path& folder, const std::string& prefix,
                                               const std::string& extension) {
  std::string text;
  for (const auto& file : std::filesystem::directory_iterator{std::filesystem::path{KITH_SOURCE_DIR} / folder}) {
    const auto name = file.path().filename().string();
    if (name.rfind(prefix, 0) == 0 && file.path().extension() == extension) text += text_of(file.path());
  }
  return text;
}

/// The texts of all pages about errors.
[[nodiscard]] inline std::string error_pages() { return text_of_files("docs", "errors", ".md"); }

/// The texts of all tests of a layer.
[[nodiscard]] inline std::string tests_of(const std::string& layer) {
  return text_of_files(std::filesystem::path{"libs"} / layer / "tests", "", ".cpp");
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

/// The rows of docs/errors.md, "| E0312 | what it means | `example` |": id -> description.
/// Rows without a description or an example are left out.
[[nodiscard]] inline std::map<std::string, std::string> documented_errors() {
  static const std::regex kRow{R"re(\| ([EW]0[0-9]{3}) \| ([^|]+) \| (`[^`]+`.*) \|)re"};
  std::map<std::string, std::string> rows;
  std::istringstream lines{text_of(std::filesystem::path{KITH_SOURCE_DIR} / "docs" / "errors.md")};
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch row; std::regex_match(line, row, kRow)) rows.emplace(row[1], row[2]);
  }
  return rows;
}

}  // namespace kith::testing
