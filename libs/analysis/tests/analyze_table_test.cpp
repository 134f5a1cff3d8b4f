#include "kith/analysis/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "findings.hpp"
#include "model.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using testing::failure_of;
using testing::finding;
using ::testing::HasSubstr;
using testing::kGroups;
using testing::methods_of;
using testing::number;
using testing::quick;

TEST(AnalyzeTable, TestsAModelOnAnyTable) {
  const auto analysis = analyze_table(Dataset::parse(kGroups, "t.csv"), {"y ~ g", {}}, quick());
  const auto found = finding(analysis, "y");
  EXPECT_DOUBLE_EQ(number(found, 0, "g", "F"), 27.0);
  EXPECT_DOUBLE_EQ(number(found, 0, "g", "partial eta squared"), 0.9);
  EXPECT_NEAR(number(found, 0, "g", "p-value"), 0.001, 1e-12);  // F = 27: p = (1 + F / 3)^-3
  EXPECT_THAT(found.sentence, HasSubstr("g has a large effect (p = 0.001): means range"));
  EXPECT_THAT(found.sentence, HasSubstr("from 2.000 (a) to 8.000 (c)"));
}

TEST(AnalyzeTable, GivesRowsNamedFieldsInDocuments) {
  const auto analysis = analyze_table(Dataset::parse(kGroups, "t.csv"), {"y ~ g", {}}, quick());
  const auto document = nlohmann::json::parse(findings_json(analysis));
  ASSERT_EQ(document.size(), analysis.findings.size());
  const auto& table = document.at(0).at("tables").at(0);
  const auto& effect = table.at("rows").at(0);
  EXPECT_EQ(effect.at("term"), "g");
  EXPECT_EQ(effect.at("df"), 2);
  EXPECT_DOUBLE_EQ(effect.at("f").get<double>(), 27.0);
  EXPECT_DOUBLE_EQ(effect.at("partial_eta_squared").get<double>(), 0.9);
  EXPECT_NEAR(effect.at("p_value").get<double>(), 0.001, 1e-12);
  const auto& residuals = table.at("rows").at(1);
  EXPECT_EQ(residuals.at("term"), "residuals");
  EXPECT_FALSE(residuals.contains("f"));  // does not apply
  for (const auto& column : table.at("columns")) EXPECT_TRUE(effect.contains(column.at("field"))) << column;
}

TEST(AnalyzeTable, GivesNullForWhatCannotBeEstimatedInDocuments) {
  const auto analysis = analyze_table(Dataset::parse("g,y\na,1\nb,2\n", "t.csv"), {"y ~ g", {}}, quick());
  const auto document = nlohmann::json::parse(findings_json(analysis));
  EXPECT_TRUE(document.at(0).at("tables").at(0).at("rows").at(0).at("f").is_null());
}

TEST(FieldNames, AreWordsJoinedByUnderscoresAndAllDifferent) {
  const ResultTable table{
      .caption = "",
      .columns =
          {{"Hedges' g"}, {"g, low"}, {"p, Kruskal-Wallis"}, {"mean", {}, "Mean"}, {"mean"}, {"mean"}, {"95 %"}, {"+"}},
      .rows = {}};
  EXPECT_THAT(field_names(table), ::testing::ElementsAre("hedges_g", "g_low", "p_kruskal_wallis", "Mean", "mean",
                                                         "mean_2", "95", "column"));
}

// Factors may have the names that statistics have.
TEST(FieldNames, KeepFactorsNamedLikeStatisticsApart) {
  const auto analysis = analyze_table(Dataset::parse("n,y\n1,1\n1,2\n2,3\n2,5\n", "t.csv"), {"y ~ n", {}}, quick());
  const auto document = nlohmann::json::parse(findings_json(analysis));
  for (const auto& table : document.at(0).at("tables")) {
    if (table.at("caption") != "Raw means") continue;
    EXPECT_EQ(table.at("rows").at(0).at("n"), "1");
    EXPECT_EQ(table.at("rows").at(0).at("n_2"), 2);
    return;
  }
  ADD_FAILURE() << "there is no table of means";
}

// F(1, 10) = 7.105: partial eta squared is 0.42, its lower limit 0.037.
TEST(AnalyzeTable, NamesAllSizesThatAnEffectMayHave) {
  const auto* const text = "g,y\na,1\na,2\na,3\na,2\na,1\na,3\nb,3\nb,4\nb,4\nb,3\nb,2\nb,5\n";
  const auto found = analyze_table(Dataset::parse(text, "t.csv"), {"y ~ g", {}}, quick()).findings.front();
  EXPECT_THAT(found.sentence, HasSubstr("g has a small to large effect (p = 0.024)"));
}

