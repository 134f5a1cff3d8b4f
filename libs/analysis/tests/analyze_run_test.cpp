#include "kith/analysis/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "findings.hpp"
#include "kith/analysis/exports.hpp"
#include "kith/analysis/tests.hpp"
#include "kith/files/atomic_file.hpp"
#include "resealed.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using testing::cell_at;
using ::testing::Contains;
using testing::failure_of;
using testing::finding;
using testing::has_finding;
using ::testing::HasSubstr;
using testing::methods_of;
using ::testing::Not;
using testing::number;
using testing::table_named;

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
           composition + "/" + std::to_string(replicate) + ",complete," + std::to_string(periods) + "," +
           std::to_string(knowledge) + ",0.3\n";
  }
  static std::string teams() {
    std::string text = "strategy,composition,replicate,team,seed_address,status,periods,knowledge,area_sr\n";
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
  static std::string with_individual_beliefs(std::string text) {
    for (std::size_t at = text.find("common"); at != std::string::npos; at = text.find("common", at))
      text.replace(at, 6, "individual-low");
    return text;
  }
  void write(const std::string& name, const std::string& text) const {
    write_file_atomically(folder_ / "tables" / name, text);
    testing::reseal(folder_);
  }
  [[nodiscard]] Analysis analyse() const { return analyze_run(folder_, {}); }
  [[nodiscard]] Analysis analyse(const std::string& teams) const {
    write("teams.csv", teams);
    return analyse();
  }

  fs::path folder_ = fs::path{::testing::TempDir()} /
                     ("kith analysis " + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
};

// Beyond three features the exam says more than knowledge does.
TEST_F(RunTest, LeadsWithTheExamBeyondThreeFeatures) {
  std::string text = teams();
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) {
    const bool is_header = at == text.find('\n');
    const auto more = is_header ? std::string{",exam_share_right,exam_regret,exam_worst_share_right"}
                                : ",0.9,0." + std::to_string(1 + at % 7) + ",0.8";
    text.insert(at, more);
    at += more.size() + 1;
  }
  write("teams.csv", text);
  const auto position = [](const Analysis& analysis, const std::string& id) {
    const auto found = std::find_if(analysis.findings.begin(), analysis.findings.end(),
                                    [&](const Finding& finding) { return finding.id == id; });
    return found - analysis.findings.begin();
  };
  for (const int features : {3, 4}) {
    fs::create_directories(folder_ / "inputs");
    std::string domain;
    for (int k = 0; k < features; ++k) domain += "[[feature]]\nname = \"f" + std::to_string(k) + "\"\n";
    write_file_atomically(folder_ / "inputs" / "domain.toml", domain);
    testing::reseal(folder_);
    const auto analysis = analyse();
    ASSERT_TRUE(has_finding(analysis, "exam_regret"));
    ASSERT_TRUE(has_finding(analysis, "knowledge"));
    EXPECT_EQ(position(analysis, "exam_regret") < position(analysis, "knowledge"), features > 3);
    EXPECT_EQ(analysis.findings.front().id, features > 3 ? "exam_regret" : "periods");
  }
}

TEST_F(RunTest, AnswersTheQuestionsOfTheStudy) {
  const auto analysis = analyse(teams());
  for (const auto* id :
       {"periods", "knowledge", "periods-within-composition", "knowledge-within-composition", "periods-paired",
        "knowledge-paired", "demonstrations", "periods-baseline", "knowledge-baseline"})
    EXPECT_TRUE(has_finding(analysis, id)) << id;
  EXPECT_FALSE(has_finding(analysis, "periods-beliefs"));  // no strategy for one member's belief
  EXPECT_THAT(finding(analysis, "knowledge").sentence, HasSubstr("(16 teams in 8 groups)"));
  EXPECT_EQ(finding(analysis, "knowledge").model,
            "knowledge ~ strategy + composition + strategy:composition + (1|people)");
  const auto independent = analyse(other_people(teams()));
  EXPECT_THAT(finding(independent, "periods").sentence, HasSubstr("(16 teams)"));
  EXPECT_THAT(finding(independent, "periods").sentence, HasSubstr("Composition has a large effect"));
  EXPECT_THAT(independent.not_analysed, Contains("same people, different strategies: the strategies taught different "
                                                 "people (design.pairing = \"none\")"));
}

