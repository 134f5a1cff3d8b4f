#include "error_ids.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

// Each of these ids has a test of its own in analysis_test.cpp or dataset_test.cpp.
TEST(AnalysisErrors, AreAllDocumentedWithAnExample) {
  for (const auto& id : testing::error_ids_in("analysis")) {
    EXPECT_NE(testing::text_of(std::filesystem::path{KITH_SOURCE_DIR} / "docs" / "errors-analysis.md").find("| " + id),
              std::string::npos)
        << id;
  }
}

}  // namespace
}  // namespace kith
