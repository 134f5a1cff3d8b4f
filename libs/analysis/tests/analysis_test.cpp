#include "kith/analysis/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "resealed.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

AnalysisOptions quick() {
  AnalysisOptions options;
  options.permutations = 199;
  options.resamples = 200;
  return options;
}

Finding finding(const Analysis& analysis, const std::string& id) {
  for (const auto& one : analysis.findings) {
    if (one.id == id) return one;
  }
  throw std::out_of_range{"no finding " + id};
}

bool has_finding(const Analysis& analysis, const std::string& id) {
  return std::any_of(analysis.findings.begin(), analysis.findings.end(), [&](const auto& one) { return one.id == id; });
}

// The number in a table of a finding, by the texts of its row's first cell and of its column.
double number(const Finding& finding, std::size_t table, const std::string& row, const std::string& column) {
  const auto found = finding.tables.at(table);
  for (const auto& cells : found.rows) {
    if (std::get<std::string>(cells.front()) != row) continue;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (found.columns[c].name == column) return std::get<double>(cells[c]);
    }
  }
  throw std::out_of_range{"no cell " + row + "/" + column};
}

std::vector<std::string> methods_of(const Finding& finding) {
  std::vector<std::string> texts;
  for (const auto& method : finding.methods) texts.push_back(method.text);
  return texts;
}

std::pair<ErrorKind, std::string> failure_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return {error.kind(), error.diagnostics().empty() ? "" : error.diagnostics().front().id};
  }
  return {ErrorKind::kPartial, "nothing was thrown"};
}

// Three groups of three; F(2, 6) = 27 and partial eta squared 0.9 by hand: between 54, within 6.
constexpr const char* kGroups = "g,y\na,1\na,2\na,3\nb,4\nb,5\nb,6\nc,7\nc,8\nc,9\n";

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
  EXPECT_THAT(analysis.notes, Contains(HasSubstr("2 of 11 rows were left out because they lack a value (")));
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

const ResultTable& table_named(const Finding& finding, const std::string& part) {
  for (const auto& table : finding.tables) {
    if (table.caption.find(part) != std::string::npos) return table;
  }
  throw std::out_of_range{"no table " + part};
}

double cell_at(const ResultTable& table, const std::string& row, const std::string& column) {
  for (const auto& cells : table.rows) {
    if (std::get<std::string>(cells.front()) != row) continue;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (table.columns[c].name == column) return std::get<double>(cells[c]);
    }
  }
  throw std::out_of_range{"no cell " + row + "/" + column};
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

// A run folder written by hand: two group strategies and the baseline, two compositions, four replicates. The
// strategy "joint" saves exactly one period for every group of people; knowledge does not depend on it.
class RunTest : public ::testing::Test {
 protected:
  RunTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "tables");
  }
  ~RunTest() override { fs::remove_all(folder_); }

  static std::string row(const std::string& strategy, const std::string& composition, int replicate, int team,
                         int periods, double knowledge) {
    return strategy + "," + composition + "," + std::to_string(replicate) + "," + std::to_string(team) + ",7/" +
           composition + "/" + std::to_string(replicate) + ",true," + std::to_string(periods) + "," +
           std::to_string(knowledge) + ",0.3\n";
  }
  static std::string teams() {
    std::string text = "strategy,composition,replicate,team,seed_address,completed,periods,knowledge,area_sr\n";
    int team = 0;
    for (const std::string strategy : {"baseline", "common", "joint"}) {
      for (const std::string composition : {"NNN", "PPP"}) {
        for (int replicate = 1; replicate <= 4; ++replicate) {
          ++team;
          const int people = (composition == "NNN" ? 9 : 6) + replicate % 3;
          const int periods = strategy == "baseline" ? 2 * people : people - (strategy == "joint" ? 1 : 0);
          text += row(strategy, composition, replicate, team, periods, 0.5 + 0.01 * ((replicate * 7 + team) % 5));
        }
      }
    }
    return text;
  }
  // Different people in every team, as with pairing = "none".
  static std::string other_people(std::string text) {
    for (std::size_t at = text.find(",7/"); at != std::string::npos; at = text.find(",7/", at + 4))
      text.insert(at + 1, std::to_string(at) + "/");
    return text;
  }
  void write(const std::string& name, const std::string& text) const {
    write_file_atomically(folder_ / "tables" / name, text);
    testing::reseal(folder_);
  }
  [[nodiscard]] Analysis analyse() const { return analyze_run(folder_, quick()); }

  fs::path folder_ = fs::path{::testing::TempDir()} /
                     ("kith analysis " + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
};