// Tables are for people: nothing is looked up in them.
TEST_F(RunTest, RenamedHeadingsChangeNoParagraph) {
  for (const auto& text : {teams(), other_people(teams())}) {
    write("teams.csv", text);
    std::size_t stated = 0;
    for (auto found : analyse().findings) {
      for (auto& table : found.tables) {
        table.caption = "Renamed";
        for (auto& column : table.columns) column.name = "renamed";
      }
      EXPECT_EQ(results_paragraph(found, 0.05), found.results) << found.id;
      found.tables.clear();
      EXPECT_EQ(results_paragraph(found, 0.05), found.results) << found.id;
      stated += found.results.empty() ? 0u : 1u;
    }
    EXPECT_GT(stated, 5u);
  }
}

// Exams are analysed as knowledge is, where teams.csv has them.
TEST_F(RunTest, AnalysesTheExamAsAMeasurement) {
  std::string text =
      "strategy,composition,replicate,team,seed_address,status,periods,knowledge,area_sr,exam_share_right,"
      "exam_regret,exam_worst_share_right\n";
  int team = 0;
  for (const std::string strategy : {"joint", "plan"}) {
    for (const std::string who : {"NNN", "PPP"}) {
      for (int replicate = 1; replicate <= 5; ++replicate) {
        ++team;
        auto line = row(strategy, who, replicate, team, 9, 0.5 + 0.01 * (team % 3));
        line.pop_back();
        const double noise = 0.001 * (replicate * 3 % 5 + (strategy == "plan" ? replicate % 2 : 0));
        text += line + "," + std::to_string(0.9 + noise) + "," +
                std::to_string((strategy == "plan" ? 0.003 : 0.03) + noise) + "," + std::to_string(0.8 + noise) + "\n";
      }
    }
  }
  const auto analysis = analyse(text);
  for (const auto* id : {"exam_share_right", "exam_regret", "exam_worst_share_right", "exam_regret-paired"})
    EXPECT_TRUE(has_finding(analysis, id)) << id;
  const auto found = finding(analysis, "exam_regret");
  EXPECT_EQ(found.title(), "Effects of strategy and composition: regret in the exam");
  EXPECT_EQ(found.question, "Does regret in the exam depend on how a group is taught and who is in it?");
  EXPECT_EQ(found.model, "exam_regret ~ strategy + composition + strategy:composition + (1|people)");
  EXPECT_LT(cell_at(table_named(found, "Tests of the fixed effects"), "strategy", "p-value"), 0.001);
}

// Composition differs between people: four of each, so F(1, 6), whatever the number of strategies that taught them.
TEST_F(RunTest, ComparesCompositionsBetweenPeople) {
  std::string text = "strategy,composition,replicate,team,seed_address,status,periods,knowledge,area_sr\n";
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
  const auto found = finding(analyse(text), "knowledge");
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
  const auto analysis = analyse(other_people(teams()));
  EXPECT_NEAR(cell_at(table_named(finding(analysis, "periods"), "Planned contrasts of strategy"), "mine", "difference"),
              -1.0, 1e-12);
  EXPECT_THROW((void)table_named(finding(analysis, "knowledge"), "Planned contrasts"), std::out_of_range);
  EXPECT_THAT(analysis.not_analysed, Contains(HasSubstr("contrast 'alone' of the study")));
}

