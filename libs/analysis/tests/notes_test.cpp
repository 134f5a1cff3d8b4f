// What an analysis says beside its numbers where these could mislead.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "findings.hpp"
#include "kith/analysis/exports.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using testing::cell_at;
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
  EXPECT_THAT(found.warnings, Contains(AllOf(HasSubstr("the levels of a cannot be compared: no observation has"),
                                             HasSubstr("leave out levels (--where), or the interaction"))));
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

// Also where people answer several times: what they have in common is no reason to call a value far.
TEST(Notes, NameFarValuesOfPeople) {
  std::string text = "person,g,y\n";
  for (int i = 0; i < 80; ++i)
    text += "p" + std::to_string(i / 4) + (i % 2 == 0 ? ",a," : ",b,") +
            std::to_string(50 + i / 4 * 5 % 17 + i * 7 % 11) + "\n";
  EXPECT_THAT(analysis_of(text, {"y ~ g + (1|person)"}).findings.front().warnings,
              Not(Contains(HasSubstr("far from the others"))));
  EXPECT_THAT(analysis_of(text + "p3,b,412\n", {"y ~ g + (1|person)"}).findings.front().warnings,
              Contains(HasSubstr("the value 412.0 is far from the others")));
}

// Every subject sees every item; difficulty is a property of items.
std::string people_and_items() {
  std::string text = "subject,item,difficulty,y\n";
  for (int i = 0; i < 60; ++i)
    text += std::to_string(i / 6) + "," + std::to_string(i % 6) + (i % 2 == 0 ? ",easy," : ",hard,") +
            std::to_string(i * 13 % 17) + "\n";
  return text;
}

TEST(Notes, NameItemsThatTheModelIgnores) {
  const auto notes_of = [](const char* formula) { return analysis_of(people_and_items(), {formula}).notes; };
  EXPECT_THAT(notes_of("y ~ difficulty"),
              Contains(AllOf(HasSubstr("rows with the same item may be alike, too"),
                             HasSubstr("write + (1|subject) + (1|item) into the formula"))));
  EXPECT_THAT(notes_of("y ~ difficulty + (1|subject)"), Contains(HasSubstr("write + (1|item) into the formula")));
  EXPECT_THAT(notes_of("y ~ difficulty + (1|subject) + (1|item)"), Not(Contains(HasSubstr("same item"))));
  EXPECT_THAT(notes_of("y ~ item"), Not(Contains(HasSubstr("same item"))));
  EXPECT_THAT(analysis_of(people_and_items(), {.formula = "y ~ difficulty", .identifiers = {"item"}}).notes,
              Not(Contains(HasSubstr("same item"))));
}

// Rows of a subject are alike, so not all tests take rows as independent.
TEST(Notes, SayWhichRowsAreTakenAsNoMoreAlike) {
  std::string text = "subject,team,g,y\n";
  for (int i = 0; i < 96; ++i) {
    const int subject = i / 4;
    text += std::to_string(subject) + "," + std::to_string(subject % 12) + (i % 2 == 0 ? ",a," : ",b,") +
            std::to_string((subject / 12 == 0 ? 20 : -20) + i * 7 % 11) + "\n";
  }
  const auto warnings = analysis_of(text, {"y ~ g"}).findings.front().warnings;
  EXPECT_THAT(warnings, Contains(HasSubstr("the variance of team is estimated as 0, so the tests treat rows with the "
                                           "same team as no more alike than others")));
  EXPECT_THAT(warnings, Not(Contains(HasSubstr("as independent"))));
}

TEST(Notes, OfMixedModelsNameUnbalancedDesigns) {
  std::string text = "person,g,h,y\n";
  for (int i = 0; i < 40; ++i)
    text += "p" + std::to_string(i / 4) + (i % 3 == 0 ? ",a," : ",b,") + (i % 2 == 0 ? "c," : "d,") +
            std::to_string(i * 7 % 11) + "\n";
  EXPECT_THAT(analysis_of(text, {"y ~ g + h"}).findings.front().warnings,
              Contains("the design is unbalanced (cells have 7 to 13 rows): raw means mix the effects of several "
                       "factors"));
}

TEST(Notes, SayThatAResponseIsConstant) {
  EXPECT_THAT(analysis_of("g,y\na,5\na,5\nb,5\nb,5\n", {"y ~ g"}).notes,
              Contains("y is 5 in every row, so there is nothing to explain"));
}

TEST(Notes, SayHowToWriteYesAndNo) {
  try {
    (void)analysis_of("g,y\na,yes\na,no\nb,yes\n", {"y ~ g"});
    ADD_FAILURE() << "text was taken for numbers";
  } catch (const Error& error) {
    EXPECT_THAT(error.diagnostics().front().hint,
                HasSubstr("write 0 and 1 (or false and true) instead of 'no' and 'yes'"));
  }
}

std::string ratings(const std::string& name) {
  std::string text = "g," + name + "\n";
  for (int i = 0; i < 60; ++i) text += (i % 2 == 0 ? "a," : "b,") + std::to_string(1 + (i * i * 7 + i) % 11 % 5) + "\n";
  return text + "c,3\n";
}

