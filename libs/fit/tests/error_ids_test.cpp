#include <gtest/gtest.h>

#include "error_ids.hpp"

namespace kith {
namespace {

TEST(FitErrorIds, AreAllExplainedOnTheirPage) {
  const auto page = testing::text_of(std::filesystem::path{KITH_SOURCE_DIR} / "docs" / "errors-fit.md");
  for (const auto& id : testing::error_ids_in("fit")) {
    EXPECT_NE(page.find("| " + id + " |"), std::string::npos) << id;
  }
}

// Tests name the ids that they trigger.
TEST(FitErrorIds, AreAllTriggeredByATest) {
  const auto tests = testing::tests_of("fit");
  for (const auto& id : testing::error_ids_in("fit")) EXPECT_NE(tests.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
