#include "kith/report/report.hpp"
#include "kith/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "kith/analysis/moments.hpp"
#include "kith/analysis/tests.hpp"
#include "runs.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using namespace kith::testing;

constexpr double kTiny = 1e-12;
constexpr double kStudent1 = 12.706204736432095;  // 97.5 % quantile of Student's t with 1 degree of freedom

Json report_of(const std::vector<std::string>& settings) {
  const ScratchFolder scratch;
  run_tiny_study(scratch / "run", settings);
  return Json::parse(build_report(scratch / "run"));
}

// The report of teams that were made up, computed once.
class InventedReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const ScratchFolder scratch;
    publish(scratch / "run", tiny_study(), invented_teams());
    document_ = new Json(Json::parse(build_report(scratch / "run")));
  }
  static void TearDownTestSuite() { delete document_; }
  static std::vector<Json> rows(const std::string& table, const std::vector<Json>& keys) {
    return rows_of(*document_, table, keys);
  }
  static Json* document_;
};
Json* InventedReport::document_ = nullptr;

TEST_F(InventedReport, HasMeansWithIntervalsPerCell) {
  const auto row = rows("cells", {"common", "NP"}).at(0);
  EXPECT_EQ(row.at(2), 2);
  EXPECT_EQ(row.at(3), 2);
  EXPECT_NEAR(row.at(4).get<double>(), 5.0, kTiny);             // (4 + 6) / 2
  EXPECT_NEAR(row.at(5).get<double>(), std::sqrt(2.0), kTiny);  // sd of two values 2 apart
  EXPECT_NEAR(row.at(6).get<double>(), 5.0 - kStudent1, 1e-9);  // sd / sqrt(n) is 1
  EXPECT_NEAR(row.at(7).get<double>(), 5.0 + kStudent1, 1e-9);
  EXPECT_NEAR(row.at(8).get<double>(), 0.6, kTiny);             // knowledge
  EXPECT_NEAR(row.at(12).get<double>(), 3.5, kTiny);            // area
  EXPECT_EQ(rows("cells", {"baseline", "NP"}).at(0).at(3), 1);  // one of them did not complete
}

TEST_F(InventedReport, ListsEveryTeamAsItIsInItsTable) {
  EXPECT_EQ(rows("teams", {"common"}).at(1), Json::parse(R"(["common", "NP", 2, 4, 6, 0.7, true])"));
  EXPECT_EQ(rows("teams", {"baseline"}).at(1), Json::parse(R"(["baseline", "NP", 2, 2, 5, 0.4, false])"));
}

TEST_F(InventedReport, EstimatesCompletionWithCensoredTeams) {
  const auto common = rows("completion", {"common", "NP"});
  ASSERT_THAT(common, SizeIs(3));
  EXPECT_EQ(common[0], Json::parse(R"(["common", "NP", 0, 0.0, 0.0, 0.0, 2])"));
  EXPECT_EQ(common[1].at(2), 4);
  EXPECT_NEAR(common[1].at(3).get<double>(), 0.5, kTiny);
  EXPECT_EQ(common[2], Json::parse(R"(["common", "NP", 6, 1.0, 1.0, 1.0, 1])"));
  const auto baseline = rows("completion", {"baseline", "NP"});
  EXPECT_EQ(baseline.back().at(2), 5);
  EXPECT_NEAR(baseline.back().at(3).get<double>(), 0.5, kTiny);  // the second team is censored at 5
}

TEST_F(InventedReport, LeavesOutTheFirstPeriodOfAComponentFromAreas) {
  const auto first = rows("area", {"common", 1}).at(0);
  EXPECT_NEAR(first.at(2).get<double>(), 1.5, kTiny);  // log areas 1 of one team and 2 of the other
  EXPECT_NEAR(first.at(5).get<double>(), (std::exp(1.0) + std::exp(2.0)) / 2.0, 1e-9);
  EXPECT_EQ(first.at(6), 2);
  EXPECT_NEAR(rows("area", {"common", 2}).at(0).at(2).get<double>(), 3.0, kTiny);
  EXPECT_THAT(rows("area", {"common", 3}), IsEmpty());
  // In the baseline the first period of every member; one team is not enough for an interval.
  const auto baseline = rows("area", {"baseline", 1}).at(0);
  EXPECT_NEAR(baseline.at(2).get<double>(), 0.5, kTiny);
  EXPECT_TRUE(baseline.at(3).is_null());
}

