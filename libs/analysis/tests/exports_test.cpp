#include "kith/analysis/exports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/r_script.hpp"

namespace kith {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

AnalysisOptions few_draws() {
  AnalysisOptions options;
  options.permutations = 199;
  return options;
}

constexpr const char* kThreeGroups = "g,y\na,1\na,2\na,3\nb,4\nb,5\nb,6\nc,7\nc,8\nc,9\n";

// F(2, 6) = 27 and partial eta squared 0.9 by hand; its interval in R: uniroot() on pf(27, 2, 6, ncp).
TEST(ResultsParagraph, IsInTheMannerOfTheApa) {
  const auto analysis = analyze_table(Dataset::parse(kThreeGroups, "t.csv"), {"y ~ g"}, few_draws());
  EXPECT_EQ(analysis.findings.front().results,
            "y ~ g (one-way analysis of variance). The effect of g was significant, F(2, 6) = 27.00, p = .001, partial "
            "eta squared = .900, 90 % CI [.545, .930].");
  EXPECT_EQ(results_paragraph(Finding{}, 0.05), "");
}

// By hand: the means are 2, 5 and 8, with a standard error of differences of sqrt(2 / 3) and t(6, .975) = 2.4469.
TEST(ResultsParagraph, HasThePlannedContrasts) {
  auto options = few_draws();
  options.contrasts = {parse_contrast("step: b - a")};
  const auto analysis = analyze_table(Dataset::parse(kThreeGroups, "t.csv"), {"y ~ g"}, options);
  EXPECT_THAT(analysis.findings.front().results,
              ::testing::EndsWith(" step: mean difference = 3.000, 95 % CI [1.002, 4.998], p = .010."));
}

TEST(ResultsParagraph, SaysWhatWasNotFoundAndNamesInteractions) {
  std::string text = "a,b,y\n";
  for (int i = 0; i < 24; ++i)
    text += std::to_string(i % 2) + "," + std::to_string(i / 2 % 2) + "," + std::to_string(i * 7 % 11) + "\n";
  const auto results = analyze_table(Dataset::parse(text, "t.csv"), {"y ~ a*b"}, few_draws()).findings.front().results;
  EXPECT_THAT(results, AllOf(HasSubstr("The effect of a was not significant, F(1, 20) = "),
                             HasSubstr("The interaction of a and b was not significant, F(1, 20) = ")));
}

// By hand, as above; the residual standard deviation is 1.
TEST(Finding, HoldsItsTestsAsValues) {
  auto options = few_draws();
  options.contrasts = {parse_contrast("step: b - a")};
  const auto finding = analyze_table(Dataset::parse(kThreeGroups, "t.csv"), {"y ~ g"}, options).findings.front();
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
  const auto analysis = analyze_table(Dataset::parse(kThreeGroups, "t.csv"), {"y ~ g"}, few_draws());
  const auto files = csv_tables(analysis);
  ASSERT_EQ(files.size(), analysis.findings.front().tables.size() + 1);
  EXPECT_EQ(files.front().name, "y-1.csv");
  EXPECT_THAT(files.front().text, AllOf(::testing::StartsWith("term,df,sum_of_squares,f,p_value,partial_eta_squared,"),
                                        HasSubstr("\ng,2,54.")));
  EXPECT_THAT(files.back().text, HasSubstr("y-1.csv,y,Analysis of variance (type II)"));
}

TEST(RProject, HasTheRowsThatWereAnalysedAndAScriptOfTheSameModel) {
  const auto data = Dataset::parse("g;h h;y\na;p;1,5\na;q;2\nb;p;3\nb;q;4\nb;q;\na;p;7\n", "people.csv");
  auto options = few_draws();
  options.by = {"h h"};
  const auto project = r_project(data, {"y ~ g*`h h`"}, options);
  EXPECT_EQ(project.data, "y,g,h h\n1.5,a,p\n2,a,q\n3,b,p\n4,b,q\n7,a,p\n");
  EXPECT_THAT(project.script, AllOf(HasSubstr("model <- lm(y ~ g + h.h + g:h.h, data = data)"),
                                    HasSubstr("data$h.h <- factor(data$h.h, levels = c(\"p\", \"q\"))"),
                                    HasSubstr("columns <- c(\"h h\")\nnames(columns) <- c(\"h.h\")\n"),
                                    HasSubstr("car::Anova(model, type = 2)"),
                                    HasSubstr("data.frame(term = label(terms)"), HasSubstr("by = \"h.h\""),
                                    HasSubstr("Pairs of g (at each level of h h)"), Not(HasSubstr("lmer("))));
  EXPECT_THAT(project.codebook, HasSubstr("\"data.csv\""));
}

TEST(RProject, GivesEveryColumnAnotherNameThatRTakes) {
  const auto data = Dataset::parse(
      "age group,age.group,age-group,2nd,if,y\na,a,p,a,a,1\nb,b,p,b,b,2\na,b,q,b,a,3\nb,a,q,a,a,5\n", "t.csv");
  const auto project = r_project(data, {"y ~ `age group` + age.group + `age-group` + `2nd` + if"}, few_draws());
  EXPECT_THAT(project.script, AllOf(HasSubstr("lm(y ~ age.group.2 + age.group + age.group.3 + x.2nd + if., data"),
                                    HasSubstr("columns <- c(\"age group\", \"age-group\", \"2nd\", \"if\")")));
}

TEST(RProject, FitsTheSameModelOfRatings) {
  std::string text = "g,ease\n";
  for (int i = 0; i < 24; ++i) text += (i % 2 == 0 ? "a," : "b,") + std::to_string(1 + i * 7 % 5) + "\n";
  const auto project = r_project(Dataset::parse(text, "t.csv"),
                                 {.formula = "ease ~ g", .response_kind = ColumnKind::kOrdinal}, few_draws());
  EXPECT_THAT(project.script, AllOf(HasSubstr("library(MASS)"), HasSubstr("model <- polr(ease ~ g, data = data"),
                                    HasSubstr("Likelihood-ratio tests (proportional odds model, type II)"),
                                    Not(HasSubstr("<- lm(ease"))));
}

TEST(RProject, FitsTheSameRandomIntercepts) {
  std::string text = "team,g,y\n";
  for (int i = 0; i < 24; ++i)
    text += std::to_string(i / 3) + (i / 3 % 2 == 0 ? ",a," : ",b,") + std::to_string(i * 5 % 7) + "\n";
  const auto project = r_project(Dataset::parse(text, "t.csv"), {"y ~ g"}, few_draws());
  EXPECT_THAT(project.script, AllOf(HasSubstr("library(lmerTest)"), HasSubstr("lmer(y ~ g + (1 | team), data = data,"),
                                    HasSubstr("anova(model, type = 2)")));
  EXPECT_THAT(project.data, ::testing::StartsWith("y,g,team\n0,a,0\n"));
}

// emmeans has no columns of numbers for pairs that cannot be estimated, and counts the levels that cannot.
TEST(RProject, ComparesOnlyLevelsThatCanBeEstimated) {
  std::string text = "g,h,y\n";
  for (int i = 0; i < 24; ++i)
    text += std::string{"abc"}.substr(static_cast<std::size_t>(i % 3), 1) + (i % 3 == 2 || i % 2 == 0 ? ",p," : ",q,") +
            std::to_string(i * 5 % 7) + "\n";
  const auto script_of = [&](const std::string& table) {
    return r_project(Dataset::parse(table, "t.csv"), {"y ~ g*h"}, few_draws()).script;
  };
  EXPECT_THAT(script_of(text), AllOf(HasSubstr("known <- which(!is.na(of(shown, \"emmean\")))"),
                                     HasSubstr("pairs(means[known], reverse = TRUE)")));
  EXPECT_THAT(script_of(text + "c,q,3\n"), Not(HasSubstr("known <- ")));
}

// kith has no random intercepts for them; the note about it says that the script names a model.
TEST(RProject, NamesModelsOfRepeatedRatingsAndTruths) {
  std::string text = "team,g,ease,right\n";
  for (int i = 0; i < 24; ++i)
    text += std::to_string(i / 3) + (i / 3 % 2 == 0 ? ",a," : ",b,") + std::to_string(1 + i * 7 % 5) +
            (i * 5 % 7 < 4 ? ",true\n" : ",false\n");
  const auto data = Dataset::parse(text, "t.csv");
  EXPECT_THAT(r_project(data, {.formula = "ease ~ g", .response_kind = ColumnKind::kOrdinal}, few_draws()).script,
              HasSubstr("clmm(factor(ease, ordered = TRUE) ~ g + (1 | team), data = data)"));
  EXPECT_THAT(r_project(data, {"right ~ g"}, few_draws()).script,
              HasSubstr("glmer(right ~ g + (1 | team), family = binomial, data = data)"));
  EXPECT_THAT(r_project(data, {.formula = "right ~ g", .independent = true}, few_draws()).script,
              HasSubstr("glm(right ~ g, family = binomial, data = data)"));
}

}  // namespace
}  // namespace kith
