#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "error_ids.hpp"

namespace kith {
namespace {

TEST(ExplainErrorIds, AreAllExplainedOnTheirPage) {
  const auto page = testing::text_of(std::filesystem::path{KITH_SOURCE_DIR} / "docs" / "errors-explain.md");
  for (const auto& id : testing::error_ids_in("explain")) {
    EXPECT_NE(page.find("| " + id + " |"), std::string::npos) << id;
  }
}

// Tests name the ids that they trigger.
TEST(ExplainErrorIds, AreAllTriggeredByATest) {
  std::string tests;
  for (const auto& file :
       std::filesystem::directory_iterator{std::filesystem::path{KITH_SOURCE_DIR} / "libs" / "explain" / "tests"}) {
    if (file.path().extension() == ".cpp") tests += testing::text_of(file.path());
  }
  for (const auto& id : testing::error_ids_in("explain")) EXPECT_NE(tests.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