TEST_F(InventedReport, CountsThePeriodsOfComponents) {
  EXPECT_NEAR(rows("periods_by_component", {"common", "NP", 1}).at(0).at(3).get<double>(), 3.0, kTiny);
  EXPECT_NEAR(rows("periods_by_component", {"common", "NP", 2}).at(0).at(3).get<double>(), 2.0, kTiny);
  EXPECT_NEAR(rows("periods_by_component", {"common", "NP", 3}).at(0).at(3).get<double>(), 0.0, kTiny);
  EXPECT_NEAR(rows("periods_by_component", {"baseline", "NP", 1}).at(0).at(3).get<double>(), 1.5, kTiny);
}

TEST_F(InventedReport, FollowsPeopleOverPeriods) {
  const auto knowledge = rows("knowledge_by_period", {"common", "N"});
  ASSERT_THAT(knowledge, SizeIs(4));  // before teaching, and three periods
  EXPECT_EQ(knowledge[0].at(2), 0);
  EXPECT_EQ(knowledge[0].at(6), 2);
  EXPECT_NEAR(knowledge[1].at(3).get<double>(), 0.2, kTiny);
  // Of two people one is no longer taught, and counts with the 0.3 that they knew last.
  EXPECT_NEAR(knowledge[2].at(3).get<double>(), (0.25 + 0.3) / 2.0, kTiny);
  EXPECT_EQ(knowledge[2].at(6), 2);
}

TEST_F(InventedReport, CountsRightAnswers) {
  const auto row = rows("correct_by_period", {"common", "N"}).at(0);
  EXPECT_NEAR(row.at(3).get<double>(), 0.75, kTiny);
  EXPECT_EQ(row.at(6), 4);
  // Wilson's interval of 3 in 4: (p + z^2/2n -+ z sqrt(p q / n + z^2 / 4 n^2)) / (1 + z^2 / n) with z = 1.959964.
  EXPECT_NEAR(row.at(4).get<double>(), 0.300642, 1e-6);
  EXPECT_NEAR(row.at(5).get<double>(), 0.954413, 1e-6);
}

// Teams needed 4 and 6 periods together, their members 3 and 5 alone: paired, the difference is 1 without any spread.
TEST_F(InventedReport, BeginsWithWhatWasFoundAndHowLargeItIs) {
  const auto& overview = document_->at("overview");
  EXPECT_EQ(overview.at("summary").at(0),
            "4 teams of 2 simulated people were taught how a robot decides by watching what it does, in 2 ways.");
  EXPECT_THAT(
      overview.at("finding").get<std::string>(),
      ::testing::StartsWith("Too few teams to tell whether teaching together takes fewer periods than one after "
                            "the other: 5.0 and 4.0 on average (n = 2)"));
  const auto& answers = overview.at("answers");
  ASSERT_EQ(answers.size(), 3u);  // one group strategy and one composition: only the baseline to compare with
  EXPECT_EQ(answers.at(0).at("outcome"), "periods");
  EXPECT_EQ(answers.at(0).at("means"), "5.0 and 4.0");
  EXPECT_EQ(answers.at(1).at("outcome"), "person-periods");
  EXPECT_EQ(answers.at(1).at("means"), "10.0 and 4.0");
  EXPECT_EQ(answers.at(2).at("means"), "0.60 and 0.30");
}

TEST_F(InventedReport, SaysWhatTheStudyCannotSay) {
  const auto limits = document_->at("overview").at("limits").dump();
  EXPECT_THAT(limits, HasSubstr("The learners are simulated."));
  EXPECT_THAT(limits, HasSubstr("3 of 4 teams passed"));
  EXPECT_THAT(limits, HasSubstr("0.60 together and 0.30 one after the other on average"));
  EXPECT_THAT(limits, HasSubstr("together, 5.0 periods are 10.0 person-periods; one after the other, 4.0 periods are "
                                "4.0 person-periods"));
}

TEST_F(InventedReport, ComparesStrategiesWithTheBaseline) {
  const auto& differences = document_->at("overview").at("differences");
  ASSERT_EQ(differences.at("groups").size(), 1u);  // one composition
  const auto& group = differences.at("groups").at(0);
  EXPECT_EQ(group.at("against"), "baseline");
  ASSERT_EQ(group.at("rows").size(), 1u);
  EXPECT_EQ(group.at("rows").at(0).at("code"), "common");
  const auto& periods = group.at("rows").at(0).at("differences").at(0);
  EXPECT_NEAR(periods.at("estimate").get<double>(), 1.0, kTiny);
  EXPECT_EQ(periods.at("n"), 2);
}