// The hypotheses come first, and only they are corrected among themselves; no other finding tests them again.
TEST_F(RunTest, TestsPrimaryContrastsFirstAndCorrectsThemAmongThemselves) {
  fs::create_directories(folder_ / "inputs");
  write_file_atomically(
      folder_ / "inputs" / "study.toml",
      "[[contrast]]\nname = \"H1\"\nfactor = \"strategy\"\nprimary = true\n"
      "weights = { joint = 1.0, common = -1 }\n"
      "[[contrast]]\nname = \"H2\"\nfactor = \"composition\"\nprimary = true\nresponse = \"periods\"\n"
      "weights = { NNN = 1.0, PPP = -1 }\n"
      "[[contrast]]\nname = \"other\"\nfactor = \"composition\"\nweights = { NNN = 1.0, PPP = -1 }\n");
  const auto analysis = analyse(other_people(teams()));
  EXPECT_THAT(analysis.notes, Contains(HasSubstr("everything else is exploratory")));
  ASSERT_EQ(analysis.findings.front().id, "primary");
  const auto& table = analysis.findings.front().tables.front();
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_THAT(table.caption, HasSubstr("(Holm correction for 3 hypotheses)"));
  std::vector<double> p;
  for (const auto* name : {"periods: H1", "knowledge: H1", "periods: H2"}) p.push_back(cell_at(table, name, "p-value"));
  const auto corrected = adjust(p, Correction::kHolm);
  std::size_t i = 0;
  for (const auto* name : {"periods: H1", "knowledge: H1", "periods: H2"})
    EXPECT_DOUBLE_EQ(cell_at(table, name, "corrected p-value"), corrected.at(i++)) << name;
  EXPECT_NEAR(cell_at(table, "periods: H1", "difference"), -1.0, 1e-12);
  EXPECT_THAT(analysis.findings.front().results, HasSubstr("periods: H2: mean difference = 3.000"));
  const auto periods = finding(analysis, "periods");
  EXPECT_THROW((void)table_named(periods, "Planned contrasts of strategy"), std::out_of_range);
  EXPECT_EQ(table_named(periods, "Planned contrasts of composition").rows.size(), 1u);
}

// "common" becomes "individual-low": 1 period more than "joint", and as much spread.
TEST_F(RunTest, ComparesTeamBeliefsWithIndividualOnes) {
  const auto analysis = analyse(with_individual_beliefs(other_people(teams())));
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
  const auto found = finding(analyse(with_individual_beliefs(teams())), "knowledge-beliefs");
  EXPECT_THAT(found.sentence, HasSubstr("(16 teams of 8 groups of people)"));
  EXPECT_THAT(found.model, HasSubstr("(1|people)"));
  EXPECT_EQ(table_named(found, "Does the difference between beliefs").rows.size(), 1u);
  EXPECT_EQ(finding(analyse(), "periods-variation").tables.at(0).columns.at(8).name, "p-value, jackknife");
}

// A setting that changes nothing adds nobody: what is said of the strategies stays, to the last digit.
TEST_F(RunTest, CountsTheSamePeopleOnceOverSettings) {
  fs::create_directories(folder_ / "inputs");
  write_file_atomically(folder_ / "inputs" / "study.toml",
                        "[[contrast]]\nname = \"H\"\nprimary = true\nweights = { joint = 1, individual-low = -1 }\n");
  const auto text = with_individual_beliefs(teams());
  std::string copies, line;
  for (std::istringstream rows{text}; std::getline(rows, line);) {
    using Keys = std::vector<std::string>;
    for (const auto& key : copies.empty() ? Keys{"stop.max_periods"} : Keys{"5", "6", "7"})
      copies += std::string{line}.insert(line.find(',', line.find(',') + 1) + 1, key + ",") + "\n";
  }
  const auto once = analyse(text), thrice = analyse(copies);
  EXPECT_THAT(finding(thrice, "knowledge").warnings, Contains(HasSubstr("in another setting")));
  for (const auto* id :
       {"primary", "knowledge-within-composition", "knowledge-beliefs", "knowledge-paired", "knowledge-baseline"})
    EXPECT_EQ(finding(thrice, id).results, finding(once, id).results) << id;
}