TEST(TypeDisagreement, IsReportedIfOneTypeIsSignificant) {
  const TestResult low{"F", 5.0, {1.0, 20.0}, 0.04}, high{"F", 4.0, {1.0, 20.0}, 0.06};
  EXPECT_EQ(type_disagreement("g", low, high, 0.05),
            "g: tests of type II and type III disagree (p = 0.040 and p = 0.060); marginal means and pairs correspond "
            "to type III");
  EXPECT_EQ(type_disagreement("g", low, high, 0.1), "");
  EXPECT_EQ(type_disagreement("g", low, Estimable<TestResult>::impossible("empty cells"), 0.05), "");
}

TEST(AnalyzeTable, SaysWhatItDoesNotFind) {
  const auto analysis =
      analyze_table(Dataset::parse("g,y\na,1\na,2\na,3\nb,3\nb,1\nb,2\n", "t.csv"), {"y ~ g", {}}, quick());
  EXPECT_THAT(finding(analysis, "y").sentence, HasSubstr("No effect of g was found (p = 1.000)."));
}

TEST(AnalyzeTable, TakesModelsWithoutFactorsAndWithFive) {
  const auto mean = analyze_table(Dataset::parse(kGroups, "t.csv"), {"y ~ 1", {}}, quick());
  EXPECT_FALSE(finding(mean, "y").sentence.empty());
  std::string text = "a,b,c,d,e,y\n";
  for (int i = 0; i < 64; ++i) {
    for (int bit = 0; bit < 5; ++bit) text += (i >> bit & 1) != 0 ? "p," : "q,";
    text += std::to_string(i * i % 7) + "\n";
  }
  const auto five = analyze_table(Dataset::parse(text, "t.csv"), {"y ~ a*b*c*d*e", {}}, quick());
  EXPECT_FALSE(finding(five, "y").tables.empty());
}

TEST(AnalyzeTable, LeavesOutIncompleteRowsAndSaysSo) {
  const auto analysis =
      analyze_table(Dataset::parse(std::string{kGroups} + "a,\n,4\n", "t.csv"), {"y ~ g", {}}, quick());
  EXPECT_THAT(analysis.notes, Contains(HasSubstr("2 of 11 rows left out because of missing values (g: 1, y: 1)")));
  EXPECT_DOUBLE_EQ(number(finding(analysis, "y"), 0, "g", "F"), 27.0);
}

TEST(AnalyzeTable, GivesAReasonInsteadOfNaN) {
  const auto flat = analyze_table(Dataset::parse("g,y\na,1\na,1\nb,1\nb,1\n", "t.csv"), {"y ~ g", {}}, quick());
  EXPECT_THAT(finding(flat, "y").sentence, HasSubstr("The effect of g cannot be tested: "));
  const auto single = analyze_table(Dataset::parse("g,y\na,1\nb,2\n", "t.csv"), {"y ~ g", {}}, quick());
  EXPECT_THAT(finding(single, "y").sentence, HasSubstr("The effect of g cannot be tested: "));
  for (const auto* analysis : {&flat, &single}) {
    const auto tables = finding(*analysis, "y").tables;
    for (const auto& table : tables) {
      for (const auto& row : table.rows) {
        for (const auto& cell : row) {
          const auto* const value = std::get_if<double>(&cell);
          EXPECT_TRUE(value == nullptr || std::isfinite(*value)) << table.caption;
        }
      }
    }
  }
}

TEST(AnalyzeTable, WarnsOfUnequalSpreadAndOfUnbalancedCells) {
  std::string text = "g,y\n";
  for (int i = 0; i < 30; ++i) text += "a," + std::to_string(0.01 * (i % 5)) + "\n";
  for (int i = 0; i < 25; ++i) text += "b," + std::to_string(10.0 * (i % 5)) + "\n";
  const auto warnings = analyze_table(Dataset::parse(text, "t.csv"), {"y ~ g", {}}, quick()).findings.front().warnings;
  EXPECT_THAT(warnings, Contains(HasSubstr("standard deviations differ")));
  EXPECT_THAT(warnings, Contains(HasSubstr("the design is unbalanced (cells have 25 to 30 rows)")));
}

TEST(AnalyzeTable, TreatsCensoredCountsAsSuch) {
  std::string text = "g,n,done\n";
  for (int i = 0; i < 12; ++i) text += "a," + std::to_string(3 + i % 4) + ",true\n";
  for (int i = 0; i < 12; ++i) text += "b," + std::to_string(9) + (i % 2 == 0 ? ",false\n" : ",true\n");
  const auto analysis = analyze_table(Dataset::parse(text, "t.csv"), {.formula = "n ~ g", .observed = "done"}, quick());
  const auto found = finding(analysis, "n");
  EXPECT_THAT(found.warnings, Contains(HasSubstr("6 of 24 rows were stopped before they finished")));
  const auto is_log_rank = [](const ResultTable& table) { return table.caption == "Log-rank test"; };
  EXPECT_EQ(std::count_if(found.tables.begin(), found.tables.end(), is_log_rank), 1);
  EXPECT_THAT(methods_of(found), ::testing::IsSupersetOf({"Kaplan-Meier estimates", "the log-rank test"}));
}

