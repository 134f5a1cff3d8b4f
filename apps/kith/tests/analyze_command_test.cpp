#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::ContainsRegex;

// A finished run of 40 teams, made once.
class AnalyzeCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new Scratch;
    ASSERT_EQ(run_kith({"study", "paper", "-o", *scratch_ / "run", "-q", "--set", "replicates=2"}).code, 0);
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string folder() { return *scratch_ / "run"; }
  static std::string file(const std::string& name, const std::string& text) {
    const auto path = *scratch_ / name;
    std::ofstream{path} << text;
    return path;
  }
  static Scratch* scratch_;
};
Scratch* AnalyzeCommand::scratch_ = nullptr;

TEST_F(AnalyzeCommand, AnswersTheQuestionsOfAStudyInWordsAndTables) {
  const auto ran = out_of({"analyze", folder(), "--all"});
  EXPECT_THAT(ran, AllOf(HasSubstr("Effects of strategy and composition: periods"), HasSubstr("(32 teams in 8 groups)"),
                         HasSubstr("Tests of the fixed effects"), HasSubstr("For a paper: "),
                         HasSubstr("Analysis of variance as published"), HasSubstr("Manipulation check"),
                         HasSubstr("Taught together or alone: knowledge")));
  EXPECT_THAT(ran, Not(ContainsRegex("\\b(nan|inf)\\b")));
}

TEST_F(AnalyzeCommand, IsBriefWhenAsked) {
  const auto ran = run_kith({"analyze", folder(), "--brief"});
  EXPECT_THAT(ran.out, AllOf(HasSubstr("No effect of strategy was found"), Not(HasSubstr("  p-value"))));
  EXPECT_LE(std::count(ran.out.begin(), ran.out.end(), '\n'), 25);
}

// What stands there is what the design asks; everything else is named, and nothing is said twice.
TEST_F(AnalyzeCommand, FitsOnAPage) {
  const auto page = run_kith({"analyze", folder()}).out;
  const auto all = run_kith({"analyze", folder(), "--all"}).out;
  const auto num_lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  EXPECT_LE(num_lines(page), 45);
  EXPECT_GT(num_lines(all), 3 * num_lines(page));
  EXPECT_THAT(page, AllOf(HasSubstr("Effects of strategy and composition: periods"), HasSubstr("--all` shows "),
                          Not(HasSubstr("Manipulation check"))));
  const auto findings = json_of({"analyze", folder()}).at("findings");
  const auto left = page.substr(page.find("--all` shows"));
  for (const auto& finding : findings) {
    const bool is_shown = page.find(finding.at("title").get<std::string>()) != std::string::npos;
    EXPECT_TRUE(is_shown || left.find(finding.at("id").get<std::string>()) != std::string::npos) << finding.at("id");
    EXPECT_THAT(all, HasSubstr(finding.at("title").get<std::string>()));
  }
}

TEST_F(AnalyzeCommand, PrintsOneDocument) {
  const auto ran = run_kith({"analyze", folder(), "--json"});
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document.at("schema"), "kith.analyze/5");
  EXPECT_EQ(document.at("findings").at(0).at("id"), "periods");
  const auto& table = document.at("findings").at(0).at("tables").at(0);
  EXPECT_EQ(table.at("columns").at(0), Json::parse(R"({"field": "term", "name": "term", "kind": "text"})"));
  EXPECT_EQ(table.at("rows").at(0).at("term"), "strategy");
  EXPECT_EQ(table.at("rows").at(0).at("df"), 3);
  EXPECT_TRUE(table.at("rows").at(0).at("partial_eta_squared").is_number());
}

TEST_F(AnalyzeCommand, AlignsLettersOfSeveralBytes) {
  const auto table = file("letters.csv",
                          "g,y\nS\xC3\xBC"
                          "d,1\nS\xC3\xBC"
                          "d,2\nS\xC3\xBC"
                          "d,3\nOst,4\nOst,5\nOst,7\n");
  EXPECT_THAT(out_of({"analyze", table, "--model", "y ~ g"}), AllOf(HasSubstr("S\xC3\xBC"
                                                                              "d  3  2.000"),
                                                                    HasSubstr("Ost  3  5.333")));
}

TEST_F(AnalyzeCommand, TestsAModelOnStandardInput) {
  const auto ran = out_of({"analyze", "-", "--model", "y ~ g"}, {.input = "g,y\na,1\na,2\na,3\nb,4\nb,5\nb,6\n"});
  EXPECT_THAT(ran, HasSubstr("13.50"));
}

TEST_F(AnalyzeCommand, TestsContrastsThatWerePlanned) {
  const auto ran = out_of({"analyze", folder(), "--contrast", "mine: joint - common"});
  EXPECT_THAT(ran, AllOf(HasSubstr("Planned contrasts of strategy"), HasSubstr("\nmine ")));
  EXPECT_EQ(run_kith({"analyze", folder(), "--contrast", "joint - nobody"}).code, 2);
  EXPECT_EQ(run_kith({"analyze", folder(), "--contrast", "joint + common"}).code, 2);
  EXPECT_EQ(run_kith({"analyze", folder(), "--smallest-effect", "0.5"}).code, 2);  // needs --model
}

TEST_F(AnalyzeCommand, WritesTablesForPapers) {
  const std::string out = *scratch_ / "out";
  expect_code(0, {"analyze", folder(), "--latex", out + ".tex", "--csv", out + "/csv", "--brief"});
  for (const auto* name : {".tex", "/csv/tables.csv", "/csv/knowledge-1.csv"})
    EXPECT_TRUE(std::filesystem::is_regular_file(out + name)) << name;
}

TEST_F(AnalyzeCommand, RefusesFoldersWithoutFinishedResults) {
  std::filesystem::create_directories(*scratch_ / "half/inputs");
  EXPECT_THAT(err_of(3, {"analyze", *scratch_ / "half"}), HasSubstr("has not finished"));
  std::filesystem::create_directories(*scratch_ / "empty");
  EXPECT_EQ(run_kith({"analyze", *scratch_ / "empty"}).code, 3);
  EXPECT_EQ(run_kith({"analyze", *scratch_ / "nowhere"}).code, 5);
}

TEST_F(AnalyzeCommand, ExplainsOptionsThatDoNotGoTogether) {
  const auto table = run_kith({"analyze", file("t.csv", "g,y\na,1\n")});
  EXPECT_EQ(table.code, 2);
  EXPECT_THAT(table.err, HasSubstr("to analyse a table, give a model"));
  EXPECT_EQ(run_kith({"analyze", folder(), "--where", "a=b"}).code, 2);
  EXPECT_EQ(run_kith({"analyze", folder(), "--model", "y ~ g", "--where", "nonsense"}).code, 2);
  EXPECT_EQ(run_kith({"analyze", folder(), "--alpha", "2"}).code, 2);
  const auto codebook = folder() + "/tables/codebook.json";
  EXPECT_THAT(err_of(2, {"analyze", file("t.csv", "g,y\na,1\n"), "--model", "y ~ g", "--codebook", codebook}),
              HasSubstr("describes several tables, but none named t.csv"));
  EXPECT_THAT(run_kith({"analyze", folder(), "--model", "y ~ g", "--codebook", codebook}).err,
              Not(HasSubstr("several")));
}

}  // namespace
}  // namespace kith::testing
