#include "kith/runs/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/sha256.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

namespace fs = std::filesystem;

// One team with a value of every kind.
TeamRecord team() {
  TeamRecord record;
  record.address = {0, "joint", "NP", 2, 4};
  record.seed_address = "7/NP/2";
  record.status = SessionStatus::kComplete;
  record.periods = 3;
  record.demonstrations = 5;
  record.tests = 4;
  record.knowledge = 0.5;
  record.knowledge_min = 0.1;
  record.components_learned = 3;
  record.area_sr = 1.0 / 3.0;
  LearnerRecord learner;
  learner.member = 1;
  learner.traits = {0.7, 0.01, 0.02};
  learner.p_bec = 0.25;
  learner.periods = 3;
  learner.tests = 4;
  learner.correct = 2;
  record.learners = {learner};
  record.period_records = {{.period = 1,
                            .component = 1,
                            .source = "member 2",
                            .demonstrations = 2,
                            .area_sr = 0.5,
                            .running_area_sr = 0.25,
                            .tests = 1,
                            .gain = 1.5,
                            .p_bec = {0.1, 0.2}}};
  ResponseRecord wrong;
  wrong.period = 1;
  wrong.component = 1;
  wrong.test = 1;
  wrong.member = 1;
  wrong.mdp = 8;
  wrong.start = 45;
  wrong.regret = 0.5;
  wrong.answer = IntegerVector{2, 0, 8};
  wrong.constraints = {HalfSpace{IntegerVector{1, 0, -2}}, HalfSpace{IntegerVector{0, -1, -4}}};
  ResponseRecord missing = wrong;
  missing.member = 2;
  missing.regret.reset();
  missing.answer.reset();
  missing.constraints.clear();
  wrong.covered = {HalfSpace{IntegerVector{-1, 0, 2}}};
  record.responses = {wrong, missing};
  record.demonstration_records = {
      {.period = 1,
       .member = 0,
       .component = 1,
       .demonstration = 1,
       .mdp = 3,
       .start = 17,
       .constraints = {HalfSpace{IntegerVector{-1, 0, 2}}, HalfSpace{IntegerVector{1, 1, 0}}}},
      {.period = 1, .member = 2, .component = 1, .demonstration = 2, .mdp = 4, .start = 1, .constraints = {}}};
  record.progress = {
      {.period = 1, .component = 1, .member = 2, .type = 'P', .ability = 0.75, .p_bec = 0.125, .all_correct = true}};
  return record;
}

std::map<std::string, std::string> tables_of(const Study& study, const std::vector<TeamRecord>& teams) {
  std::map<std::string, std::string> tables;
  write_study_tables(study, teams,
                     [&](std::string_view file, std::string_view piece) { tables[std::string{file}] += piece; });
  return tables;
}

// With the types of the team's members.
StudySpec spec_of_team() {
  StudySpec spec;
  spec.learner_types.resize(2);
  spec.learner_types[1].letter = 'P';
  return spec;
}

TEST(StudyTables, MatchTheHandWrittenOnes) {
  const auto tables = tables_of({{spec_of_team()}}, {team()});
  EXPECT_EQ(tables.at("teams.csv"),
            "strategy,composition,replicate,team,seed_address,status,completed,periods,demonstrations,tests,knowledge,"
            "knowledge_min,kcs_learned,kcs_skipped,area_sr\n"
            "joint,NP,2,4,7/NP/2,complete,true,3,5,4,0.5,0.1,3,0,0.3333333333333333\n");
  EXPECT_EQ(
      tables.at("learners.csv"),
      "strategy,composition,replicate,team,member,type,ability,confirm_gain,correct_gain,p_bec,periods,tests,correct\n"
      "joint,NP,2,4,1,N,0.7,0.01,0.02,0.25,3,4,2\n");
  EXPECT_EQ(tables.at("periods.csv"),
            "strategy,composition,replicate,team,period,kc,source,demonstrations,area_sr,running_area_sr,tests,"
            "all_correct,excluded,untested,tests_demonstrated,gain,p_bec_common,p_bec_joint\n"
            "joint,NP,2,4,1,1,member 2,2,0.5,0.25,1,false,0,0,0,1.5,0.1,0.2\n");
  EXPECT_EQ(
      tables.at("responses.csv"),
      "strategy,composition,replicate,team,period,kc,test,member,mdp,start,correct,regret,answer,constraint,covered\n"
      "joint,NP,2,4,1,1,1,1,8,45,false,0.5,2 0 8,1 0 -2;0 -1 -4,-1 0 2\n"
      "joint,NP,2,4,1,1,1,2,8,45,false,,,\"\",\"\"\n");
  EXPECT_EQ(tables.at("demonstrations.csv"),
            "strategy,composition,replicate,team,period,member,kc,demonstration,mdp,start,constraint\n"
            "joint,NP,2,4,1,,1,1,3,17,-1 0 2;1 1 0\n"
            "joint,NP,2,4,1,2,1,2,4,1,\"\"\n");
  EXPECT_EQ(tables.at("progress.csv"),
            "strategy,composition,replicate,team,period,kc,member,type,ability,p_bec,all_correct\n"
            "joint,NP,2,4,1,1,2,P,0.75,0.125,true\n");
}

