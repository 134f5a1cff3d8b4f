#include "kith/analysis/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "findings.hpp"

namespace kith {
namespace {

using testing::cell_at;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::number;
using testing::quick;
using testing::table_named;

// Teams of three whose members are much alike; g differs between teams.
std::string members() {
  std::string text = "team,member,g,y,trust_rating\n";
  for (int i = 0; i < 36; ++i) {
    const int team = i / 3;
    text += std::to_string(team) + "," + std::to_string(i % 3) + (team % 2 == 0 ? ",a," : ",b,") +
            std::to_string(team * 7 % 12 + 0.1 * (i * 5 % 7)) + "," + std::to_string(1 + (team + i) % 5) + "\n";
  }
  return text;
}

// Members of one team are no independent rows: thirty-six of them know no more about g than twelve teams do.
TEST(AnalyzeTable, FitsRandomInterceptsWhereAnIdentifierRepeats) {
  const auto data = Dataset::parse(members(), "t.csv");
  const auto analysis = analyze_table(data, {"y ~ g"}, quick());
  const auto found = analysis.findings.front();
  EXPECT_EQ(found.model, "y ~ g + (1|team)");
  EXPECT_THAT(analysis.notes, Contains(HasSubstr("identifiers repeat in t.csv, so the model has random intercepts, "
                                                 "(1|team); to choose others, write them into the formula, or use "
                                                 "--independent")));
  const auto& tests = table_named(found, "Tests of the fixed effects (type II, Satterthwaite)");
  const auto independent = analyze_table(data, {.formula = "y ~ g", .independent = true}, quick()).findings.front();
  EXPECT_THAT(independent.warnings, Contains(HasSubstr("identifiers repeat ((1|team)), but rows are analysed as "
                                                       "independent, as requested")));
  // Balanced, so the mixed model's test is that of the team means: F(1, 10).
  std::string means = "team,g,y\n";
  for (int team = 0; team < 12; ++team) {
    double sum = 0.0;
    for (int i = 3 * team; i < 3 * team + 3; ++i) sum += team * 7 % 12 + 0.1 * (i * 5 % 7);
    means += std::to_string(team) + (team % 2 == 0 ? ",a," : ",b,") + std::to_string(sum / 3.0) + "\n";
  }
  const auto of_means = analyze_table(Dataset::parse(means, "t.csv"), {"y ~ g"}, quick()).findings.front();
  EXPECT_NEAR(cell_at(tests, "g", "F"), number(of_means, 0, "g", "F"), 1e-4 * number(of_means, 0, "g", "F"));
  EXPECT_NEAR(cell_at(tests, "g", "p-value"), number(of_means, 0, "g", "p-value"), 1e-4);
  EXPECT_GT(cell_at(table_named(found, "Variances"), "team", "intraclass correlation"), 0.9);
  EXPECT_THAT(found.sentence, HasSubstr("design effect"));
}

TEST(AnalyzeTable, TakesRandomInterceptsFromTheFormula) {
  const auto found = analyze_table(Dataset::parse(members(), "t.csv"), {"y ~ 1 + (1|team)"}, quick()).findings.front();
  EXPECT_EQ(found.model, "y ~ 1 + (1|team)");
  EXPECT_NO_THROW((void)table_named(found, "Variances"));
}

// Eight people, two rows each, who are less alike than chance makes them: g differs between people.
std::string unlike_rows() {
  std::string text = "person,g,y\n";
  for (int i = 0; i < 16; ++i)
    text +=
        "p" + std::to_string(i / 2) + (i / 2 % 2 == 0 ? ",a," : ",b,") + std::to_string(i % 2 * 4 + i * 5 % 3) + "\n";
  return text;
}

// A variance of 0 is an estimate from few people: it does not show that rows are independent.
TEST(AnalyzeTable, DoesNotTakeAVarianceOfZeroForAFact) {
  const auto found = analyze_table(Dataset::parse(unlike_rows(), "t.csv"), {"y ~ g"}, quick()).findings.front();
  EXPECT_THAT(found.warnings, Contains(HasSubstr("the variance of person is estimated as 0, so the tests treat rows as "
                                                 "independent; the data allow an intraclass correlation of up to 0.")));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("only 8 different values of person")));
  EXPECT_THAT(found.sentence, HasSubstr("rows with the same person is 0.00 [0.00, 0."));
}

TEST(AnalyzeTable, SaysThatFactorsTellGroupsApart) {
  std::string text = "person,age,y\n";
  for (int i = 0; i < 24; ++i)
    text += "p" + std::to_string(i / 3) + "," + std::to_string(20 + i / 3) + "," + std::to_string(i * 7 % 11) + "\n";
  const auto found = analyze_table(Dataset::parse(text, "t.csv"), {"y ~ age"}, quick()).findings.front();
  EXPECT_THAT(found.sentence, HasSubstr("the factors of the model already tell every person apart"));
}

TEST(AnalyzeTable, WarnsOfEmptyCombinationsInMixedModels) {
  std::string text = "person,g,h,y\n";
  for (int i = 0; i < 36; ++i) {
    const bool is_a = i / 3 % 2 == 0;
    text += "p" + std::to_string(i / 3) + (is_a ? ",a," : ",b,") + (is_a && i / 3 % 4 == 0 ? "x," : "y,") +
            std::to_string(i * 7 % 11) + "\n";
  }
  const auto data = Dataset::parse(text, "t.csv");
  const auto warnings_of = [&](const char* formula) {
    return analyze_table(data, {formula}, quick()).findings.front().warnings;
  };
  EXPECT_THAT(warnings_of("y ~ g*h"), Contains(HasSubstr("1 combination of levels has no rows")));
  EXPECT_THAT(warnings_of("y ~ g + h"), Not(Contains(HasSubstr("combination of levels"))));
}

TEST(AnalyzeTable, AnalysesRatingsByTheirOrder) {
  const auto data = Dataset::parse(members(), "t.csv");
  const auto found =
      analyze_table(data, {.formula = "trust_rating ~ g", .independent = true}, quick()).findings.front();
  EXPECT_THAT(found.sentence, HasSubstr("Proportional odds model of trust_rating"));
  EXPECT_NO_THROW((void)table_named(found, "Likelihood-ratio tests (proportional odds model"));
  EXPECT_EQ(table_named(found, "How often each rating").rows.size(), 2u);
  const auto asked = analyze_table(
      data, {.formula = "member ~ g", .response_kind = ColumnKind::kOrdinal, .independent = true}, quick());
  EXPECT_THAT(asked.findings.front().sentence, HasSubstr("Proportional odds model"));
}

}  // namespace
}  // namespace kith
