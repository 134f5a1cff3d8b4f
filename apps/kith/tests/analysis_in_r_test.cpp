// Models of any table: by R where it is, and without it.
#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

const RunWith kWithoutR{.environment = {{"PATH", "/nowhere"}}};

// Balanced: 24 rows, two of each level of g and h.
std::string balanced_rows() {
  std::string text = "g,h,y\n";
  for (int i = 0; i < 24; ++i) {
    text += std::string{i % 2 == 0 ? "a," : "b,"} + (i / 2 % 2 == 0 ? "p," : "q,");
    text += std::to_string(i * 7 % 11 + 3 * (i % 2)) + "\n";
  }
  return text;
}

class AnalysisInR : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    const auto path = scratch_ / name;
    std::filesystem::create_directories(std::filesystem::path{path}.parent_path());
    std::ofstream{path} << text;
    return path;
  }
  [[nodiscard]] static bool has_r() { return std::system("command -v Rscript >/dev/null 2>&1") == 0; }
  Scratch scratch_;
};

#define SKIP_WITHOUT_R() \
  if (!has_r()) GTEST_SKIP() << "there is no Rscript"

Json first_test(const Ran& ran) {
  return Json::parse(ran.out).at("findings").at(0).at("tables").at(0).at("rows").at(0);
}

TEST_F(AnalysisInR, WithoutRSaysWhatToInstallAndWritesWhatRIsAsked) {
  const auto table = file("people.csv", "team,g,y\n1,a,1\n1,b,2\n2,a,4\n2,b,9\n3,a,4\n3,b,7\n");
  const auto ran = err_of(4, {"analyze", table, "--model", "y ~ g + (1|team)", "--r", scratch_ / "r"}, kWithoutR);
  EXPECT_THAT(ran, AllOf(HasSubstr("this model needs R"), HasSubstr("apt install r-base-core r-cran-lme4")));
  for (const auto* const name : {"data.csv", "plan.json", "analysis.R"})
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::path{scratch_ / "r"} / name)) << name;
  EXPECT_EQ(Json::parse(text_of(scratch_ / "r/plan.json")).at("formula"), "y ~ g + (1|team)");
}

TEST_F(AnalysisInR, WithoutRABalancedTableIsAnalysed) {
  const auto ran = out_of({"analyze", file("t.csv", balanced_rows()), "--model", "y ~ g*h"}, kWithoutR);
  EXPECT_THAT(ran, AllOf(HasSubstr("R is not installed"), HasSubstr("Analysis of variance (type II)")));
}

TEST_F(AnalysisInR, ABalancedTableHasTheSameFAsWithoutR) {
  SKIP_WITHOUT_R();
  const std::vector<std::string> asked{"analyze", file("t.csv", balanced_rows()), "--model", "y ~ g*h", "--json"};
  const auto by_r = run_kith(asked), by_kith = run_kith(asked, kWithoutR);
  ASSERT_EQ(by_r.code, 0) << by_r.err;
  const double f = first_test(by_kith).at("f");
  EXPECT_NEAR(first_test(by_r).at("f").get<double>(), f, 1e-4 * f);
  EXPECT_NEAR(first_test(by_r).at("p_value").get<double>(), first_test(by_kith).at("p_value").get<double>(), 1e-4);
}

// One clear line each, whatever is wrong.
TEST_F(AnalysisInR, SaysWhatIsWrongWithATable) {
  SKIP_WITHOUT_R();
  const auto table = file("people.csv", "g,y\na,1\nb,two\nb,3\na,4\n");
  const auto failing = [&](const std::string& formula) {
    const auto ran = run_kith({"analyze", table, "--model", formula});
    EXPECT_EQ(ran.code, 4) << formula;
    return ran.err;
  };
  EXPECT_THAT(failing("y ~ g"), HasSubstr("people.csv: error[E0904]: column 'y' holds text, such as 'two'"));
  EXPECT_THAT(failing("y ~ h"), HasSubstr("there is no column 'h'; the columns are g and y"));
  EXPECT_THAT(failing("y ~"), HasSubstr("the model 'y ~' cannot be read"));
}

// Every family of models; libs/analysis has what is made of the results.
TEST_F(AnalysisInR, FitsRatingsCountsAndCrossedPeople) {
  SKIP_WITHOUT_R();
  std::string text = "person,item,g,age,ease,n,y\n";
  for (int i = 0; i < 96; ++i) {
    const int person = i % 12, item = i / 12;
    text += "s" + std::to_string(person) + ",i" + std::to_string(item) + ((person + item) % 2 == 0 ? ",a," : ",b,");
    text += std::to_string(20 + person * 7 % 31) + "," + std::to_string(1 + (i * i * 7 + i) % 11 % 5) + ",";
    text += std::to_string((i * 5 + person) % 7) + "," + std::to_string((i * 13 + person * 5) % 17) + "\n";
  }
  const auto table = file("t.csv", text);
  const auto sentence = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"analyze", table, "--model"};
    words.insert(words.end(), options.begin(), options.end());
    return out_of(words);
  };
  EXPECT_THAT(sentence({"ease ~ g", "--ordinal"}), HasSubstr("Proportional odds model of ease"));
  // The test for a paper is that of the table above it.
  EXPECT_THAT(sentence({"n ~ g + (1|person)", "--count"}), AllOf(HasSubstr("Poisson"), Not(HasSubstr("squared("))));
  EXPECT_THAT(sentence({"n ~ g", "--count"}), HasSubstr("Ratios of means"));
  EXPECT_THAT(sentence({"y ~ age"}), AllOf(HasSubstr("Slopes of covariates"), HasSubstr("F(1, 94)")));
  EXPECT_THAT(sentence({"y ~ g + age + (1|person) + (1|item)"}),
              AllOf(HasSubstr("Variances and intraclass correlations"), HasSubstr("Slopes of covariates")));
}

// Nobody of c is left when the first ends, so that two groups are compared: chi-squared(1).
TEST_F(AnalysisInR, LogRankTestsCompareGroupsThatWereLeft) {
  SKIP_WITHOUT_R();
  const auto table = file("t.csv", "g,n,done\na,3,1\na,5,1\na,6,1\nb,4,1\nb,7,1\nb,8,0\nc,1,0\nc,2,0\nc,2,0\n");
  const auto ran = Json::parse(out_of({"analyze", table, "--model", "n ~ g", "--observed", "done", "--json"}));
  Json row;
  for (const auto& one : ran.at("findings").at(0).at("tables"))
    if (one.at("caption") == "Log-rank test") row = one.at("rows").at(0);
  EXPECT_EQ(row.at("df"), 1);
}

}  // namespace
}  // namespace kith::testing
