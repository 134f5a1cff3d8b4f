#include "error_ids.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace kith {
namespace {

std::string text_of_files(const std::filesystem::path& folder, const std::string& prefix,
                          const std::string& extension) {
  std::string text;
  for (const auto& file : std::filesystem::directory_iterator{folder}) {
    const auto name = file.path().filename().string();
    if (name.rfind(prefix, 0) == 0 && file.path().extension() == extension) text += testing::text_of(file.path());
  }
  return text;
}

TEST(RunErrorIds, AreAllExplainedOnAPage) {
  const auto pages = text_of_files(std::filesystem::path{KITH_SOURCE_DIR} / "docs", "errors", ".md");
  for (const auto& id : testing::error_ids_in("runs")) EXPECT_NE(pages.find("| " + id + " |"), std::string::npos) << id;
}

// Tests name the ids that they trigger; those of damaged run folders are triggered where runs are read.
TEST(RunErrorIds, AreAllTriggeredByATest) {
  std::string tests;
  for (const auto* layer : {"runs", "report"}) {
    tests += text_of_files(std::filesystem::path{KITH_SOURCE_DIR} / "libs" / layer / "tests", "", ".cpp");
  }
  for (const auto& id : testing::error_ids_in("runs")) EXPECT_NE(tests.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