TEST_F(InventedReport, SpellsOutItsCodes) {
  const auto& meanings = document_->at("labels").at("meanings");
  EXPECT_EQ(meanings.at("strategies").at("common"), "teach for what all members know");
  EXPECT_EQ(meanings.at("strategies").at("baseline"), "teach the members one after the other, each alone");
  EXPECT_EQ(meanings.at("compositions").at("NP"), "1 novice, 1 proficient");
}

TEST_F(InventedReport, LeavesOutSpheresThatDoNotFitTheTables) {
  EXPECT_FALSE(document_->contains("beliefs"));
  EXPECT_THAT(document_->at("notes").dump(), HasSubstr("does not match tables/teams.csv"));
}

TEST_F(InventedReport, CountsCensoredTeams) {
  EXPECT_THAT(document_->at("notes").dump(), HasSubstr("1 of 4 teams reached the limit of 50 periods"));
  EXPECT_EQ(document_->at("overview").at("completed"), 3);
}

// A report of a study that was run.
class RealReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    run_tiny_study(*scratch_ / "run");
    text_ = new std::string(build_report(*scratch_ / "run"));
    document_ = new Json(Json::parse(*text_));
  }
  static void TearDownTestSuite() {
    delete document_;
    delete text_;
    delete scratch_;
  }
  static ScratchFolder* scratch_;
  static std::string* text_;
  static Json* document_;
};
ScratchFolder* RealReport::scratch_ = nullptr;
std::string* RealReport::text_ = nullptr;
Json* RealReport::document_ = nullptr;

TEST_F(RealReport, IsTheSameForEqualFoldersWhereverTheyAre) {
  std::filesystem::copy(*scratch_ / "run", *scratch_ / "elsewhere", std::filesystem::copy_options::recursive);
  EXPECT_EQ(build_report(*scratch_ / "elsewhere"), *text_);
}

