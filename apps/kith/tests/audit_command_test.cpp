#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

std::vector<std::string> study(const std::string& folder, const std::string& setting = "replicates=2") {
  return {"study", "quick", "-o", folder, "--set", setting, "-q"};
}

// A run of four teams.
class AuditCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new Scratch;
    ASSERT_EQ(run_kith(study(*scratch_ / "run")).code, 0);
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }
  [[nodiscard]] static std::string run() { return *scratch_ / "run"; }

  static Scratch* scratch_;
};
Scratch* AuditCommand::scratch_ = nullptr;

TEST_F(AuditCommand, SaysWhoUnderstandsWhat) {
  const auto ran = out_of({"audit", run(), "--team", "3"});
  EXPECT_THAT(ran, HasSubstr("team 3 (common, NP, replicate 1)"));
  EXPECT_THAT(ran, HasSubstr("Member 1 (N)"));
  EXPECT_THAT(ran, HasSubstr("1. crossing rubble versus steps: "));
  EXPECT_THAT(ran, HasSubstr("next: "));
  EXPECT_THAT(ran, HasSubstr("answers are right, "));
  std::istringstream lines{ran};
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
}

TEST_F(AuditCommand, JudgesEverybodyAlikeOnAnyNumberOfThreads) {
  const auto one = run_kith({"audit", run(), "--json", "-j", "1"});
  const auto two = run_kith({"audit", run(), "--json", "-j", "2"});
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
  const auto document = Json::parse(one.out);
  EXPECT_EQ(document.at("schema"), "kith.audit/1");
  ASSERT_EQ(document.at("people").size(), 8u);
  // A team by itself gives the same.
  const auto team = Json::parse(run_kith({"audit", run(), "--json", "--team", "2"}).out);
  ASSERT_EQ(team.at("people").size(), 2u);
  EXPECT_EQ(team.at("people")[0], document.at("people")[2]);
  for (const auto& person : document.at("people")) {
    for (const auto& component : person.at("components")) {
      EXPECT_LE(component.at("level").at("low"), component.at("level").at("mean"));
      EXPECT_LE(component.at("level").at("mean"), component.at("level").at("high"));
      EXPECT_LE(component.at("correct"), component.at("tests"));
    }
  }
}

TEST_F(AuditCommand, WritesAPageThatLoadsNothing) {
  const auto out = *scratch_ / "audit.html";
  EXPECT_EQ(run_kith({"audit", run(), "--team", "1", "-o", out, "-q"}).code, 0);
  const auto page = text_of(out);
  EXPECT_THAT(page, HasSubstr("<title>Who understands what: run</title>"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr(run()))) << "where the folder is on this machine";
}

// In text, JSON and page alike; of a study that does not ask, nothing is said.
TEST_F(AuditCommand, SaysWhatKindOfLearnerEverybodySeemsToBe) {
  const auto asks = *scratch_ / "asks";
  auto command = study(asks, "replicates=1");
  for (const char* setting : {"teacher.hypotheses=\"kinds\"", "learner.N.kind=\"imitating\"", "stop.max_periods=5"})
    command.insert(command.end(), {"--set", setting});
  ASSERT_EQ(run_kith(command).code, 0);
  const auto people = json_of({"audit", asks}).at("people");
  ASSERT_EQ(people.size(), 4u);
  for (const auto& person : people) {
    double sum = 0.0, most = 0.0;
    std::string likeliest;
    for (const auto& [kind, probability] : person.at("kinds").items()) {
      sum += probability.get<double>();
      if (probability.get<double>() > most) likeliest = kind;
      most = std::max(most, probability.get<double>());
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_EQ(person.at("kind"), most >= 0.8 ? likeliest : "cannot tell yet") << person.at("kinds");
  }
  const auto text = run_kith({"audit", asks}).out;
  const std::string line = "\n  kind of learner: ";
  std::size_t lines = 0;
  for (auto at = text.find(line); at != std::string::npos; at = text.find(line, at + 1)) ++lines;
  EXPECT_EQ(lines, people.size()) << text;
  EXPECT_THAT(run_kith({"audit", asks, "-o", "-", "-q"}).out, HasSubstr("\"kinds\":{"));

  EXPECT_FALSE(json_of({"audit", run()}).at("people").at(0).contains("kind"));
  EXPECT_THAT(run_kith({"audit", run()}).out, Not(HasSubstr("kind of learner")));
}

TEST_F(AuditCommand, NeedsAnswers) {
  const auto teams_only = *scratch_ / "teams-only";
  ASSERT_EQ(run_kith(study(teams_only, "record.level=\"team\"")).code, 0);
  EXPECT_THAT(err_of(4, {"audit", teams_only}), HasSubstr("E1113"));
  EXPECT_THAT(err_of(2, {"audit", run(), "--team", "99"}), HasSubstr("--team must be an integer from 1 to 4"));
  EXPECT_EQ(run_kith({"audit", run(), "--room", "r1"}).code, 2);
  EXPECT_THAT(err_of(5, {"audit", *scratch_ / "nowhere"}), HasSubstr("E1114"));
}

TEST_F(AuditCommand, ReadsTheTeamsThatAreFinished) {
  const auto folder = *scratch_ / "half";
  auto arguments = study(folder, "replicates=8");
  arguments.insert(arguments.end(), {"--shard", "1/2"});
  expect_code(0, arguments);
  EXPECT_EQ(json_of({"audit", folder}).at("people").size(), 16u);
  EXPECT_THAT(err_of(4, {"audit", folder, "--team", "16"}), HasSubstr("E1115"));
}

TEST_F(AuditCommand, ReadsLiveSessions) {
  const auto folder = *scratch_ / "live";
  expect_code(0, {"serve", "quick", "-o", folder, "--rehearse", "1", "--answer-every", "0.05", "-q"});
  const auto ran = out_of({"audit", folder});
  EXPECT_THAT(ran, HasSubstr("room "));
  EXPECT_THAT(ran, HasSubstr("Member 2 (P, a person in seat 2)"));
  EXPECT_EQ(run_kith({"audit", folder, "--team", "1"}).code, 2);
  expect_code(3, {"audit", folder, "--room", "r99"});
}

TEST(ExamCommand, RehearsesAnExamOnAnyNumberOfThreads) {
  const auto one = run_kith({"audit", "--exam", "item-delivery", "--people", "1", "--json", "-j", "1"});
  const auto two = run_kith({"audit", "--exam", "item-delivery", "--people", "1", "--json", "-j", "2"});
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
  const auto document = Json::parse(one.out);
  EXPECT_EQ(document.at("schema"), "kith.exam-rehearsal/1");
  EXPECT_EQ(document.at("boards"), Json({0, 2, 4, 8, 12}));
  EXPECT_EQ(document.at("kinds").size(), 17u);
}

TEST(ExamCommand, NeedsAFolderOrADomain) {
  EXPECT_EQ(run_kith({"audit"}).code, 2);
  EXPECT_EQ(run_kith({"audit", "results", "--exam", "item-delivery"}).code, 2);
}

// An exam goes by what people answered, so a lesson with one is never the page without an engine.
TEST(ExamCommand, MakesLessonsAdapt) {
  const auto lesson = run_kith({"lesson", "item-delivery", "--exam"});
  EXPECT_EQ(lesson.code, 2);
  EXPECT_NE(lesson.err.find("a lesson that adapts is a page"), std::string::npos) << lesson.err;
}

}  // namespace
}  // namespace kith::testing
