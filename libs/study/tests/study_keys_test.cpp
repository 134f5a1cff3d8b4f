// The keys of [teacher], [stop], [pace] and [record] are declared once; the page that explains them agrees.
#include "kith/study/study_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace kith {
namespace {

using ::testing::HasSubstr;

// The rows of the tables of docs/formats.md that are about a table of study files.
std::string rows_about(const std::string& table) {
  std::ifstream file{std::string{KITH_SOURCE_DIR} + "/docs/formats.md"};
  std::string rows;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("| `[" + table + "]`", 0) == 0 || line.rfind("| `" + table + ".", 0) == 0) rows += line + "\n";
  }
  return rows;
}

TEST(StudyKeys, AreDocumentedWithTheirDefaults) {
  for (const std::string table : {"teacher", "stop", "pace", "record"}) {
    const auto rows = rows_about(table);
    EXPECT_FALSE(study_keys(table).empty());
    for (const auto& key : study_keys(table)) {
      const std::string name{key.name};
      const bool is_documented = rows.find("`" + name + "`") != std::string::npos ||
                                 rows.find("`" + table + "." + name + "`") != std::string::npos;
      EXPECT_TRUE(is_documented) << table << '.' << name;
      EXPECT_FALSE(key.description.empty()) << table << '.' << name;
      if (rows.find("`" + name + "` (") == std::string::npos) continue;
      const auto value = to_string(key.default_value);
      EXPECT_TRUE(rows.find("`" + name + "` (" + value) != std::string::npos ||
                  rows.find("`" + name + "` (`\"" + value + "\"`") != std::string::npos)
          << table << '.' << name << " is " << value << " by default";
    }
  }
  EXPECT_TRUE(study_keys("learner").empty());
}

}  // namespace
}  // namespace kith
