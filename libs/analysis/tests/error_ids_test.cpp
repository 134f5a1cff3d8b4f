#include "error_ids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kith {
namespace {

namespace fs = std::filesystem;

// The ids of docs/errors-analysis.md whose row "| E0901 | meaning | example |" has a meaning and an example.
std::set<std::string> documented_with_an_example() {
  static const std::regex kRow{R"re(\| (E09[0-9]{2}) \| [^|]*[^| ][^|]* \| [^|]*[^| ][^|]* \|)re"};
  std::set<std::string> ids;
  std::istringstream lines{testing::text_of(fs::path{KITH_SOURCE_DIR} / "docs" / "errors-analysis.md")};
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch row; std::regex_match(line, row, kRow)) ids.insert(row[1]);
  }
  return ids;
}

TEST(AnalysisErrors, AreAllDocumentedWithAnExample) {
  const auto ids = testing::error_ids_in("analysis");
  ASSERT_GE(ids.size(), 9u);  // the scan found the sources
  EXPECT_EQ(documented_with_an_example(), ids);
}

TEST(AnalysisErrors, AreAllTested) {
  const auto tests = testing::tests_of("analysis");
  ASSERT_FALSE(tests.empty());
  for (const auto& id : testing::error_ids_in("analysis")) EXPECT_THAT(tests, ::testing::HasSubstr('"' + id + '"'));
}

}  // namespace
}  // namespace kith