TEST_F(RunTest, AnswersTheQuestionsOfTheStudy) {
  write("teams.csv", teams());
  const auto analysis = analyse();
  for (const auto* id :
       {"periods", "knowledge", "periods-within-composition", "knowledge-within-composition", "periods-paired",
        "knowledge-paired", "demonstrations", "periods-baseline", "knowledge-baseline"})
    EXPECT_TRUE(has_finding(analysis, id)) << id;
  EXPECT_FALSE(has_finding(analysis, "periods-beliefs"));  // no strategy for one member's belief
  EXPECT_THAT(finding(analysis, "knowledge").sentence, HasSubstr("(16 teams in 8 groups)"));
  EXPECT_EQ(finding(analysis, "knowledge").model,
            "knowledge ~ strategy + composition + strategy:composition + (1|people)");
  write("teams.csv", other_people(teams()));
  const auto independent = analyse();
  EXPECT_THAT(finding(independent, "periods").sentence, HasSubstr("(16 teams)"));
  EXPECT_THAT(finding(independent, "periods").sentence, HasSubstr("Composition has a large effect"));
}

// Composition differs between people: four of each, so F(1, 6), whatever the number of strategies that taught them.
TEST_F(RunTest, ComparesCompositionsBetweenPeople) {
  std::string text = "strategy,composition,replicate,team,seed_address,completed,periods,knowledge,area_sr\n";
  std::vector<double> means;
  Factor composition{"composition", {"NNN", "PPP"}, {}};
  int team = 0;
  for (int replicate = 1; replicate <= 4; ++replicate) {
    for (const std::string who : {"NNN", "PPP"}) {
      double sum = 0.0;
      for (const auto& [strategy, shift] : {std::pair{"common", 0.02}, std::pair{"joint", 0.05}}) {
        const double value = 0.5 + 0.05 * (replicate * 5 % 4) + (who == "PPP" ? 0.04 : 0.0) +
                             shift * ((replicate + (who == "PPP" ? 1 : 0)) % 3 - 1);
        text += row(strategy, who, replicate, ++team, 7, value);
        sum += value;
      }
      means.push_back(sum / 2.0);
      composition.codes.push_back(who == "PPP" ? 1 : 0);
    }
  }
  write("teams.csv", text);
  const auto found = finding(analyse(), "knowledge");
  const auto between = one_way_anova(means, composition);
  const auto& tests = table_named(found, "Tests of the fixed effects");
  EXPECT_NEAR(cell_at(tests, "composition", "p-value"), between->p, 1e-5);
  EXPECT_LT(cell_at(table_named(found, "Analysis of variance as published"), "composition", "p-value"), between->p);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("several strategies taught the same people (16 teams, 8 groups")));
}

// [[contrast]] of the study file, as it is frozen in the run folder.
TEST_F(RunTest, TestsTheContrastsOfTheStudy) {
  fs::create_directories(folder_ / "inputs");
  write_file_atomically(folder_ / "inputs" / "study.toml",
                        "[[contrast]]\nname = \"mine\"\nfactor = \"strategy\"\nresponse = \"periods\"\n"
                        "weights = { joint = 1.0, common = -1 }\n"
                        "[[contrast]]\nname = \"alone\"\nweights = { joint = 1.0, baseline = -1.0 }\n");
  write("teams.csv", other_people(teams()));
  const auto analysis = analyse();
  EXPECT_NEAR(cell_at(table_named(finding(analysis, "periods"), "Planned contrasts of strategy"), "mine", "difference"),
              -1.0, 1e-12);
  EXPECT_THROW((void)table_named(finding(analysis, "knowledge"), "Planned contrasts"), std::out_of_range);
  EXPECT_THAT(analysis.not_analysed, Contains(HasSubstr("contrast 'alone' of the study")));
}

