#include <gtest/gtest.h>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

TEST(StudyCommand, PrintsATableAndSaysWhereTheTablesAre) {
  const Scratch scratch;
  const auto ran = run_kith({"study", "quick", "-o", scratch / "run"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("strategy"), HasSubstr("baseline"), HasSubstr("all groups"), HasSubstr("all baseline")));
  EXPECT_THAT(ran.err, HasSubstr("6 teams in"));
  EXPECT_EQ(tables_in(scratch / "run").size(), 7u);
}

TEST(StudyCommand, GivesOtherTeamsForAnotherSeed) {
  const Scratch scratch;
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "a"}).code, 0);
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "b", "--seed", "2"}).code, 0);
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "c", "--set", "seed=2"}).code, 0);
  EXPECT_NE(tables_in(scratch / "a").at("learners.csv"), tables_in(scratch / "b").at("learners.csv"));
  EXPECT_EQ(tables_in(scratch / "b"), tables_in(scratch / "c"));
}

TEST(StudyCommand, RunsAgainFromItsFrozenInputs) {
  const Scratch scratch;
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "a", "--set", "replicates=2"}).code, 0);
  expect_code(0, {"study", scratch / "a/inputs/study.toml", "-o", scratch / "b"});
  EXPECT_EQ(tables_in(scratch / "a"), tables_in(scratch / "b"));
}

TEST(StudyCommand, KeepsTheResultsOfAnotherStudyUnlessTold) {
  const Scratch scratch;
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "run"}).code, 0);
  const auto before = tables_in(scratch / "run");
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "run"}).code, 0);
  EXPECT_EQ(tables_in(scratch / "run"), before);
  EXPECT_THAT(err_of(2, {"study", "quick", "-o", scratch / "run", "--seed", "2"}), HasSubstr("--yes"));
  EXPECT_EQ(tables_in(scratch / "run"), before);
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "run", "--seed", "2", "--yes"}).code, 0);
  EXPECT_NE(tables_in(scratch / "run"), before);
}

TEST(StudyCommand, CannotWriteBelowAFile) {
  const Scratch scratch;
  std::ofstream{scratch / "file"} << "x";
  EXPECT_THAT(err_of(5, {"study", "quick", "-o", scratch / "file/run"}), HasSubstr("file/run"));
}

TEST(StudyCommand, SummarizesInJson) {
  const Scratch scratch;
  const auto document = json_of({"study", "quick", "-o", scratch / "run"});
  EXPECT_EQ(document.at("schema"), "kith.study/1");
  EXPECT_EQ(document.at("teams"), 6);
  EXPECT_TRUE(document.at("seconds").is_number());
  ASSERT_EQ(document.at("cells").size(), 2u);
  for (const auto* key : {"strategy", "composition", "teams", "completed", "periods", "knowledge", "area_sr"}) {
    EXPECT_TRUE(document["cells"][0].contains(key)) << key;
  }
  for (const auto* group : {"group", "baseline"}) {
    const auto& pooled = document.at("groups").at(group);
    EXPECT_EQ(pooled.at("teams"), 3);
    EXPECT_TRUE(pooled.at("periods").at("sd").is_number());
  }
}

TEST(StudyCommand, ShowsVariedKeysAsColumns) {
  const Scratch scratch;
  const auto ran = out_of({"study", "quick", "-o", scratch / "run", "--set", "design.vary={\"stop.max_periods\"=[1,2]}",
                           "--set", "replicates=1", "-q"});
  EXPECT_THAT(ran, HasSubstr("stop.max_periods"));
  EXPECT_THAT(tables_in(scratch / "run").at("teams.csv"), HasSubstr("composition,stop.max_periods,replicate,team"));
}