TEST(StudyTables, HaveVariedKeysRightBehindTheComposition) {
  auto spec = spec_of_team();
  spec.factors = {{"stop.max_periods", "3"}, {"teacher.counterfactual_sampling", "spread"}};
  for (const auto& [file, text] : tables_of({{spec}}, {team()})) {
    EXPECT_THAT(text,
                HasSubstr("strategy,composition,stop.max_periods,teacher.counterfactual_sampling,replicate,team,"))
        << file;
    EXPECT_THAT(text, HasSubstr("\njoint,NP,3,spread,2,4,")) << file;
  }
}

TEST(StudyTables, HaveTheirHeadersWithoutATeam) { EXPECT_EQ(tables_of({{StudySpec{}}}, {}).size(), 6u); }

// A folder of its own for every test.
class RunFolderTest : public ::testing::Test {
 protected:
  RunFolderTest() {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~RunFolderTest() override { fs::remove_all(root_); }

  static RunInputs inputs() { return freeze(reading()); }
  static const StudyReading& reading() {
    static const auto kReading = load_study("quick");
    return kReading;
  }
  void run(const fs::path& path, const std::string& log = "", bool replace = false) {
    RunFolder folder{path, inputs(), replace};
    RunFacts facts;
    facts.log = {log};
    folder.publish(*reading().study, std::vector{team()}, facts);
  }
  static std::map<std::string, std::string> content(const fs::path& path) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator{path}) {
      if (entry.is_regular_file()) files[fs::relative(entry.path(), path).string()] = read_file(entry.path());
    }
    return files;
  }
  static ErrorKind kind_of_failure(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::kPartial;  // never thrown here
  }

  fs::path root_ = fs::path{::testing::TempDir()} /
                   ("kith run folder " + std::string{::testing::UnitTest::GetInstance()->current_test_info()->name()});
};

TEST_F(RunFolderTest, HoldsWhatTheDocumentationLists) {
  run(root_ / "new" / "run");
  std::set<std::string> names;
  for (const auto& [name, text] : content(root_ / "new" / "run")) names.insert(name);
  EXPECT_THAT(names, UnorderedElementsAre("manifest.json", "timings.csv", "log.txt", "inputs/study.toml",
                                          "inputs/domain.toml", "tables/teams.csv", "tables/learners.csv",
                                          "tables/periods.csv", "tables/responses.csv", "tables/demonstrations.csv",
                                          "tables/progress.csv", "tables/codebook.json"));
}

TEST_F(RunFolderTest, GetsTheSameBytesAgainFromTheSameStudy) {
  run(root_ / "run", "first");
  const auto before = content(root_ / "run");
  run(root_ / "run", "second");
  const auto after = content(root_ / "run");
  EXPECT_EQ(before.size(), after.size());
  for (const auto& [name, text] : before) {
    if (name != "log.txt") {
      EXPECT_EQ(after.at(name), text) << name;
    }
  }
  EXPECT_EQ(after.at("log.txt"), "second\n");
}

TEST_F(RunFolderTest, NamesTheHashesOfItsTables) {
  run(root_ / "run");
  const auto files = content(root_ / "run");
  EXPECT_THAT(files.at("manifest.json"), HasSubstr(sha256(files.at("tables/teams.csv"))));
  EXPECT_THAT(files.at("manifest.json"), HasSubstr(sha256(files.at("inputs/study.toml"))));
}

TEST_F(RunFolderTest, RefusesTheFolderOfAnotherStudyUnlessTold) {
  run(root_ / "run");
  const auto before = content(root_ / "run");
  auto other = inputs();
  other.study += "# changed\n";
  EXPECT_EQ(kind_of_failure([&] { RunFolder{root_ / "run", other}; }), ErrorKind::kUsage);
  EXPECT_EQ(content(root_ / "run"), before);
  EXPECT_NO_THROW((RunFolder{root_ / "run", other, true}));
}

