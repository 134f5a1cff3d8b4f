// What an analysis says beside its numbers where these could mislead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "findings.hpp"
#include "kith/analysis/exports.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::quick;
using testing::table_named;

Analysis analysis_of(const std::string& text, const ModelQuestion& question) {
  return analyze_table(Dataset::parse(text, "t.csv"), question, quick());
}

// Rows of a table with the columns a, b and y; `cells` has the levels of each group of three rows.
std::string crossed_rows(const std::vector<std::pair<std::string, std::string>>& cells) {
  std::string text = "a,b,y\n";
  int i = 0;
  for (const auto& [a, b] : cells) {
    for (int row = 0; row < 3; ++row, ++i) text += a + "," + b + "," + std::to_string(i * 7 % 11) + "\n";
  }
  return text;
}

// "C - A", "C - B", ... fail for the same reason, and the levels of a cannot be compared at all.
TEST(Notes, SayOnceWhyLevelsCannotBeCompared) {
  const auto text = crossed_rows({{"x", "A"}, {"y", "A"}, {"x", "B"}, {"y", "B"}, {"x", "C"}, {"x", "D"}});
  const auto found = analysis_of(text, {"y ~ a*b"}).findings.front();
  EXPECT_THAT(found.warnings, Contains(HasSubstr("the levels of a cannot be compared: no observation has")));
  EXPECT_THAT(found.warnings, Contains(AllOf(HasSubstr("C - A"), HasSubstr("C - B"), HasSubstr("D - C"),
                                             HasSubstr("cannot be estimated: no observation has"))));
  const auto about_pairs = [](const std::string& warning) { return warning.find(" - ") != std::string::npos; };
  EXPECT_LE(std::count_if(found.warnings.begin(), found.warnings.end(), about_pairs), 2);
}

// R: rstudent(lm(y ~ g)) of the last value is 105.695.
TEST(Notes, NameFarValues) {
  std::string text = "g,y\n";
  for (int i = 0; i < 40; ++i) text += (i % 2 == 0 ? "a," : "b,") + std::to_string(50 + i * 7 % 11) + "\n";
  EXPECT_THAT(analysis_of(text, {"y ~ g"}).findings.front().warnings, Not(Contains(HasSubstr("far from the others"))));
  const auto found = analysis_of(text + "b,412\n", {"y ~ g"}).findings.front();
  EXPECT_THAT(found.warnings, Contains(HasSubstr("the value 412.0 is far from the others: 105.7 standard deviations")));
}

}  // namespace
}  // namespace kith