// "common" becomes "individual-low": 1 period more than "joint", and as much spread.
TEST_F(RunTest, ComparesTeamBeliefsWithIndividualOnes) {
  auto text = other_people(teams());
  for (std::size_t at = text.find("common"); at != std::string::npos; at = text.find("common", at))
    text.replace(at, 6, "individual-low");
  write("teams.csv", text);
  const auto analysis = analyse();
  const auto found = finding(analysis, "periods-beliefs");
  const auto& contrasts = table_named(found, "Planned contrasts of strategy");
  EXPECT_NEAR(cell_at(contrasts, "team beliefs - individual beliefs", "difference"), -1.0, 1e-12);
  EXPECT_EQ(table_named(found, "Planned contrasts of strategy at each level of composition").rows.size(), 2u);
  const auto variation = finding(analysis, "periods-variation");
  EXPECT_NEAR(cell_at(variation.tables.at(0), "all", "variance ratio"), 1.0, 1e-12);
  EXPECT_THAT(variation.sentence, HasSubstr("no difference was found"));
}

// The same for knowledge, of the same people: the contrast is that of their mean difference.
TEST_F(RunTest, ComparesBeliefsWithinTheSamePeople) {
  auto text = teams();
  for (std::size_t at = text.find("common"); at != std::string::npos; at = text.find("common", at))
    text.replace(at, 6, "individual-low");
  write("teams.csv", text);
  const auto found = finding(analyse(), "knowledge-beliefs");
  EXPECT_THAT(found.sentence, HasSubstr("(16 teams of 8 groups of people)"));
  EXPECT_THAT(found.model, HasSubstr("(1|people)"));
  EXPECT_EQ(table_named(found, "Does the difference between beliefs").rows.size(), 1u);
  EXPECT_EQ(finding(analyse(), "periods-variation").tables.at(0).columns.at(8).name, "p-value, jackknife");
}

TEST_F(RunTest, ComparesStrategiesOnTheSamePeople) {
  write("teams.csv", teams());
  const auto found = finding(analyse(), "periods-paired");
  // Every pair differs by exactly one: the difference is certain and has no spread, which no t test can judge.
  EXPECT_THAT(found.warnings, Contains("common - joint: no test: all differences are equal"));
}

TEST_F(RunTest, ComparesGroupsWithTeachingAlone) {
  write("teams.csv", other_people(teams()));
  EXPECT_THAT(finding(analyse(), "periods-baseline").sentence,
              HasSubstr("Mean periods were 8.000 in 16 groups taught together and 17.00 in 8 groups whose members were "
                        "taught one after the other; the difference is statistically significant (p < 0.001)."));
}

// Eight teams taught alone need twice the periods of their people, sixteen taught together one less or as many: by
// hand, 17 and 8.
TEST_F(RunTest, ListsTheComparisonWithTeachingAloneInItsTable) {
  write("teams.csv", other_people(teams()));
  const auto found = finding(analyse(), "periods-baseline");
  ASSERT_EQ(found.tables.size(), 2u);
  ASSERT_EQ(found.tables[0].rows.size(), 1u);
  EXPECT_DOUBLE_EQ(number(found, 0, "together - alone", "difference"), 8.0 - 17.0);
  EXPECT_LT(number(found, 0, "together - alone", "lower limit"), -9.0);
  EXPECT_GT(number(found, 0, "together - alone", "upper limit"), -9.0);
  EXPECT_LT(number(found, 0, "together - alone", "p-value"), 0.001);
  EXPECT_LT(number(found, 1, "together - alone", "Hedges' g"), -1.0);
}