// Eight teams taught alone need twice the periods of their people, sixteen taught together one less or as many: by
// hand, 17 and 8.
TEST_F(RunTest, ComparesGroupsWithTeachingAlone) {
  const auto found = finding(analyse(other_people(teams())), "periods-baseline");
  EXPECT_THAT(found.sentence,
              HasSubstr("Mean periods were 8.000 in 16 groups taught together and 17.00 in 8 groups whose members were "
                        "taught one after the other; the difference is statistically significant (p < 0.001)."));
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
  std::string text = "strategy,composition,replicate,team,seed_address,status,periods,knowledge,area_sr\n";
  for (int i = 0; i < 3; ++i) text += row("baseline", "NP", i, i, 10 + 2 * i, 0.5);
  for (int i = 0; i < 3; ++i) text += row("common", "NP", i, 3 + i, 6 + i, 0.6);
  const auto analysis = analyse(text);
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

TEST_F(RunTest, NamesTheMethodsThatItUsed) {
  const auto analysis = analyse(other_people(teams()));
  EXPECT_THAT(
      methods_of(finding(analysis, "periods")),
      ::testing::IsSupersetOf({"two-way analysis of variance (type II sums of squares)", "estimated marginal means",
                               "Kaplan-Meier estimates", "log-rank tests stratified by the other factors"}));
  EXPECT_THAT(methods_of(finding(analysis, "knowledge")), Not(Contains(HasSubstr("log-rank"))));
  EXPECT_THAT(methods_of(finding(analysis, "periods-within-composition")),
              Contains("one-way analyses of variance with Bonferroni correction for 2 compositions"));
  AnalysisOptions holm;
  holm.correction = Correction::kHolm;
  EXPECT_THAT(methods_of(finding(analyze_run(folder_, holm), "periods-within-composition")),
              Contains("one-way analyses of variance with Holm correction for 2 compositions"));
}

TEST_F(RunTest, NamesTheMethodsForTheSamePeople) {
  const auto analysis = analyse(teams());
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
  EXPECT_THAT(finding(analysis, "periods-paired").warnings,
              Contains("common - joint: no test: all differences are equal"));
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
  std::string periods = "strategy,composition,replicate,team,period,kc,area_sr\n";
  for (int team = 9; team <= 24; ++team) {  // the groups
    const double area = team <= 16 ? 0.5 + 0.001 * team : 0.25 + 0.001 * team;
    const auto of_team = (team <= 16 ? "common,NNN,1," : "joint,NNN,1,") + std::to_string(team);
    periods += of_team + ",1,1,9\n";
    for (const auto* period : {",2,1,", ",3,1,"}) periods += of_team + period + std::to_string(area) + "\n";
  }
  write("periods.csv", periods);
  const auto found = finding(analyse(), "demonstrations");
  // Means of log(0.25 + 0.001 i) over teams 17 to 24 and of log(0.5 + 0.001 i) over 9 to 16; log 9 is not in them.
  EXPECT_THAT(found.sentence, HasSubstr("Component 1: the strategies differ (p < 0.001); mean log areas range from "
                                        "-1.308 (joint) to -0.668 (common)."));
}

TEST_F(RunTest, RefusesFoldersWithoutResults) {
  EXPECT_EQ(failure_of([&] { (void)analyze_run(folder_ / "nowhere", {}); }).first, ErrorKind::kIo);
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
  write("teams.csv", "strategy,composition,replicate,team,seed_address,status,periods,knowledge\n");
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInvalidInput, std::string{"E0502"}}));
  auto text = teams();
  text.replace(text.find("7/NNN/1,complete,"), 18, "7/NNN/1,complete,x");
  write("teams.csv", text);
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInvalidInput, std::string{"E0506"}}));
  write("teams.csv", teams() + row("joint", "PPP", 5, 25, 5, 0.5).replace(0, 5, ""));
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInvalidInput, std::string{"E0507"}}));
}

TEST_F(RunTest, SaysWhatADesignDoesNotAllow) {
  std::string text = "strategy,composition,replicate,team,seed_address,status,periods,knowledge,area_sr\n";
  for (int i = 1; i <= 3; ++i) text += row("joint", "NNN", i, i, 7 + i, 0.5);
  write("teams.csv", text);
  EXPECT_EQ(failure_of([&] { (void)analyse(); }), (std::pair{ErrorKind::kInfeasible, std::string{"E0906"}}));
  for (int i = 1; i <= 3; ++i) text += row("joint", "PPP", i, 3 + i, 5 + i, 0.6);
  const auto analysis = analyse(text);
  EXPECT_TRUE(has_finding(analysis, "periods"));
  EXPECT_FALSE(has_finding(analysis, "periods-paired"));
  EXPECT_THAT(analysis.not_analysed,
              ::testing::IsSupersetOf({"same people, different strategies: needs at least two group strategies",
                                       "taught together or alone: needs the baseline and a group strategy"}));
}

}  // namespace
}  // namespace kith