// Beyond three features knowledge says little, and the exam leads.
TEST(StudyCommand, LeadsWithTheExamBeyondThreeFeatures) {
  const Scratch scratch;
  const auto headed = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> args{"study", "quick",
                                  "-o",    scratch / name,
                                  "--set", "replicates=1",
                                  "--set", "design.strategies=[\"common\"]",
                                  "--set", "stop.max_periods=1",
                                  "-q"};
    for (auto& setting : more) args.insert(args.end(), {"--set", std::move(setting)});
    return out_of(args);
  };
  const std::string robot = "domain=\"rescue-floor\"";
  EXPECT_THAT(headed("period", {robot, "record.exam=\"period\""}),
              AllOf(HasSubstr("regret before"), HasSubstr("share right"), HasSubstr("worst member"),
                    Not(HasSubstr("knowledge"))));
  EXPECT_THAT(headed("end", {robot, "record.exam=\"end\""}),
              AllOf(HasSubstr("share right"), Not(HasSubstr("regret before")), Not(HasSubstr("knowledge"))));
  EXPECT_THAT(headed("none", {robot, "record.exam=\"none\""}),
              AllOf(HasSubstr("knowledge"), Not(HasSubstr("share right"))));
  EXPECT_THAT(headed("three", {"record.exam=\"period\""}),
              AllOf(HasSubstr("knowledge"), Not(HasSubstr("share right"))));
}

TEST(StudyCommand, RunsNothingWhenDry) {
  const Scratch scratch;
  const auto ran = run_kith({"study", "paper", "-o", scratch / "run", "--dry-run"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, HasSubstr("300 teams"));
  EXPECT_THAT(ran.err, HasSubstr("simulating 300 teams takes "));
  EXPECT_THAT(ran.err, HasSubstr("tests of a session, in a team of every composition: baseline "));
  EXPECT_EQ(run_kith({"study", "paper", "--dry-run", "-q"}).err, "");
  EXPECT_FALSE(std::filesystem::exists(scratch / "run"));
}

TEST(StudyCommand, SaysInADryRunWhatStandsInItsWay) {
  const Scratch scratch;
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "run", "-q"}).code, 0);
  const auto before = tables_in(scratch / "run");
  std::ofstream{scratch / "file"} << "x";
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "run", "--dry-run"}).code, 0);
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "run", "--dry-run", "--seed", "2"}).code, 2);
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "run", "--dry-run", "--seed", "2", "--yes"}).code, 0);
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "file/run", "--dry-run"}).code, 5);
  EXPECT_EQ(tables_in(scratch / "run"), before);
}

TEST(StudyCommand, ReportsProgressAsJsonLines) {
  const Scratch scratch;
  const auto ran = run_kith({"study", "quick", "-o", scratch / "run", "--progress", "json", "-q"});
  ASSERT_EQ(ran.code, 0);
  const auto last = Json::parse(ran.err.substr(ran.err.find('{')));
  EXPECT_EQ(last.at("done"), 6);
  EXPECT_EQ(last.at("total"), 6);
}

TEST(TeachCommand, IsDeterministicAndFollowsTheSeed) {
  const std::vector<std::string> arguments{"teach", "item-delivery", "--group", "NP", "--strategy", "joint", "--seed"};
  const auto with_seed = [&](const std::string& seed) {
    auto all = arguments;
    all.push_back(seed);
    return run_kith(all);
  };
  const auto first = with_seed("3");
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(first.out, with_seed("3").out);
  EXPECT_NE(first.out, with_seed("4").out);
}

TEST(TeachCommand, ReplaysATeamOfAStudy) {
  const Scratch scratch;
  ASSERT_EQ(run_kith({"study", "quick", "-o", scratch / "run"}).code, 0);
  // Teams 1 to 3 are taught alone, 4 to 6 together.
  for (const std::string team : {"2", "5"}) {
    const auto document = json_of({"teach", "--from", scratch / "run", "--team", team});
    EXPECT_EQ(document.at("schema"), "kith.teach/1");
    EXPECT_EQ(document.at("sessions").size(), team == "2" ? 2u : 1u);
    // The row of the same team says the same.
    const auto row = "," + team + "," + document.at("seed_address").get<std::string>() + ",complete,true," +
                     document.at("periods").dump() + "," + document.at("demonstrations").dump() + "," +
                     document.at("tests").dump() + "," + document.at("knowledge").dump() + ",";
    EXPECT_THAT(tables_in(scratch / "run").at("teams.csv"), HasSubstr(row));
  }
  for (const std::string team : {"7", "0", "-1", "x"}) {
    const auto refused = run_kith({"teach", "--from", scratch / "run", "--team", team});
    EXPECT_EQ(refused.code, 2) << team;
    EXPECT_THAT(refused.err, HasSubstr("--team must be an integer from 1 to 6, not '" + team + "'"));
  }
}

}  // namespace
}  // namespace kith::testing