TEST_F(RunFolderTest, RefusesAFolderWithOtherFilesUnlessTold) {
  std::ofstream{root_ / "precious.txt"} << "data";
  EXPECT_EQ(kind_of_failure([&] { RunFolder{root_, inputs()}; }), ErrorKind::kUsage);
  run(root_, "", true);
  EXPECT_EQ(read_file(root_ / "precious.txt"), "data");
}

TEST_F(RunFolderTest, LeavesNothingBehindWithoutPublishing) {
  { const RunFolder folder{root_ / "run", inputs()}; }
  EXPECT_FALSE(fs::exists(root_ / "run"));
  run(root_ / "run");
  const auto before = content(root_ / "run");
  { const RunFolder folder{root_ / "run", inputs()}; }
  EXPECT_EQ(content(root_ / "run"), before);
}

TEST_F(RunFolderTest, ClearsWhatAKilledRunLeft) {
  fs::create_directories(root_ / "run" / ".kith-staging-1" / "tables");
  run(root_ / "run");
  EXPECT_FALSE(fs::exists(root_ / "run" / ".kith-staging-1"));
}

TEST_F(RunFolderTest, IsBusyWhileSomebodyWritesToIt) {
  const RunFolder folder{root_ / "run", inputs()};
  EXPECT_EQ(kind_of_failure([&] { RunFolder{root_ / "run", inputs()}; }), ErrorKind::kBusy);
  EXPECT_TRUE(fs::exists(root_ / "run"));
}

TEST_F(RunFolderTest, CannotBeWhereAFileIs) {
  std::ofstream{root_ / "file"} << "x";
  EXPECT_EQ(kind_of_failure([&] { RunFolder{root_ / "file" / "run", inputs()}; }), ErrorKind::kIo);
  EXPECT_EQ(kind_of_failure([&] { RunFolder{root_ / "file", inputs()}; }), ErrorKind::kIo);
}

TEST_F(RunFolderTest, GivesItsStudyBack) {
  run(root_ / "run");
  auto again = read_run_folder(root_ / "run");
  ASSERT_TRUE(again.study);
  EXPECT_EQ(freeze(again), inputs());
  EXPECT_EQ(kind_of_failure([&] { (void)read_run_folder(root_); }), ErrorKind::kIo);
}

std::string refusal_of_run(const fs::path& path) {
  try {
    (void)read_run_folder(path);
  } catch (const Error& error) {
    return error.diagnostics().at(0).id + ": " + error.diagnostics().at(0).message;
  }
  return "none";
}

// Another program froze what it understood, and found nothing wrong with it.
TEST_F(RunFolderTest, SaysThatARunIsOfAnotherVersion) {
  const auto publish = [&](const fs::path& path, std::string study) {
    auto as_it_was = inputs();
    as_it_was.study = std::move(study);
    RunFacts facts;
    facts.version = "0.0.9";
    facts.git = "abc1234";
    RunFolder{path, as_it_was}.publish(*reading().study, std::vector<TeamRecord>{}, facts);
  };
  const auto now = inputs().study;
  auto before = now;
  const std::string heading = "[teacher]\n";
  ASSERT_NE(before.find(heading), std::string::npos);
  before.insert(before.find(heading) + heading.size(), "conflict = \"largest-consistent\"\n");  // refused today
  publish(root_ / "refused", before);
  publish(root_ / "other", now + "# and a key with a default of long ago\n");
  EXPECT_EQ(refusal_of_run(root_ / "other"),
            "E0608: this run was made by kith 0.0.9 (abc1234), and the study that it froze means something else to "
            "this version");
  EXPECT_THAT(
      refusal_of_run(root_ / "refused"),
      ::testing::StartsWith("E0608: this run was made by kith 0.0.9 (abc1234), and this program cannot read its "
                            "study: "));
  // A file that was changed is something else.
  publish(root_ / "run", now);
  EXPECT_EQ(refusal_of_run(root_ / "run"), "none");
  auto changed = now;
  changed.replace(changed.find("max_periods = "), 14, "max_periods = 1");
  std::ofstream{root_ / "run" / "inputs" / "study.toml"} << changed;
  EXPECT_EQ(refusal_of_run(root_ / "run").substr(0, 5), "E0607");
}

}  // namespace
}  // namespace kith