TEST_F(RealReport, IsSmallAndPlain) {
  EXPECT_LT(text_->size(), 400'000u);
  for (const char c : *text_) ASSERT_TRUE(c >= ' ' && c <= '~');
}

TEST_F(RealReport, SaysWhenAndByWhatTheRunWasMade) {
  EXPECT_EQ(document_->at("schema"), "kith.report/1");
  EXPECT_EQ(document_->at("created"), "2026-01-31T12:00:00Z");
  EXPECT_EQ(document_->at("reproduce").at("version"), "kith 1.2.3 (git abc)");
  EXPECT_TRUE(document_->at("reproduce").at("hashes").contains("tables/progress.csv"));
  EXPECT_EQ(document_->at("tables").at("timings").at("rows"), Json::parse(R"([["teach", 1.5]])"));
}

TEST_F(RealReport, GivesEveryParameterAMeaning) {
  for (const auto& row : document_->at("tables").at("parameters").at("rows")) {
    EXPECT_FALSE(row.at(3).get<std::string>().empty()) << row;
  }
}

TEST_F(RealReport, WritesAMethodsParagraphWithItsReferences) {
  const auto paragraph = document_->at("methods").at("paragraph").get<std::string>();
  for (const auto* fact :
       {"4 teams of 2 learners", "kith 1.2.3 (abc)", "seed 1.", "0.703 (novice) and 0.809 (proficient)", "60 particles",
        "(Jayaraman et al., 2024)", "common random numbers; Salmon et al., 2011)", "0.05 rad", "at most 50 periods",
        "Taught together or alone (periods and knowledge): a paired t test of the same people"}) {
    EXPECT_THAT(paragraph, HasSubstr(fact));
  }
  // Nothing is named that was not done: there is one group strategy and one composition.
  for (const auto* absent : {"Bonferroni", "Tukey", "log-rank", "Poisson", "analysis of variance"}) {
    EXPECT_THAT(paragraph, Not(HasSubstr(absent)));
  }
  for (const auto& reference : document_->at("methods").at("references")) {
    EXPECT_THAT(reference.at("bibtex").get<std::string>(), HasSubstr(reference.at("key").get<std::string>()));
  }
}

TEST_F(RealReport, ShowsTheBeliefsOfTeamsThatWereTaughtAgain) {
  const auto& beliefs = document_->at("beliefs");
  EXPECT_EQ(beliefs.at("regions").at(0).at("label"), "policy (BEC)");
  ASSERT_GE(beliefs.at("teams").size(), 2u);
  for (const auto& team : beliefs.at("teams")) {
    EXPECT_EQ(team.at("strategy"), "common");
    EXPECT_THAT(team.at("beliefs"), SizeIs(4));  // two members, common, joint
    const auto frames = team.at("periods").get<std::size_t>() + 1;
    EXPECT_THAT(team.at("mass"), SizeIs(frames));
    EXPECT_THAT(team.at("components"), SizeIs(frames - 1));
    const auto bytes = frames * 4 * team.at("particles").at("count").get<std::size_t>() * 6;
    EXPECT_EQ(team.at("particles").at("data").get<std::string>().size(), (bytes + 2) / 3 * 4);
    // What members know at the end is what their table says of the team.
    const auto number = team.at("team").get<std::size_t>();
    const auto row = rows_of(*document_, "teams", {"common", "NP", number - 2}).at(0);
    const auto& last = team.at("mass").back();
    EXPECT_NEAR((last.at(0).get<double>() + last.at(1).get<double>()) / 2.0, row.at(5).get<double>(), kTiny);
  }
}

TEST_F(RealReport, TellsTheLessonsOfEveryTeam) {
  const auto& lessons = document_->at("lessons");
  EXPECT_EQ(lessons.at("features"), Json::parse(R"(["rubble", "recharge", "step"])"));
  ASSERT_EQ(lessons.at("teams").size(), 4u);
  const auto boards = lessons.at("boards").size(), sentences = lessons.at("sentences").size();
  for (const auto& team : lessons.at("teams")) {
    const bool alone = team.at("strategy") == "baseline";
    for (const auto& period : team.at("periods")) {
      EXPECT_EQ(period.at(2) == 0, !alone) << "members of the baseline have lessons of their own";
      EXPECT_FALSE(period.at(3).empty()) << "something was shown";
      for (const auto& board : period.at(3)) EXPECT_LT(board.get<std::size_t>(), boards);
      for (const auto& sentence : period.at(4)) EXPECT_LT(sentence.get<std::size_t>(), sentences);
      for (const auto& test : period.at(5)) {
        EXPECT_LT(test.at(0).get<std::size_t>(), boards);
        EXPECT_EQ(test.at(1).get<std::string>().size(), alone ? 1u : 2u);
      }
      for (const auto& knowledge : period.at(6)) EXPECT_LE(knowledge.get<int>(), 100);
    }
    // As many periods as the table of teams says.
    const auto rows = rows_of(*document_, "teams", {team.at("strategy"), team.at("composition"), team.at("replicate")});
    EXPECT_EQ(team.at("periods").size(), rows.at(0).at(4).get<std::size_t>());
  }
  // Every board has its world's map and the robot's whole path.
  for (const auto& board : lessons.at("boards")) {
    EXPECT_FALSE(board.at("map").empty());
    EXPECT_TRUE(board.at("frames").back().at("action").is_null());
  }
}

TEST_F(RealReport, RefusesTablesThatWereChanged) {
  std::filesystem::copy(*scratch_ / "run", *scratch_ / "changed", std::filesystem::copy_options::recursive);
  edit(*scratch_ / "changed/tables/responses.csv", ",true,", ",false,");
  try {
    (void)build_report(*scratch_ / "changed");
    ADD_FAILURE() << "a report was made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMismatch);
    EXPECT_THAT(error.what(), HasSubstr("E0607"));
  }
}

TEST(Report, ShowsEstimatesBesideTheTruth) {
  const auto few = report_of({"record.estimates=true", "replicates=4"}).at("tables");
  std::size_t periods = 0;
  for (const auto& row : few.at("mastery_calibration").at("rows")) {
    EXPECT_GE(row.at(1).get<double>(), row.at(2).get<double>());
    EXPECT_LE(row.at(1).get<double>(), row.at(3).get<double>());
    periods += row.at(4).get<std::size_t>();
  }
  EXPECT_GT(periods, 16u);                                      // of 8 teams
  EXPECT_TRUE(few.at("ability_estimates").at("rows").empty());  // of 8 people with each strategy

  const auto more = report_of({"record.estimates=true", "replicates=6"}).at("tables");
  const auto& first = more.at("ability_estimates").at("rows").at(0);
  EXPECT_EQ(first.at(1), 0);  // before the first period
  EXPECT_EQ(first.at(2), 12);
  EXPECT_TRUE(first.at(3).is_null());  // all estimates are the same
}

TEST(Report, SaysInHowManyTeamsBeliefsWereImpoverished) {
  const auto notes_of = [](const std::vector<std::string>& settings) { return report_of(settings).at("notes").dump(); };
  const std::string few = "learner.N.particles=20";
  EXPECT_THAT(notes_of({"record.beliefs=true", few, "learner.P.particles=20"}),
              HasSubstr("teams (100 %), the belief of a member had fewer than 10 effective particles"));
  EXPECT_THAT(notes_of({"record.beliefs=true", "learner.N.particles=1000", "learner.P.particles=1000"}),
              Not(HasSubstr("effective particles")));
  EXPECT_THAT(notes_of({few}), Not(HasSubstr("effective particles")));
}

TEST(Report, OfTeamsAloneHasNoFiguresOverPeriods) {
  const auto document = report_of({"record.level=\"team\""});
  std::set<std::string> tables;
  for (const auto& [name, table] : document.at("tables").items()) tables.insert(name);
  EXPECT_THAT(tables, ::testing::UnorderedElementsAre("cells", "teams", "completion", "timings", "parameters"));
  EXPECT_THAT(document.at("notes").dump(), HasSubstr("Only teams were recorded"));
  EXPECT_TRUE(document.contains("beliefs"));  // these are computed again
}

TEST(Report, LeadsWithTheExamBeyondThreeFeatures) {
  const auto overview = report_of({"domain=\"rescue-floor\"", "replicates=1", "design.strategies=[\"common\"]",
                                   "record.level=\"team\"", "stop.max_periods=1"})
                            .at("overview");
  EXPECT_EQ(overview.at("leads"), "exam");
  EXPECT_THAT(overview.at("answers").at(1).at("outcome"), "share right in the exam");
  EXPECT_THAT(overview.at("limits").dump(), HasSubstr("the share of starts from which members predict the robot"));
  const auto three = report_of({"replicates=1", "record.level=\"team\"", "record.exam=\"end\""});
  EXPECT_FALSE(three.at("overview").contains("leads"));
}

TEST(Report, TellsSettingsOfVariedKeysApart) {
  const auto document =
      report_of({"replicates=1", "design.strategies=[\"common\"]", "design.vary={\"stop.max_periods\"=[1, 40]}"});
  EXPECT_EQ(document.at("overview").at("strategies"),
            Json::parse(R"(["common [stop.max_periods=1]", "common [stop.max_periods=40]"])"));
  EXPECT_EQ(document.at("labels").at("strategies").at("common [stop.max_periods=1]"), "Max periods 1");
  EXPECT_EQ(document.at("overview").at("factors"), Json::parse(R"(["stop.max_periods"])"));
  EXPECT_FALSE(document.contains("matrices"));  // one strategy
  EXPECT_EQ(document.at("overview").at("differences").at("interval"), "Welch's t intervals");
  // One team a cell has no spread.
  EXPECT_TRUE(document.at("tables").at("cells").at("rows").at(0).at(5).is_null());
}

// Against what the tables of cells and teams say of the same.
TEST(Report, SetsStrategiesAgainstAVariedKey) {
  const auto document =
      report_of({"replicates=4", "record.exam=\"end\"", "design.strategies=[\"common\", \"joint\", \"individual-low\"]",
                 "design.vary={\"learner.N.kind\"=[\"bayesian\", \"imitating\", \"slipping\"]}"});
  ASSERT_THAT(document.at("matrices"), SizeIs(1));
  const auto& matrix = document.at("matrices").at(0);
  EXPECT_EQ(matrix.at("factors"), Json::parse(R"(["learner.N.kind", "strategy"])"));
  EXPECT_EQ(matrix.at("outcomes").at(0).at("column"), "exam_regret");
  const auto& heads = matrix.at("table").at("columns");
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(heads.begin(), heads.end(), name) - heads.begin());
  };
  const auto regrets = [&](const std::string& kind, const std::string& strategy) {
    std::vector<double> values;
    for (const auto& row : rows_of(document, "teams", {strategy + " [learner.N.kind=" + kind + "]"}))
      values.push_back(row.at(8).get<double>());
    return values;
  };

  const auto& rows = matrix.at("table").at("rows");
  ASSERT_THAT(rows, SizeIs(9));
  for (const auto& row : rows) {
    const auto kind = row.at(0).get<std::string>();
    const auto values = regrets(kind, row.at(1).get<std::string>());
    ASSERT_THAT(values, SizeIs(4));
    EXPECT_EQ(row.at(2), 4);
    EXPECT_NEAR(row.at(place("exam_regret_mean")).get<double>(), mean(values), kTiny);
    const auto best = std::min_element(rows.begin(), rows.end(), [&](const Json& a, const Json& b) {
      const auto cost = [&](const Json& r) { return r.at(0) == kind ? mean(regrets(kind, r.at(1))) : 1e9; };
      return cost(a) < cost(b);
    });
    const auto least = regrets(kind, best->at(1));
    const auto difference = paired_t_test(values, least);
    const bool is_clear = !difference || difference->low > 0.0;
    const bool is_best = mean(values) <= mean(least) + kTiny;
    EXPECT_EQ(row.at(place("exam_regret_standing")), is_best ? "best" : (is_clear ? "" : "not clearly worse")) << row;
  }
}