TEST(Notes, OfRatingsNameTheirReasonAndSmallCells) {
  const auto named = analysis_of(ratings("ease_rating"), {"ease_rating ~ g"});
  EXPECT_THAT(named.notes, Contains(HasSubstr("ease_rating is taken for ratings because of its name")));
  EXPECT_THAT(named.findings.front().warnings, Contains(HasSubstr("the smallest cell has 1 row, so p-values")));
  const auto said = analysis_of(ratings("y"), {.formula = "y ~ g", .response_kind = ColumnKind::kOrdinal});
  EXPECT_THAT(said.notes, Not(Contains(HasSubstr("because of its name"))));
}

// The law: only a word makes a name that of ratings, whatever stands around it.
TEST(Notes, TakeNoNameForRatingsThatHoldsTheWordInsideAnother) {
  for (const auto* name :
       {"operating_minutes", "generating", "Frustrating", "ratingless", "separating_ratio", "likertish"})
    EXPECT_THAT(analysis_of(ratings(name), {std::string{name} + " ~ g"}).notes,
                Not(Contains(HasSubstr("because of its name"))))
        << name;
  for (const auto* name : {"rating", "ease_rating", "trustLikert", "rating2", "Ratings_of_ease", "RATING"})
    EXPECT_THAT(analysis_of(ratings(name), {std::string{name} + " ~ g"}).notes,
                Contains(HasSubstr("because of its name")))
        << name;
}

// Without the one that differs there is no spread, and so nothing to measure its distance in.
TEST(Notes, OfAValueUnlikeAllOthersNameNoInfiniteDistance) {
  for (const auto* different : {"1", "0.1", "1e12"}) {
    std::string text = "g,y\n";
    for (int i = 0; i < 12; ++i) text += (i % 2 == 0 ? "a," : "b,") + std::string{i == 5 ? different : "0"} + "\n";
    text += "b,0.0\n";
    const auto warnings = analysis_of(text, {.formula = "y ~ g"}).findings.front().warnings;
    for (const auto& warning : warnings) EXPECT_THAT(warning, Not(HasSubstr("standard deviations from"))) << different;
    if (std::string{different} == "1") continue;  // true or false: nothing is far
    EXPECT_THAT(warnings, Contains(HasSubstr("is unlike all others, which the model fits exactly")));
  }
}

// PP is exactly 0; the mean of the model is a difference of rounded numbers.
TEST(Notes, MeansThatAreRoundingAreZero) {
  std::string text = "c,y\n";
  for (int i = 0; i < 9; ++i) text += fmt::format("NN,{}\nNP,{}\nPP,0\n", 0.991 + 0.001 * (i % 3), 0.7 + 0.1 * (i % 3));
  const auto found = analysis_of(text, {"y ~ c"}).findings.front();
  EXPECT_THAT(found.sentence, HasSubstr("from 0 (PP) to 0.992"));
}

// A third of the teams has no regret at all.
std::string teams_at_the_floor() {
  std::string text = "strategy,people,exam_regret,exam_share_right,periods\n";
  for (int i = 0; i < 48; ++i) {
    text += fmt::format("{},p{},{},{},{}\n", i % 2 == 0 ? "joint" : "common", i / 2,
                        i % 3 == 0 ? 0.0 : 0.001 * (1 + i * 7 % 23), 0.92 + 0.001 * (i * 11 % 80), 3 + i % 4);
  }
  return text;
}

TEST(Notes, NameOutcomesAtTheEndOfTheirRange) {
  for (const bool are_same_people : {false, true}) {
    const std::string more = are_same_people ? " + (1|people)" : "";
    const auto regret = analysis_of(teams_at_the_floor(), {"exam_regret ~ strategy" + more}).findings.front();
    EXPECT_THAT(regret.warnings,
                Contains(HasSubstr("at the floor: 16 of 48 rows have exactly 0, the least that is possible")));
    EXPECT_EQ(cell_at(table_named(regret, "Rows with exactly 0"), "strategy joint", "share"), 8.0 / 24.0);
    EXPECT_EQ(std::any_of(regret.tables.begin(), regret.tables.end(),
                          [](const auto& table) { return table.caption.find("on ranks") != std::string::npos; }),
              are_same_people);
    const auto right = analysis_of(teams_at_the_floor(), {"exam_share_right ~ strategy" + more}).findings.front();
    EXPECT_THAT(right.warnings, Contains(AllOf(HasSubstr("at the ceiling: 0 of 48 rows have exactly 1"),
                                               HasSubstr("all lie between 0.920 and 0.999"))));
    const auto periods = analysis_of(teams_at_the_floor(), {"periods ~ strategy" + more}).findings.front();
    EXPECT_THAT(periods.warnings, Not(Contains(HasSubstr("at the floor"))));
  }
}

TEST(Notes, ResultsOfRatingsAreReportedForPapers) {
  const auto found = analysis_of(ratings("ease_rating"), {"ease_rating ~ g"}).findings.front();
  EXPECT_THAT(results_paragraph(found, 0.05), HasSubstr("The effect of g was not significant, chi-squared(2) = "));
}

}  // namespace
}  // namespace kith
