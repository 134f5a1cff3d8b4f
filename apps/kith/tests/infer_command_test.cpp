// kith infer: weights for a robot whose reward nobody wrote down.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

const std::string kDomain = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
const std::string kPolicy = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing_policy.csv";

TEST(InferCommand, WritesADomainThatEverythingElseTeaches) {
  const Scratch scratch;
  const auto file = scratch / "explained.toml";
  const auto found = out_of({"infer", kDomain, "--policy", kPolicy, "-o", file});
  EXPECT_THAT(found, AllOf(HasSubstr("explain 97 % of what the robot does"),
                           HasSubstr("in the snow at d3: it does left"), HasSubstr("would have to tell apart")));
  EXPECT_THAT(run_kith({"validate", file}).out, HasSubstr("39 start states"));
  for (const auto& command : {std::vector<std::string>{"inspect", file},
                              {"lesson", file},
                              {"teach", file, "--group", "NP", "--strategy", "joint"}}) {
    EXPECT_THAT(out_of(command), HasSubstr("explain 97 % of what the robot does"));
  }
  const auto again = run_kith({"infer", kDomain, "--policy", kPolicy, "-o", file});
  EXPECT_EQ(again.code, 2) << "the file is there";
  EXPECT_EQ(run_kith({"infer", file, "--policy", kPolicy, "-o", file, "--yes"}).code, 0) << "weights are replaced";
}

TEST(InferCommand, TakesADomainWithoutARewardAsValidateSays) {
  std::ifstream file{std::string{KITH_SOURCE_DIR} + "/domains/item_delivery.toml"};
  std::string text{std::istreambuf_iterator<char>{file}, {}};
  const auto at = text.find("[reward]");
  ASSERT_NE(at, std::string::npos);
  const auto misspelt = err_of(3, {"validate", "-"}, {.input = std::string{text}.insert(at + 7, "s")});
  EXPECT_THAT(misspelt, AllOf(HasSubstr("did you mean 'reward'?"), Not(HasSubstr("E0109"))));
  text.erase(at, text.find('[', at + 1) - at);
  EXPECT_THAT(out_of({"validate", "-"}, {.input = text}), HasSubstr("only for kith infer"));
  EXPECT_EQ(run_kith({"inspect", "-"}, {.input = text}).code, 3);
}

TEST(InferCommand, SaysAllAsJson) {
  const auto document = json_of({"infer", kDomain, "--policy", kPolicy});
  EXPECT_EQ(document.at("schema"), "kith.infer/1");
  EXPECT_NEAR(document.at("share").get<double>(), 44.0 / 45.0, 1e-12);
  EXPECT_EQ(document.at("unexplained").size(), 1u);
  EXPECT_EQ(document.at("left_out").size(), 6u);
  EXPECT_FALSE(document.at("optimal").get<bool>());
}

TEST(InferCommand, RefusesWhatCannotBeExplainedOrRead) {
  const Scratch scratch;
  const auto said = [&](const std::string& policy) {
    std::ofstream{scratch / "policy.csv"} << policy;
    return run_kith({"infer", kDomain, "--policy", scratch / "policy.csv"});
  };
  std::string contrary = "world,state,action\n";
  for (const char* state : {"a1", "b1", "c1", "d1", "e1", "b2", "d2", "a3", "b3"})
    contrary += std::string{"0,"} + state + ",left\n";
  const auto refused = said(contrary);
  EXPECT_EQ(refused.code, 4);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("E0341"), HasSubstr("acts at random")));
  const auto wrong = said("world,state,action\n0,a1,up\n0,z9,up\n");
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("policy.csv:3:3: error[E0282]: there is no state 'z9'"));
  EXPECT_EQ(run_kith({"infer", kDomain, "--policy", scratch / "none.csv"}).code, 5);
}

}  // namespace
}  // namespace kith::testing