// A setting that changes nothing adds nobody.
TEST(Report, CountsTheSamePeopleOnceOverSettings) {
  const auto compositions_with = [](const std::string& settings) {
    return report_of({"replicates=3", "design.compositions=[\"NN\", \"PP\"]",
                      "design.vary={\"stop.max_periods\"=[" + settings + "]}"})
        .at(Json::json_pointer{"/overview/differences/groups"})
        .back();
  };
  const auto once = compositions_with("500"), twice = compositions_with("500,501");
  EXPECT_EQ(once.at("factor"), "composition");
  EXPECT_EQ(once.at("rows"), twice.at("rows"));
}

// Every team counts, whatever else varies.
TEST(Report, SetsCompositionsAgainstAVariedKeyOverAllStrategies) {
  const auto document =
      report_of({"replicates=2", "design.compositions=[\"NN\", \"NP\", \"PP\"]",
                 "design.strategies=[\"common\", \"joint\"]", "design.vary={\"stop.max_periods\"=[1, 2, 40]}"});
  ASSERT_THAT(document.at("matrices"), SizeIs(1));
  for (const auto& row : document.at("matrices").at(0).at("table").at("rows")) {
    const auto setting = " [stop.max_periods=" + row.at(1).get<std::string>() + "]";
    std::vector<double> knowledge;
    for (const auto* strategy : {"common", "joint"})
      for (const auto& team : rows_of(document, "teams", {strategy + setting, row.at(0)}))
        knowledge.push_back(team.at(5).get<double>());
    EXPECT_EQ(row.at(2), 4);
    EXPECT_NEAR(row.at(3).get<double>(), mean(knowledge), kTiny);
  }
}

