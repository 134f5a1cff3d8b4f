#include "kith/analysis/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "findings.hpp"

namespace kith {
namespace {

using testing::cell_at;
using ::testing::Contains;
using testing::failure_of;
using ::testing::HasSubstr;
using testing::kGroups;
using ::testing::Not;
using testing::quick;
using testing::table_named;

// An unbalanced table in which g and h go together: y depends on h alone. Raw means of g differ by 4.8, adjusted ones
// not at all.
std::string confounded() {
  std::string text = "g,h,y\n";
  const auto add = [&](const char* g, const char* h, double mean, int n) {
    for (int i = 0; i < n; ++i)
      text += std::string{g} + "," + h + "," + std::to_string(mean + (i % 2 == 0 ? 0.5 : -0.5)) + "\n";
  };
  add("a", "p", 1.0, 18);
  add("a", "q", 7.0, 2);
  add("b", "p", 1.0, 2);
  add("b", "q", 7.0, 18);
  return text;
}

TEST(AnalyzeTable, ComparesMeansThatAreAdjustedForTheOtherFactors) {
  const auto found = analyze_table(Dataset::parse(confounded(), "t.csv"), {"y ~ g + h"}, quick()).findings.front();
  const auto& pairs = table_named(found, "Pairs of g");
  EXPECT_NEAR(cell_at(pairs, "b - a", "difference"), 0.0, 1e-12);
  EXPECT_GT(cell_at(pairs, "b - a", "p-value"), 0.99);
  const auto& means = table_named(found, "Estimated marginal means of g");
  EXPECT_NEAR(cell_at(means, "a", "mean"), 4.0, 1e-12);
  EXPECT_NEAR(cell_at(means, "b", "mean"), 4.0, 1e-12);
  EXPECT_THAT(found.sentence, HasSubstr("No effect of g was found"));
  EXPECT_THAT(found.sentence, HasSubstr("estimated marginal means range from 1.000 (p) to 7.000 (q)"));
  EXPECT_NO_THROW((void)table_named(found, "Raw means"));
  EXPECT_NEAR(cell_at(table_named(found, "Pairs of h"), "q - p", "d"), 6.0 / std::sqrt(10.0 / 37.0), 1e-9);
}

TEST(AnalyzeTable, TestsPlannedContrastsAndSimpleEffects) {
  auto options = quick();
  options.contrasts = {parse_contrast("ends: c - a"), parse_contrast("middle: b - 0.5*a - 0.5*c")};
  auto found = analyze_table(Dataset::parse(kGroups, "t.csv"), {"y ~ g"}, options).findings.front();
  const auto& contrasts = table_named(found, "Planned contrasts of g (Bonferroni correction)");
  EXPECT_NEAR(cell_at(contrasts, "ends", "difference"), 6.0, 1e-12);
  EXPECT_NEAR(cell_at(contrasts, "middle", "difference"), 0.0, 1e-12);
  // t = 6 / sqrt(2 / 3) with 6 degrees of freedom; R: 2 * 2 * pt(-7.348469, 6)
  EXPECT_NEAR(cell_at(contrasts, "ends", "adjusted p-value"), 2 * 0.0003251, 2e-6);
  EXPECT_THAT(found.sentence, HasSubstr("ends: 6.000 ["));
  options = quick();
  options.by = {"h"};
  found = analyze_table(Dataset::parse(confounded(), "t.csv"), {"y ~ g*h"}, options).findings.front();
  const auto& simple = table_named(found, "Pairs of g (at each level of h)");
  ASSERT_EQ(simple.rows.size(), 2u);
  EXPECT_EQ(std::get<std::string>(simple.rows[1][0]), "q");
}

// Without an interaction the differences are the same at every level: a table of them looks like more than it is.
TEST(AnalyzeTable, HasNoSimpleEffectsWithoutAnInteraction) {
  auto options = quick();
  options.by = {"h"};
  options.contrasts = {parse_contrast("b - a")};
  const auto found = analyze_table(Dataset::parse(confounded(), "t.csv"), {"y ~ g + h"}, options).findings.front();
  for (const auto& table : found.tables) EXPECT_THAT(table.caption, Not(HasSubstr("at each level")));
  EXPECT_THAT(found.warnings,
              Contains("the model has no interaction of g and h, so differences between levels of g are "
                       "the same at every level of h; use g*h to estimate them"));
}

TEST(AnalyzeTable, RefusesContrastsOfOtherLevels) {
  auto options = quick();
  options.contrasts = {parse_contrast("a - d")};
  const auto analyse = [&] { (void)analyze_table(Dataset::parse(kGroups, "t.csv"), {"y ~ g"}, options); };
  EXPECT_EQ(failure_of(analyse).first, ErrorKind::kUsage);
  options.contrasts.clear();
  options.by = {"h"};
  EXPECT_EQ(failure_of(analyse).first, ErrorKind::kUsage);
}

// "No effect" is a finding only where effects that matter can be ruled out.
TEST(AnalyzeTable, TellsEquivalenceFromIgnorance) {
  auto options = quick();
  options.smallest_effect = parse_smallest_effect("2");
  auto found = analyze_table(Dataset::parse(confounded(), "t.csv"), {"y ~ g + h"}, options).findings.front();
  const auto& same = table_named(found, "Equivalence within 2.000 (pairs of g");
  EXPECT_EQ(std::get<std::string>(same.rows.at(0).back()), "equivalent");
  EXPECT_EQ(std::get<std::string>(table_named(found, "(pairs of h").rows.at(0).back()), "different");
  options.smallest_effect = parse_smallest_effect("0.01");
  found = analyze_table(Dataset::parse(confounded(), "t.csv"), {"y ~ g + h"}, options).findings.front();
  EXPECT_EQ(std::get<std::string>(table_named(found, "(pairs of g").rows.at(0).back()), "undecided");
}

}  // namespace
}  // namespace kith
