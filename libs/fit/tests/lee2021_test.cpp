#include "kith/fit/lee2021.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "human_data.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/judgement.hpp"
#include "scratch_folder.hpp"

namespace kith {
namespace {

std::map<std::string, ActionsJudge> judges_of(const std::vector<RecordedWorld>& worlds) {
  std::map<std::string, ActionsJudge> judges;
  for (const auto& world : worlds) judges.try_emplace(world.id, world.domain, MdpIndex{0});
  return judges;
}

TEST(Lee2021, StoredActionListsAreOptimalInAllWorlds) {
  KITH_REQUIRE_HUMAN_DATA(path, "lee2021_test_mdps.jsonl");
  const auto worlds = read_lee2021_worlds(*path);
  ASSERT_EQ(worlds.size(), 53u);
  for (const auto& world : worlds) {
    const auto judgement = judge_actions(world.domain, MdpIndex{0}, world.optimal_actions);
    EXPECT_TRUE(judgement.optimal) << world.id;
    EXPECT_EQ(judgement.ignored, 0u) << world.id;
    EXPECT_NEAR(judgement.earned, world.optimal_return, 1e-9) << world.id;
  }
}

TEST(Lee2021, JudgingByReturnAgreesWithEveryRecordedVerdict) {
  KITH_REQUIRE_HUMAN_DATA(mdps, "lee2021_test_mdps.jsonl");
  KITH_REQUIRE_HUMAN_DATA(path, "lee2021_test_responses.csv");
  const auto worlds = read_lee2021_worlds(*mdps);
  const auto judges = judges_of(worlds);
  const auto responses = read_lee2021_responses(*path);
  ASSERT_EQ(responses.size(), 2916u);
  std::size_t agreed = 0;
  std::size_t legal = 0;
  std::array<double, 3> optimal{};
  std::array<double, 3> all{};
  for (const auto& response : responses) {
    const auto judgement = judges.at(response.world).judge(StateIndex{0}, response.moves);
    agreed += judgement.optimal == response.optimal ? 1u : 0u;
    legal += judgement.outcome == ActionsOutcome::kFinished && judgement.ignored == 0 ? 1u : 0u;
    EXPECT_EQ(judgement.regret == 0.0, judgement.optimal) << path->string() << ":" << response.line;
    optimal.at(response.difficulty) += judgement.optimal ? 1.0 : 0.0;
    all.at(response.difficulty) += 1.0;
  }
  EXPECT_EQ(agreed, 2916u);
  EXPECT_EQ(legal, 2916u);  // everybody was led to an end, and nobody beyond it
  // As published, to three digits.
  EXPECT_EQ(std::round(1000 * optimal[0] / all[0]), 892);
  EXPECT_EQ(std::round(1000 * optimal[1] / all[1]), 676);
  EXPECT_EQ(std::round(1000 * optimal[2] / all[2]), 360);
}

TEST(Lee2021, OptimalAnswersWithOtherActionsAreTies) {
  KITH_REQUIRE_HUMAN_DATA(mdps, "lee2021_test_mdps.jsonl");
  KITH_REQUIRE_HUMAN_DATA(path, "lee2021_test_responses.csv");
  const auto worlds = read_lee2021_worlds(*mdps);
  const auto judges = judges_of(worlds);
  std::map<std::string, std::vector<std::string>> stored;
  for (const auto& world : worlds) stored[world.id] = world.optimal_actions;
  std::size_t equal = 0;
  std::size_t ties = 0;
  for (const auto& response : read_lee2021_responses(*path)) {
    const bool same = response.moves == stored.at(response.world);
    equal += same ? 1u : 0u;
    ties += !same && judges.at(response.world).judge(StateIndex{0}, response.moves).optimal ? 1u : 0u;
  }
  EXPECT_EQ(equal, 1711u);
  EXPECT_EQ(ties, 163u);
}

// A world of our own in the same layout.
constexpr const char* kWorld =
    R"({"mdp_id": "two_goal_900", "domain": "two_goal", "mdp": {"agent": {"x": 1, "y": 1}, "goals": [{"x": 3, "y": 1},)"
    R"( {"x": 1, "y": 3}], "walls": [{"x": 2, "y": 1}], "width": 3, "height": 3, "opt_actions": ["up", "up"],)"
    R"( "opt_traj_reward": 0.45333333333333337, "test_difficulty": "low"}})";

std::vector<std::string> faults_of(const std::string& line) {
  const testing::ScratchFolder folder;
  const auto path = folder.write("worlds.jsonl", line + "\n");
  try {
    static_cast<void>(read_lee2021_worlds(path));
  } catch (const Error& error) {
    std::vector<std::string> ids;
    for (const auto& diagnostic : error.diagnostics())
      ids.push_back(diagnostic.id + ":" + std::to_string(diagnostic.line));
    return ids;
  }
  return {};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Lee2021, ReadsAWorldIntoADomainFile) {
  const testing::ScratchFolder folder;
  const auto worlds = read_lee2021_worlds(folder.write("worlds.jsonl", std::string{"\n"} + kWorld + "\n"));
  ASSERT_EQ(worlds.size(), 1u);
  EXPECT_EQ(worlds[0].domain.weights().raw, (std::vector<double>{7.25, 10.5, -1}));
  EXPECT_TRUE(worlds[0].domain.map()->content(MdpIndex{0}, {2, 1}).wall);
  EXPECT_TRUE(judge_actions(worlds[0].domain, MdpIndex{0}, worlds[0].optimal_actions).optimal);
}

TEST(Lee2021, NamesFileLineAndFaultOfABadWorld) {
  EXPECT_EQ(faults_of("{"), std::vector<std::string>{"E0701:1"});
  EXPECT_EQ(faults_of("[1, 2]"), std::vector<std::string>{"E0701:1"});
  const std::vector<std::string> bad{"E0702:1"};
  EXPECT_EQ(faults_of("{}"), bad);
  EXPECT_EQ(faults_of(replaced(kWorld, "\"two_goal\"", "\"chess\"")), bad);
  EXPECT_EQ(faults_of(replaced(kWorld, "\"width\": 3", "\"width\": \"3\"")), bad);
  EXPECT_EQ(faults_of(replaced(kWorld, "\"width\": 3", "\"width\": 3000")), bad);
  EXPECT_EQ(faults_of(replaced(kWorld, "\"width\": 3", "\"width\": 4294967299")), bad);  // 2^32 + 3
  EXPECT_EQ(faults_of(replaced(kWorld, "\"walls\": [{\"x\": 2", "\"walls\": [{\"x\": 4")), bad);
  EXPECT_EQ(faults_of(replaced(kWorld, "[\"up\", \"up\"]", "[1]")), bad);
  EXPECT_EQ(faults_of(replaced(kWorld, "\"opt_traj_reward\": 0.45333333333333337,", "")), bad);
}

TEST(Lee2021, NamesRowAndColumnOfABadResponse) {
  const testing::ScratchFolder folder;
  const auto ids = [&](const std::string& text) {
    std::string result;
    try {
      static_cast<void>(read_lee2021_responses(folder.write("responses.csv", text)));
    } catch (const Error& error) {
      for (const auto& diagnostic : error.diagnostics())
        result += diagnostic.id + ":" + std::to_string(diagnostic.line) + " ";
    }
    return result;
  };
  const std::string header = "participant,domain,mdp_id,test_difficulty,optimal_response,moves,extra\n";
  EXPECT_EQ(ids(header + "1,two_goal,two_goal_000,2,1,up up,x\n"), "");
  EXPECT_EQ(ids(header + "1,two_goal,two_goal_000,high,1,up up,x\n"), "E0506:2 ");
  EXPECT_EQ(ids("participant,domain,mdp_id,test_difficulty,moves\n"), "E0502:1 ");
  EXPECT_EQ(ids(""), "E0501:1 ");
}

}  // namespace
}  // namespace kith
