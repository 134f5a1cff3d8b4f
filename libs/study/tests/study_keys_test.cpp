// The keys of [teacher], [stop], [pace] and [record] are declared once; the page that explains them agrees.
#include "kith/study/study_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <variant>

namespace kith {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

// What docs/study-files.md says of a table of study files: key and default, as "* `key` (default): ...".
std::string rows_about(const std::string& table) {
  std::ifstream file{std::string{KITH_SOURCE_DIR} + "/docs/study-files.md"};
  std::string rows;
  bool is_there = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("`[", 0) == 0 || line.rfind("#", 0) == 0) is_there = line.rfind("`[" + table + "]`", 0) == 0;
    if (is_there) rows += line + "\n";
  }
  return rows;
}

TEST(StudyKeys, AreDocumentedWithTheirDefaults) {
  for (const std::string table : {"teacher", "stop", "pace", "record"}) {
    const auto rows = rows_about(table);
    EXPECT_FALSE(study_keys(table).empty());
    for (const auto& key : study_keys(table)) {
      const std::string name{key.name};
      EXPECT_FALSE(key.description.empty()) << table << '.' << name;
      const auto value = to_string(key.default_value);
      const auto is_word = std::holds_alternative<std::string>(key.default_value);
      const auto shown = value.empty() ? "" : is_word ? "`\"" + value + "\"`): " : value + "): ";
      EXPECT_THAT(rows, AnyOf(HasSubstr("* `" + name + "` (" + shown), HasSubstr("* `" + name + "` \\* (" + shown)));
    }
  }
  EXPECT_TRUE(study_keys("learner").empty());
}

}  // namespace
}  // namespace kith