// The baseline and one group strategy, as in studies/quick.toml: nothing can be said of pairs of group strategies, but
// the same people were taught both ways.
TEST_F(RunTest, ComparesTogetherAndAloneOnTheSamePeople) {
  std::string text = "strategy,composition,replicate,team,seed_address,completed,periods,knowledge,area_sr\n";
  for (int i = 0; i < 3; ++i) text += row("baseline", "NP", i, i, 10 + 2 * i, 0.5);
  for (int i = 0; i < 3; ++i) text += row("common", "NP", i, 3 + i, 6 + i, 0.6);
  write("teams.csv", text);
  const auto analysis = analyse();
  const auto found = finding(analysis, "periods-baseline");
  ASSERT_EQ(found.tables.size(), 1u);
  EXPECT_EQ(std::get<std::int64_t>(found.tables[0].rows.at(0).at(1)), 3);
  EXPECT_DOUBLE_EQ(number(found, 0, "together - alone", "difference"), -5.0);  // -4, -5 and -6
  EXPECT_NEAR(number(found, 0, "together - alone", "t"), -5.0 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(number(found, 0, "together - alone", "d"), -5.0, 1e-12);
  EXPECT_THAT(found.sentence, HasSubstr("Within 3 groups of the same people the mean difference is -5.000 "
                                        "(p = 0.013)."));
  EXPECT_THAT(methods_of(found), ::testing::ElementsAre("a paired t test of the same people"));
  // The interval belongs to the test, so they say the same: p = 0.013, and 0 is outside.
  EXPECT_LT(number(found, 0, "together - alone", "d, upper limit"), 0.0);
  // One sentence for each analysis that the design does not allow, whatever the response.
  EXPECT_THAT(analysis.not_analysed, ::testing::SizeIs(5));
  EXPECT_THAT(analysis.not_analysed, Contains(HasSubstr("needs at least two group strategies")));
  EXPECT_THAT(analysis.notes, ::testing::ElementsAre("6 teams: 2 strategies x 1 composition"));
}

TEST_F(RunTest, SaysThatStrategiesTaughtDifferentPeople) {
  write("teams.csv", other_people(teams()));
  const auto analysis = analyse();
  EXPECT_THAT(analysis.not_analysed,
              Contains("same people, different strategies: the strategies taught different people "
                       "(design.pairing = \"none\")"));
  EXPECT_EQ(finding(analysis, "periods-baseline").tables.size(), 2u);
}

TEST_F(RunTest, NamesTheMethodsThatItUsed) {
  write("teams.csv", other_people(teams()));
  const auto analysis = analyse();
  EXPECT_THAT(methods_of(finding(analysis, "periods")),
              ::testing::IsSupersetOf({"two-way analysis of variance (type II sums of squares)", "aligned rank tests",
                                       "permutation tests of residuals (199 permutations)", "estimated marginal means",
                                       "Kaplan-Meier estimates", "quasi-Poisson regression with F tests",
                                       "log-rank tests stratified by the other factors"}));
  EXPECT_THAT(methods_of(finding(analysis, "knowledge")), Not(Contains(HasSubstr("log-rank"))));
  EXPECT_THAT(methods_of(finding(analysis, "periods-within-composition")),
              Contains("one-way analyses of variance with Bonferroni correction for 2 compositions"));
  auto holm = quick();
  holm.correction = Correction::kHolm;
  EXPECT_THAT(methods_of(finding(analyze_run(folder_, holm), "periods-within-composition")),
              Contains("one-way analyses of variance with Holm correction for 2 compositions"));
}

TEST_F(RunTest, NamesTheMethodsForTheSamePeople) {
  write("teams.csv", teams());
  const auto analysis = analyse();
  EXPECT_THAT(methods_of(finding(analysis, "knowledge")),
              ::testing::IsSupersetOf(
                  {"linear mixed model (REML) with Satterthwaite's degrees of freedom", "estimated marginal means"}));
  EXPECT_THAT(methods_of(finding(analysis, "knowledge-within-composition")),
              ::testing::IsSupersetOf({"mixed models of each composition with Bonferroni correction for 2 compositions",
                                       "Friedman tests (uncorrected)"}));
  EXPECT_THAT(methods_of(finding(analysis, "knowledge-paired")),
              Contains("paired t tests with Holm correction for 1 pair"));
  // All differences of periods are one, which no t test can judge: it is not a method of this analysis.
  EXPECT_THAT(methods_of(finding(analysis, "periods-paired")), Not(Contains(HasSubstr("paired t tests"))));
}

TEST_F(RunTest, HasNoTableWithoutRows) {
  write("teams.csv", teams());
  for (const auto& found : analyse().findings) {
    for (const auto& table : found.tables) {
      EXPECT_FALSE(table.rows.empty()) << found.id << ": " << table.caption;
      for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.caption;
    }
  }
}

TEST_F(RunTest, AveragesTheAreasOfAComponentWithoutItsFirstPeriod) {
  write("teams.csv", other_people(teams()));
  std::string periods = "team,period,kc,area_sr\n";
  for (int team = 9; team <= 24; ++team) {  // the groups
    const double area = team <= 16 ? 0.5 + 0.001 * team : 0.25 + 0.001 * team;
    periods += std::to_string(team) + ",1,1,9\n" + std::to_string(team) + ",2,1," + std::to_string(area) + "\n" +
               std::to_string(team) + ",3,1," + std::to_string(area) + "\n";
  }
  write("periods.csv", periods);
  const auto found = finding(analyse(), "demonstrations");
  // Means of log(0.25 + 0.001 i) over teams 17 to 24 and of log(0.5 + 0.001 i) over 9 to 16; log 9 is not in them.
  EXPECT_THAT(found.sentence, HasSubstr("Component 1: the strategies differ (p < 0.001); mean log areas range from "
                                        "-1.308 (joint) to -0.668 (common)."));
}

TEST_F(RunTest, IsTheSameForTheSameSeed) {
  write("teams.csv", teams());
  const auto a = analyse(), b = analyse();
  ASSERT_EQ(a.findings.size(), b.findings.size());
  for (std::size_t i = 0; i < a.findings.size(); ++i) {
    EXPECT_EQ(a.findings[i].sentence, b.findings[i].sentence);
    for (std::size_t t = 0; t < a.findings[i].tables.size(); ++t)
      EXPECT_EQ(a.findings[i].tables[t].rows, b.findings[i].tables[t].rows);
  }
}

TEST_F(RunTest, RefusesFoldersWithoutResults) {
  EXPECT_EQ(failure_of([&] { (void)analyze_run(folder_ / "nowhere", quick()); }).first, ErrorKind::kIo);
  EXPECT_EQ(failure_of([&] { (void)analyse(); }).first, ErrorKind::kInvalidInput);  // no run folder
  fs::create_directories(folder_ / "inputs");
  try {
    (void)analyse();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_THAT(error.what(), HasSubstr("has not finished"));
  }
}

TEST_F(RunTest, RefusesDamagedTables) {
  write("teams.csv", "strategy,composition,replicate,team,seed_address,completed,periods,knowledge\n");
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInvalidInput, std::string{"E0502"}}));
  auto text = teams();
  text.replace(text.find("7/NNN/1,true,"), 14, "7/NNN/1,true,x");
  write("teams.csv", text);
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInvalidInput, std::string{"E0902"}}));
  write("teams.csv", teams() + row("joint", "PPP", 5, 25, 5, 0.5).replace(0, 5, ""));
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInvalidInput, std::string{"E0903"}}));
}

TEST_F(RunTest, SaysWhatADesignDoesNotAllow) {
  std::string text = "strategy,composition,replicate,team,seed_address,completed,periods,knowledge,area_sr\n";
  for (int i = 1; i <= 3; ++i) text += row("joint", "NNN", i, i, 7 + i, 0.5);
  write("teams.csv", text);
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInfeasible, std::string{"E0906"}}));
  for (int i = 1; i <= 3; ++i) text += row("joint", "PPP", i, 3 + i, 5 + i, 0.6);
  write("teams.csv", text);
  const auto analysis = analyse();
  EXPECT_TRUE(has_finding(analysis, "periods"));
  EXPECT_FALSE(has_finding(analysis, "periods-paired"));
  EXPECT_THAT(analysis.not_analysed,
              ::testing::IsSupersetOf({"same people, different strategies: needs at least two group strategies",
                                       "taught together or alone: needs the baseline and a group strategy"}));
}

}  // namespace
}  // namespace kith
