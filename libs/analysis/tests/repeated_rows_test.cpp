#include "kith/analysis/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "findings.hpp"

namespace kith {
namespace {

using testing::cell_at;
using ::testing::Contains;
using ::testing::HasSubstr;
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
  EXPECT_THAT(analysis.notes, Contains(HasSubstr("rows of t.csv belong together, so the model has random intercepts, "
                                                 "(1|team); write them into the formula to choose others, or say "
                                                 "--independent")));
  const auto& tests = table_named(found, "Tests of the fixed effects (type II, Satterthwaite)");
  const auto independent = analyze_table(data, {.formula = "y ~ g", .independent = true}, quick()).findings.front();
  EXPECT_THAT(independent.warnings, Contains(HasSubstr("rows belong together ((1|team)), but are analysed as "
                                                       "independent, as was asked for")));
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

TEST(AnalyzeTable, AnalysesRatingsByTheirOrder) {
  const auto data = Dataset::parse(members(), "t.csv");
  const auto found =
      analyze_table(data, {.formula = "trust_rating ~ g", .independent = true}, quick()).findings.front();
  EXPECT_THAT(found.sentence, HasSubstr("Proportional odds model of trust_rating"));
  EXPECT_NO_THROW((void)table_named(found, "Likelihood-ratio tests (proportional odds model"));
  EXPECT_EQ(table_named(found, "How often every rating").rows.size(), 2u);
  const auto asked = analyze_table(
      data, {.formula = "member ~ g", .response_kind = ColumnKind::kOrdinal, .independent = true}, quick());
  EXPECT_THAT(asked.findings.front().sentence, HasSubstr("Proportional odds model"));
}

}  // namespace
}  // namespace kith