TEST(Report, SaysWhetherStrategiesAndCompositionsMadeADifference) {
  const auto document =
      report_of({"design.strategies=[\"common\", \"joint\"]", "design.compositions=[\"NN\", \"PP\"]"});
  // Every question has its p-value, and an effect where it is small, else what any two levels differ by at most.
  const auto& answers = document.at("overview").at("answers");
  std::size_t shown = 0;
  for (const auto& answer : answers) {
    const bool is_shown = answer.at("p").get<double>() < 0.05;
    EXPECT_EQ(answer.at("answer") == "too few teams to tell", !is_shown) << answer;
    EXPECT_EQ(answer.at("bound").is_null(), is_shown) << answer;
    EXPECT_EQ(answer.at("estimate").is_null(), !is_shown) << answer;
    if (is_shown) {
      EXPECT_LE(answer.at("low"), answer.at("estimate"));
      EXPECT_GE(answer.at("high"), answer.at("estimate"));
      ++shown;
    }
  }
  EXPECT_EQ(answers.size(), 4u);  // strategy and composition, periods and knowledge
  EXPECT_LT(shown, 4u);
  for (const auto& finding : document.at("findings")) {
    if (finding.at("id") != "periods") continue;
    EXPECT_EQ(finding.at("tables").at(0).at("rows").at(0).at("p_value"), answers.at(0).at("p"));
  }
  EXPECT_THAT(document.at("overview").at("finding").get<std::string>(), HasSubstr("the 2 strategies"));
}

TEST(Report, OfOneCellHasNothingToTest) {
  const auto document = report_of({"design.strategies=[\"common\"]"});
  EXPECT_THAT(document.at("findings"), IsEmpty());
  EXPECT_THAT(document.at("notes"),
              ElementsAre(::testing::ResultOf([](const Json& note) { return note.get<std::string>(); },
                                              ::testing::StartsWith("Nothing was tested: "))));
  EXPECT_THAT(document.at("notes").dump(), Not(HasSubstr("teams.csv")));
}

}  // namespace
}  // namespace kith
