#include "kith/analysis/exports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/table_model.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Analysis analyzed(const std::string& text, const std::string& formula, const AnalysisOptions& options = {}) {
  return analyze_balanced_table(Dataset::parse(text, "t.csv"), {formula}, options).value();
}

constexpr const char* kThreeGroups = "g,y\na,1\na,2\na,3\nb,4\nb,5\nb,6\nc,7\nc,8\nc,9\n";

// F(2, 6) = 27 and partial eta squared 0.9 by hand; its interval in R: uniroot() on pf(27, 2, 6, ncp).
TEST(ResultsParagraph, IsInTheMannerOfTheApa) {
  const auto analysis = analyzed(kThreeGroups, "y ~ g");
  EXPECT_EQ(analysis.findings.front().results,
            "y ~ g (one-way analysis of variance). The effect of g was significant, F(2, 6) = 27.00, p = .001, partial "
            "eta squared = .900, 90 % CI [.545, .930].");
  EXPECT_EQ(results_paragraph(Finding{}, 0.05), "");
}

// By hand: the means are 2, 5 and 8, with a standard error of differences of sqrt(2 / 3) and t(6, .975) = 2.4469.
TEST(ResultsParagraph, HasThePlannedContrasts) {
  AnalysisOptions options;
  options.contrasts = {parse_contrast("step: b - a")};
  const auto analysis = analyzed(kThreeGroups, "y ~ g", options);
  EXPECT_THAT(analysis.findings.front().results,
              ::testing::EndsWith(" step: mean difference = 3.000, 95 % CI [1.002, 4.998], p = .010."));
}

TEST(ResultsParagraph, SaysWhatWasNotFoundAndNamesInteractions) {
  std::string text = "a,b,y\n";
  for (int i = 0; i < 24; ++i)
    text += "a" + std::to_string(i % 2) + ",b" + std::to_string(i / 2 % 2) + "," + std::to_string(i * 7 % 11) + "\n";
  const auto results = analyzed(text, "y ~ a*b").findings.front().results;
  EXPECT_THAT(results, AllOf(HasSubstr("The effect of a was not significant, F(1, 20) = "),
                             HasSubstr("The interaction of a and b was not significant, F(1, 20) = ")));
}

// By hand, as above; the residual standard deviation is 1.
TEST(Finding, HoldsItsTestsAsValues) {
  AnalysisOptions options;
  options.contrasts = {parse_contrast("step: b - a")};
  const auto finding = analyzed(kThreeGroups, "y ~ g", options).findings.front();
  const auto& test = finding.tests.at(0).tests.at(0);
  EXPECT_EQ(test.subject, "g");
  EXPECT_EQ(test.df, 2u);
  EXPECT_EQ(test.residual_df, 6.0);
  EXPECT_NEAR(test.statistic.value(), 27.0, 1e-9);
  EXPECT_NEAR(test.effect.value(), 0.9, 1e-12);

  const auto planned = std::find_if(finding.comparisons.begin(), finding.comparisons.end(),
                                    [](const auto& one) { return one.kind == ComparisonFamily::Kind::kPlanned; });
  ASSERT_NE(planned, finding.comparisons.end());
  const auto& step = planned->comparisons.at(0);
  EXPECT_EQ(step.name, "step");
  EXPECT_NEAR(step.estimate.value(), 3.0, 1e-9);
  EXPECT_NEAR(step.d.value(), 3.0, 1e-9);
  EXPECT_NEAR(step.t.value(), 3.0 / std::sqrt(2.0 / 3.0), 1e-9);
  EXPECT_EQ(step.df, 6.0);
}

TEST(Latex, EscapesWhatLatexReads) {
  Analysis analysis{"t.csv", {}};
  analysis.findings.push_back({.id = "x",
                               .topic = "a_b & 50 %",
                               .sentence = "p < 0.001",
                               .tables = {{"A {table}", {{"pair", ResultKind::kText}, {"p"}}, {{"a - b", 0.5}}}}});
  const auto text = latex_text(analysis, 0.05);
  EXPECT_THAT(text, AllOf(HasSubstr("a\\_b \\& 50 \\%"), HasSubstr("p $<$ 0.001"), HasSubstr("A \\{table\\}"),
                          HasSubstr("a - b & 0.500 \\\\"), HasSubstr("\\begin{tabular}{lr}")));
}

TEST(CsvTables, HaveAllDigitsAndTheFieldNamesOfDocuments) {
  const auto analysis = analyzed(kThreeGroups, "y ~ g");
  const auto files = csv_tables(analysis);
  ASSERT_EQ(files.size(), analysis.findings.front().tables.size() + 1);
  EXPECT_EQ(files.front().name, "y-1.csv");
  EXPECT_THAT(files.front().text, AllOf(::testing::StartsWith("term,df,sum_of_squares,f,p_value,partial_eta_squared,"),
                                        HasSubstr("\ng,2,54,27,")));
  EXPECT_THAT(files.back().text, HasSubstr("y-1.csv,y,Analysis of variance (type II)"));
}

}  // namespace
}  // namespace kith
