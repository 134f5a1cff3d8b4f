// What becomes of a study that is stopped, and of its folder; libs/runs/tests/every_write_test.cpp has the rest.
#include <gtest/gtest.h>
#include <sys/prctl.h>

#include <csignal>

#include "small_study.hpp"

namespace kith::testing {
namespace {

using ::testing::IsEmpty;

namespace fs = std::filesystem;

constexpr int kTeams = 16;

// A study that would take minutes is stopped while it runs; a little later it goes on.
TEST(Survival, OfSignalsSavesWhatIsFinishedAndSaysHowToGoOn) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Scratch scratch;
    std::ofstream{scratch / "in"} << "";
    const auto child =
        start_kith({"study", "quick", "-o", scratch / "run", "--set", "replicates=100000", "--progress", "json"}, {},
                   scratch / "in", scratch / "out", scratch / "err");
    for (int i = 0; i < 3000 && text_of(scratch / "err").find("\"done\"") == std::string::npos; ++i) usleep(10'000);
    kill(child, signal);
    EXPECT_EQ(exit_code_of(child), 128 + signal);
    EXPECT_THAT(text_of(scratch / "err"),
                AllOf(HasSubstr("interrupted after"), HasSubstr("are saved in"), HasSubstr("study quick -o")));
    EXPECT_THAT(text_of(scratch / "out"), IsEmpty());
    EXPECT_FALSE(fs::exists(scratch / "run/tables"));
    const auto status = json_of({"status", scratch / "run"});
    EXPECT_EQ(status.at("state"), "interrupted");
    EXPECT_GT(status.at("done"), 0);
    EXPECT_EQ(status.at("total"), 200'000);
    EXPECT_EQ(status.at("done").get<int>() + status.at("left").get<int>(), 200'000);
  }
}

TEST(Survival, OfASignalIsAnErrorDocumentInJson) {
  const Scratch scratch;
  std::ofstream{scratch / "in"} << "";
  const auto child = start_kith(
      {"study", "quick", "-o", scratch / "run", "--set", "replicates=100000", "--progress", "json", "--json"}, {},
      scratch / "in", scratch / "out", scratch / "err");
  for (int i = 0; i < 3000 && text_of(scratch / "err").find("\"done\"") == std::string::npos; ++i) usleep(10'000);
  EXPECT_EQ(json_of({"status", scratch / "run"}).at("state"), "running");
  const auto second = err_of(8, {"study", "quick", "-o", scratch / "run", "--set", "replicates=100000"});
  EXPECT_THAT(second, HasSubstr("another process is writing to"));
  kill(child, SIGINT);
  EXPECT_EQ(exit_code_of(child), 128 + SIGINT);
  const auto document = Json::parse(text_of(scratch / "out"));
  EXPECT_EQ(document.at("schema"), "kith.error/1");
  EXPECT_EQ(document.at("errors").at(0).at("id"), "interrupted");
  EXPECT_THAT(document.at("errors").at(0).at("hint"), HasSubstr("study quick"));
}

TEST(Survival, OfAReadOnlyFolderIsAClearMessage) {
  const Scratch scratch;
  const auto folder = scratch / "run";
  ASSERT_EQ(run_kith(small_study(folder)).code, 0);
  for (const auto* place : {"run/tables", "run/inputs", "run"}) fs::permissions(scratch / place, fs::perms(0555));
  fs::permissions(scratch / "run/study.sqlite", fs::perms(0444));
  std::ofstream{scratch / "in"} << "";
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && prctl(PR_CAPBSET_DROP, 1 /* CAP_DAC_OVERRIDE */) != 0) _exit(77);
    const auto grandchild = start_kith(small_study(folder), {}, scratch / "in", scratch / "out", scratch / "err");
    _exit(exit_code_of(grandchild));
  }
  const int code = exit_code_of(child);
  EXPECT_EQ(run_kith({"status", folder}).code, 0);
  EXPECT_EQ(run_kith({"verify", folder}).code, 0);
  for (const auto* place : {"run", "run/tables", "run/inputs"}) fs::permissions(scratch / place, fs::perms(0755));
  if (code == 77) GTEST_SKIP() << "permissions do not hold for this user";
  EXPECT_EQ(code, 5);
  EXPECT_THAT(text_of(scratch / "err"), AllOf(HasSubstr(folder), HasSubstr("ermission denied")));
  EXPECT_EQ(tables_in(folder), expected());
}

TEST(Survival, OfADamagedJournalNamesItAndTheWayOut) {
  const Scratch scratch;
  const auto folder = scratch / "run";
  ASSERT_EQ(run_kith(small_study(folder)).code, 0);
  std::ofstream{folder + "/study.sqlite"} << "this is no database";
  EXPECT_THAT(err_of(5, small_study(folder)), AllOf(HasSubstr("study.sqlite .recover"), HasSubstr("--resume never")));
  EXPECT_EQ(tables_in(folder), expected());
  auto anew = small_study(folder);
  anew.insert(anew.end(), {"--resume", "never"});
  EXPECT_EQ(run_kith(anew).code, 0);
  EXPECT_EQ(tables_in(folder), expected());
}

TEST(Resume, IsRefusedWithNothingToResume) {
  const Scratch scratch;
  const auto ran = err_of(2, {"study", "quick", "-o", scratch / "run", "--resume", "require"});
  EXPECT_THAT(ran, HasSubstr("nothing to resume"));
  EXPECT_FALSE(fs::exists(scratch / "run"));
}

// Abilities that hardly anybody has: some people cannot be drawn.
std::vector<std::string> failing_study(const std::string& folder) {
  return {"study", "quick",
          "-o",    folder,
          "--set", "learner.N.ability={mean=0.7,sd=0.01,min=0.7334}",
          "--set", "replicates=100",
          "--set", "design.strategies=[\"common\"]",
          "--set", "record.level=\"team\""};
}

TEST(Failures, StopTheRunWithTheAddressOfTheTeam) {
  const Scratch scratch;
  const auto ran = err_of(4, failing_study(scratch / "run"));
  EXPECT_THAT(ran, ::testing::ContainsRegex("team [0-9]+ \\(common, NP, replicate [0-9]+\\) failed: "));
  EXPECT_FALSE(fs::exists(scratch / "run/tables"));
}

TEST(Failures, AreNamedAtTheEndIfTheRunIsToGoOn) {
  const Scratch scratch;
  auto arguments = failing_study(scratch / "run");
  arguments.insert(arguments.end(), {"--keep-going", "--json"});
  const auto ran = run_kith(arguments);
  EXPECT_EQ(ran.code, 6) << ran.err;
  const auto document = Json::parse(ran.out);
  const auto failed = document.at("failed").size();
  EXPECT_GT(failed, 0u);
  EXPECT_EQ(document.at("teams").get<std::size_t>() + failed, 100u);
  EXPECT_THAT(document.at("failed").at(0).get<std::string>(), HasSubstr("(common, NP, replicate "));
  const auto status = json_of({"status", scratch / "run"});
  EXPECT_EQ(status.at("state"), "failed");
  EXPECT_EQ(status.at("failed"), failed);
  EXPECT_EQ(status.at("failures").size(), failed);
}

TEST(StatusCommand, KnowsAFinishedRun) {
  const Scratch scratch;
  ASSERT_EQ(run_kith(small_study(scratch / "run")).code, 0);
  EXPECT_THAT(run_kith({"status", scratch / "run"}).out, HasSubstr("finished: 16 of 16 teams done"));
  EXPECT_EQ(run_kith({"status", scratch / "nowhere"}).code, 5);
  EXPECT_EQ(run_kith({"status", scratch / ""}).code, 5);
}

TEST(VerifyCommand, FindsTheSameBytesOrSaysWhereTheyDiffer) {
  const Scratch scratch;
  ASSERT_EQ(run_kith(small_study(scratch / "run")).code, 0);
  EXPECT_THAT(run_kith({"verify", scratch / "run"}).out,
              HasSubstr("reran " + std::to_string(kTeams) + " of " + std::to_string(kTeams) + " teams"));
  std::ofstream{scratch / "run/tables/teams.csv", std::ios::app} << "x\n";
  EXPECT_THAT(err_of(7, {"verify", scratch / "run"}), AllOf(HasSubstr("tables/teams.csv"), HasSubstr("error[E0641]")));
  EXPECT_EQ(run_kith({"verify", scratch / "run", "--sample", "2"}).code, 2);
}

TEST(MergeCommand, GivesTheBytesOfTheWholeStudy) {
  const Scratch scratch;
  std::vector<std::string> merge{"merge", "-o", scratch / "all"};
  for (const std::string shard : {"3", "1", "2"}) {
    auto arguments = small_study(scratch / shard);
    arguments.insert(arguments.end(), {"--shard", shard + "/3"});
    expect_code(0, arguments);
    EXPECT_FALSE(fs::exists(fs::path{scratch / shard} / "tables"));
    merge.push_back(scratch / shard);
  }
  EXPECT_THAT(out_of(merge), HasSubstr("all groups"));
  EXPECT_EQ(tables_in(scratch / "all"), expected());
  EXPECT_EQ(run_kith({"verify", scratch / "all"}).code, 0);
  merge.pop_back();
  EXPECT_THAT(err_of(4, merge), HasSubstr("error[E0635]"));
  EXPECT_EQ(run_kith({"merge", scratch / "1", "-o", scratch / "1"}).code, 2);
  EXPECT_EQ(run_kith({"study", "quick", "-o", scratch / "x", "--shard", "4/3"}).code, 2);
}

// Under mpirun, as root if need be.
int run_on_ranks(const std::string& ranks, const std::vector<std::string>& arguments, const Scratch& scratch) {
  const pid_t child = fork();
  if (child != 0) return exit_code_of(child);
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  std::vector<std::string> words{KITH_MPIRUN, "-n", ranks, "--oversubscribe", KITH_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int log = open((scratch / "mpi.log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(KITH_MPIRUN, argv.data());
  _exit(127);
}

TEST(MpiRanks, GiveTheSameBytesInAnyNumber) {
  if (std::string{KITH_MPIRUN}.empty()) GTEST_SKIP() << "kith was built without MPI";
  if (!fs::exists(KITH_MPIRUN)) GTEST_SKIP() << KITH_MPIRUN << " is not there";
  const Scratch scratch;
  for (const std::string ranks : {"1", "2", "4"}) {
    EXPECT_EQ(run_on_ranks(ranks, small_study(scratch / ranks), scratch), 0) << text_of(scratch / "mpi.log");
    EXPECT_EQ(tables_in(scratch / ranks), expected()) << ranks;
    EXPECT_FALSE(fs::exists(fs::path{scratch / ranks} / "study.rank-1.sqlite"));
  }
}

}  // namespace
}  // namespace kith::testing