// Counts, ratings and measurements look alike: nobody guesses.
TEST(AnalyzeTable, TakesWholeNumbersForCountsOnlyWhereSomebodySaysSo) {
  const auto is_rates = [](const ResultTable& table) {
    return table.caption.find("quasi-Poisson regression") != std::string::npos;
  };
  const auto has_rates = [&](const Analysis& analysis) {
    const auto& tables = analysis.findings.front().tables;
    return std::any_of(tables.begin(), tables.end(), is_rates);
  };
  auto data = Dataset::parse(kGroups, "t.csv");
  const auto guessed = analyze_table(data, {"y ~ g"}, quick());
  EXPECT_FALSE(has_rates(guessed));
  EXPECT_THAT(guessed.notes, Contains(HasSubstr("y holds whole numbers, which are analysed as measurements")));
  EXPECT_TRUE(has_rates(analyze_table(data, {.formula = "y ~ g", .response_kind = ColumnKind::kCount}, quick())));
  data.set_kind("y", ColumnKind::kCount);
  EXPECT_TRUE(has_rates(analyze_table(data, {"y ~ g"}, quick())));
  data.set_kind("y", ColumnKind::kNumber);
  const auto stated = analyze_table(data, {"y ~ g"}, quick());
  EXPECT_FALSE(has_rates(stated));
  EXPECT_TRUE(stated.notes.empty());
}

TEST(AnalyzeTable, RefusesCountsThatAreNone) {
  const auto data = Dataset::parse("g,y\na,1\na,2\nb,2.5\nb,3\n", "t.csv");
  try {
    (void)analyze_table(data, {.formula = "y ~ g", .response_kind = ColumnKind::kCount}, quick());
    ADD_FAILURE() << "2.5 was taken for a count";
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).id, "E0910");
    EXPECT_EQ(error.diagnostics().at(0).line, 4u);
  }
}

TEST(AnalyzeTable, RefusesWhatItCannotAnalyse) {
  const auto analyse = [](const char* text, const char* formula) {
    return failure_of([&] { (void)analyze_table(Dataset::parse(text, "t.csv"), {formula, {}}, quick()); });
  };
  EXPECT_EQ(analyse(kGroups, "y ~~ g").first, ErrorKind::kUsage);
  EXPECT_EQ(analyse(kGroups, "y ~ h"), (std::pair{ErrorKind::kInvalidInput, std::string{"E0901"}}));
  EXPECT_EQ(analyse("g,y\na,one\n", "y ~ g"), (std::pair{ErrorKind::kInvalidInput, std::string{"E0902"}}));
  EXPECT_EQ(analyse("g,y\na,1\na,2\n", "y ~ g"), (std::pair{ErrorKind::kInfeasible, std::string{"E0904"}}));
  EXPECT_EQ(analyse("g,y\na,\n,2\n", "y ~ g"), (std::pair{ErrorKind::kInfeasible, std::string{"E0905"}}));
  std::string many = "g,y\n";
  for (int i = 0; i < 201; ++i) many += "level" + std::to_string(i) + ",1\n";
  EXPECT_EQ(analyse(many.c_str(), "y ~ g"), (std::pair{ErrorKind::kInvalidInput, std::string{"E0907"}}));
}

// Every term is decomposed with matrices of its own, again and again: this used to take more memory by the minute.
TEST(AnalyzeTable, RefusesMoreTermsThanSixCrossedFactorsHave) {
  std::string text = "y,a,b,c,d,e,f,g,h\n";
  for (int i = 0; i < 600; ++i) {
    text += std::to_string(i * 37 % 101);
    for (int k = 0; k < 8; ++k) text += (i >> k & 1) == 0 ? ",no" : ",yes";
    text += '\n';
  }
  const auto data = Dataset::parse(text, "t.csv");
  const auto analyse = [&](const char* formula) {
    return failure_of([&] { (void)analyze_table(data, {formula, {}}, quick()); });
  };
  EXPECT_EQ(analyse("y ~ a*b*c*d*e*f*g*h"), (std::pair{ErrorKind::kInfeasible, std::string{"E0908"}}));
  EXPECT_NO_THROW((void)analyze_table(data, {"y ~ a + b + c + d + e + f + g + h", {}}, quick()));
}

}  // namespace
}  // namespace kith
