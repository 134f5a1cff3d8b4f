#include "kith/analysis/table_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "findings.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using testing::failure_of;
using ::testing::HasSubstr;

constexpr const char* kFour = "g,h,y\na,p,1\na,q,2\nb,p,3\nb,q,7\na,p,2\na,q,4\nb,p,3\nb,q,8\n";

TEST(Identifiers, AreThoseOfTheCodebookAndTheUser) {
  auto data = Dataset::parse("team,member,item,y\n1,1,x,2\n1,2,x,3\n", "t.csv");
  EXPECT_TRUE(identifiers_of(data, {}).empty());
  data.set_kind("team", ColumnKind::kIdentifier);
  data.set_kind("member", ColumnKind::kIdentifier);
  EXPECT_THAT(identifiers_of(data, {"item"}), ElementsAre("team", "team:member", "item"));
}

TEST(Identifiers, OfAStudysTablesTellPeopleApart) {
  const auto learners = Dataset::parse("strategy,composition,replicate,team,member\na,N,1,1,1\n", "learners.csv");
  EXPECT_THAT(identifiers_of(learners, {}), ElementsAre("composition:replicate", "composition:replicate:member"));
  const auto teams = Dataset::parse("strategy,composition,replicate,team,seed_address\na,N,1,1,7\n", "teams.csv");
  EXPECT_THAT(identifiers_of(teams, {}), ElementsAre("seed_address"));
}

TEST(TablePlan, SaysWhatWasAsked) {
  auto data = Dataset::parse("ease,g\n1,a\n", "t.csv");
  data.set_kind("ease", ColumnKind::kOrdinal);
  AnalysisOptions options{.alpha = 0.01, .correction = Correction::kHolm, .contrasts = {parse_contrast("a - b")}};
  const auto plan = nlohmann::json::parse(
      table_plan(data, {.formula = "ease ~ g", .smallest_effect = parse_smallest_effect("d=0.3")}, options));
  EXPECT_EQ(plan.at("formula"), "ease ~ g");
  EXPECT_EQ(plan.at("response"), "ordinal");
  EXPECT_EQ(plan.at("correction"), "holm");
  EXPECT_EQ(plan.at("contrasts").at(0).at("weights"), nlohmann::json::parse(R"({"a": 1, "b": -1})"));
  EXPECT_EQ(plan.at("smallest_effect").at("standardized"), true);
}

TEST(TableCsv, HasCommasAndPoints) {
  const auto data = Dataset::parse("g;y\n\"a,b\";1,5\nc;\n", "t.csv");
  EXPECT_EQ(table_csv(data), "g,y\n\"a,b\",1.5\nc,NA\n");
  EXPECT_EQ(table_csv(Dataset::parse("y\nNA\n1\n", "t.csv")), "y\nNA\n1\n");
}

TEST(BalancedTable, IsAnalysedWithoutR) {
  const auto analysis = analyze_balanced_table(Dataset::parse(kFour, "t.csv"), {"y ~ g*h"}, {});
  ASSERT_TRUE(analysis);
  const auto& tests = analysis->findings.front().tests.front().tests;
  ASSERT_EQ(tests.size(), 3u);
  EXPECT_EQ(tests.back().subject, "g:h");
  EXPECT_NEAR(tests.front().statistic.value(), 24.0, 1e-9);  // by hand: 18 / (3 / 4)
}

TEST(BalancedTable, IsNothingElse) {
  auto data = Dataset::parse(kFour, "t.csv");
  const auto can = [](const Dataset& table, const std::string& formula) {
    return analyze_balanced_table(table, {formula}, {}).has_value();
  };
  for (const auto* const formula : {"y ~ g + h", "y ~ g + (1|h)", "y ~ x", "y ~", "y", "log(y) ~ g"})
    EXPECT_FALSE(can(data, formula)) << formula;
  EXPECT_FALSE(can(Dataset::parse(std::string{kFour} + "a,p,9\n", "t.csv"), "y ~ g*h"));
  EXPECT_FALSE(can(Dataset::parse("dose;y\n0,5;1\n0,5;2\n1;3\n1;7\n", "t.csv"), "y ~ dose"));  // a covariate
  data.set_kind("h", ColumnKind::kIdentifier);
  EXPECT_FALSE(can(data, "y ~ g"));
}

TEST(BalancedTable, RefusesValuesWithoutAVariance) {
  const auto data = Dataset::parse("g,y\na,1\na,2\nb,1e200\nb,4\n", "t.csv");
  EXPECT_EQ(failure_of([&] { (void)analyze_balanced_table(data, {"y ~ g"}, {}); }),
            (std::pair{ErrorKind::kInvalidInput, std::string{"E0911"}}));
}

TEST(TableFindings, AreWhatRPrinted) {
  const auto analysis = read_table_findings(R"({"id": "y", "title": "y ~ g", "question": "?", "model": "y ~ g",
    "sentence": "s", "results": "r", "notes": ["n"], "warnings": [],
    "tests": {"statistic": "F", "tests": [{"subject": "g", "df": 2, "residual_df": 6, "statistic": 27, "p": 0.001}]},
    "means": [{"factor": "g", "means": [{"level": "a", "mean": 2, "low": 1, "high": 3, "n": 3}]}],
    "tables": [{"caption": "c", "columns": [{"field": "term", "name": "term", "kind": "text"},
                                            {"field": "df", "name": "df", "kind": "count"},
                                            {"field": "f", "name": "F", "kind": "number"}],
                "rows": [{"term": "g", "df": 2, "f": null}, {"term": "residuals", "df": 6}]}],
    "methods": [{"text": "m", "source": ""}]})",
                                            "t.csv");
  EXPECT_THAT(analysis.notes, ElementsAre("n"));
  const auto& finding = analysis.findings.at(0);
  EXPECT_EQ(finding.tests.at(0).tests.at(0).statistic, 27.0);
  EXPECT_EQ(finding.means.at(0).means.at(0).mean, 2.0);
  const auto rows = formatted_rows(finding.tables.at(0));
  EXPECT_THAT(rows.at(0), ElementsAre("g", "2", "not estimable"));
  EXPECT_THAT(rows.at(1), ElementsAre("residuals", "6", ""));
}

TEST(TableFindings, OrTheReasonWhyThereAreNone) {
  for (const auto* const printed : {R"({"error": "there is no column 'h'"})", "Killed", "{}"}) {
    EXPECT_EQ(failure_of([&] { (void)read_table_findings(printed, "t.csv"); }),
              (std::pair{ErrorKind::kInfeasible, std::string{"E0904"}}))
        << printed;
  }
}

}  // namespace
}  // namespace kith
