// What is too large is refused at once, with the limit and what to do: a test for every row of docs/limits.md that
// no layer has one for.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "large_map.hpp"
#include "run_kith.hpp"

namespace kith::testing {
namespace {

RunWith memory(const std::string& amount) { return {{{"KITH_MEMORY", amount}}, "", ""}; }

void expect_refusal(const Ran& ran, int code, const std::string& id, const std::string& message) {
  EXPECT_EQ(ran.code, code) << ran.err;
  EXPECT_THAT(ran.err, AllOf(HasSubstr("error"), HasSubstr(message)));
  EXPECT_THAT(ran.err, HasSubstr(id));
}

TEST(Limits, ACurriculumOfALargeMapSaysHowMuchMemoryItNeeds) {
  const Scratch scratch;
  std::ofstream{scratch / "map.toml"} << large_map(150);
  const std::vector<std::string> command{"lesson", scratch / "map.toml"};
  const auto ran = err_of(4, command, memory("100M"));
  EXPECT_THAT(ran, AllOf(HasSubstr("teaching the 22499 states of 'large' needs about 370 MB of memory; "),
                         HasSubstr("[family] starts = 1000")));
  auto with_json = command;
  with_json.emplace_back("--json");
  const auto document = Json::parse(run_kith(with_json, memory("100M")).out);
  EXPECT_EQ(document.at("errors").at(0).at("id"), "E1201");
}

TEST(Limits, PlanningIsRefusedBeforeItBegins) {
  const Scratch scratch;
  std::ofstream{scratch / "map.toml"} << large_map(150);
  for (const auto& command : std::vector<std::vector<std::string>>{
           {"find", scratch / "map.toml"}, {"inspect", scratch / "map.toml"}, {"ask", scratch / "map.toml", "why up?"}})
    expect_refusal(run_kith(command, memory("15M")), 4, "", "planning the 22499 states of 'large' needs about 16 MB");
}

TEST(Limits, MemoryIsSaidInOneForm) {
  expect_refusal(run_kith({"find", "item-delivery"}, memory("lots")), 2, "",
                 "KITH_MEMORY must be like 500M, 8G or 1T, not 'lots'");
}

TEST(Limits, AStudyHasAtMostTenMillionTeams) {
  const auto ran = run_kith({"study", "quick", "--dry-run", "--set", "replicates=5000001"});
  expect_refusal(ran, 3, "E0415", "the study has 10000002 teams");
}

TEST(Limits, ATableHasAnEnd) {
  const auto endless = run_kith({"analyze", "/dev/zero", "--model", "y ~ a"});
  expect_refusal(endless, 3, "E0509", "not UTF-8");
  for (const std::string command : {"inspect", "lesson", "find", "validate"})
    expect_refusal(run_kith({command, "/dev/zero"}), 3, "E0103", "at most 1048576 are read");
  EXPECT_EQ(run_kith({"fit", "/dev/zero"}).code, 3);
}

TEST(Limits, APoolOfTeamsFitsIntoMemory) {
  const auto ran = run_kith({"power", "quick", "--pool", "1000000", "--teams", "2"}, memory("60M"));
  expect_refusal(ran, 4, "", "keeping the outcomes of 2000000 teams and teaching on");
}

TEST(Limits, TheTeamsOfAReplicationFitIntoMemory) {
  const auto targets = std::string{KITH_SOURCE_DIR} + "/studies/paper-targets.toml";
  const auto replication = run_kith({"power", "paper", "--findings", targets, "--studies", "100000"}, memory("500M"));
  expect_refusal(replication, 4, "", "teams and teaching on");
}

// Threads of servers and of containers can have little: a report teaches three teams again on the stack that it is
// given.
TEST(Limits, OfTheStackAreKept) {
  const Scratch scratch;
  const auto folder = scratch / "run";
  ASSERT_EQ(run_kith({"study", "quick", "-o", folder, "-q"}).code, 0);
  RunWith small;
  small.prepare = [] {
    const rlimit stack{128 * 1024, 128 * 1024};
    setrlimit(RLIMIT_STACK, &stack);
  };
  expect_code(0, {"report", folder, "--json"}, small);
  EXPECT_EQ(run_kith({"analyze", folder, "--json"}, small).code, 0);
}

TEST(Limits, OfNumbersOnTheCommandLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{"study", "quick", "-o", "x", "-j", "1000000"}, "--threads must be an integer from 1 to 1024"},
      {{"study", "quick", "-o", "x", "--shard", "1/1000001"}, "--shard must be I/N"},
      {{"power", "quick", "--pool", "1000001"}, "--pool must be an integer from 4 to 1000000"},
      {{"power", "quick", "--draws", "1000001"}, "--draws must be an integer from 10 to 1000000"},
      {{"power", "quick", "--studies", "100001"}, "--studies must be an integer from 2 to 100000"},
      {{"fit", "x", "--types", "7"}, "--types must be an integer from 1 to 6"},
      {{"fit", "x", "--replicates", "1001"}, "--replicates must be an integer from 1 to 1000"},
      {{"teach", "item-delivery", "--seed", "9999999999999999999"},
       "--seed must be an integer from 0 to 9223372036854775807"},
      {{"teach", "item-delivery", "--group", "nnp"}, "only N, P; did you mean --group NNP?"},
      {{"teach", "item-delivery", "--group", std::string(31, 'N')}, "a group has at most 30 members"}};
  for (const auto& [arguments, message] : refused) expect_refusal(run_kith(arguments), 2, "", message);
}

TEST(Limits, OfNumbersInAStudy) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"teacher.particles=1000001", "E0110"},
      {"learner.N.particles=1000001", "E0110"},
      {"teacher.counterfactuals=100001", "E0110"},
      {"stop.max_periods=100001", "E0110"},
      {"stop.consecutive_correct=1001", "E0110"},
      {"stop.duplicate_sets=1001", "E0110"},
      {"replicates=10000001", "E0110"},
      {"seed=-1", "E0110"},
      {"title=" + std::string(40, '[') + std::string(40, ']'), "E0104"},
      {"design.compositions=[\"" + std::string(31, 'N') + "\"]", "E0404"}};
  for (const auto& [setting, id] : refused)
    expect_refusal(run_kith({"study", "quick", "--dry-run", "--set", setting}), 3, id, "");
}

}  // namespace
}  // namespace kith::testing
