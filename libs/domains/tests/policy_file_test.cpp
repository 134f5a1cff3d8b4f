#include "kith/domains/policy_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "kith/domains/domain_file.hpp"
#include "kith/domains/variation.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;

const Domain& ice() {
  static const Domain kDomain = load_domain("icy-crossing");
  return kDomain;
}

const std::string kCorridor = R"(schema = "kith.domain/1"
id = "corridor"
[mdp]
actions = ["on", "back"]
[model]
format = "csv"
states = "states.csv"
transitions = "transitions.csv"
[[feature]]
name = "mud"
[[feature]]
name = "step"
[reward]   # of nobody
weights = { mud = -2, step = -1 }
[prior]
halfspaces = [ { step = -1 } ]
)";
// Four states in a row; the last is the end. "back" in state 0 stays there.
const DomainFiles kTables{
    {},
    {{"states.csv", "state,terminal\n0,false\n1,false\n2,false\n3,true\n"},
     {"transitions.csv",
      "state,action,next,mud,step\n0,on,1,0,1\n0,back,0,0,1\n1,on,2,1,1\n1,back,0,0,1\n2,on,3,0,1\n2,back,1,0,1\n"}}};

DomainReading corridor(const std::string& text) { return parse_domain(text, "corridor", {}, kTables); }

Domain corridor() { return *corridor(kCorridor).domain; }

std::string error_of(const PolicyReading& reading) {
  EXPECT_FALSE(reading.policy);
  if (reading.diagnostics.empty()) return "";
  const auto& first = reading.diagnostics.front();
  return first.id + " " + std::to_string(first.line) + ":" + std::to_string(first.column) + " " + first.message;
}

TEST(PolicyFile, ReadsATableWithARowPerState) {
  const Domain domain = corridor();
  const auto reading = parse_policy("state,action\n0,on\n1,on\n2,back\n3,on\n", "policy.csv", domain);
  ASSERT_TRUE(reading.policy) << error_of(reading);
  EXPECT_EQ(reading.policy->is_seen.front(), (std::vector<bool>{true, true, true}));
  // State 0 has one choice, as "back" changes nothing there.
  EXPECT_EQ(reading.policy->probability.front(), (std::vector<double>{1, 1, 0, 0, 1}));
}

TEST(PolicyFile, CountsObservations) {
  const auto reading =
      parse_policy("path,step,state,action\n1,1,1,on\n1,2,2,on\n2,1,1,back\n2,2,0,on\n3,1,1,on\n3,2,2,on\n4,1,1,0\n",
                   "paths.csv", corridor());
  ASSERT_TRUE(reading.policy) << error_of(reading);
  EXPECT_EQ(reading.policy->probability.front(), (std::vector<double>{1, 0.75, 0.25, 1, 0}));
}

TEST(PolicyFile, ReadsProbabilities) {
  const auto chances =
      parse_policy("state,action,probability\n1,on,0.25\n1,back,0.75\n2,0,1\n", "agent.csv", corridor());
  ASSERT_TRUE(chances.policy) << error_of(chances);
  EXPECT_EQ(chances.policy->probability.front(), (std::vector<double>{0, 0.25, 0.75, 1, 0}));
  EXPECT_FALSE(chances.policy->is_seen.front().front());
}

TEST(PolicyFile, FindsStatesOfSeveralWorldsByKeyAndByName) {
  const auto start = ice().initial_state(MdpIndex{1});
  const auto world = ice().world_name(MdpIndex{1});
  const auto action = ice().action_names().at(ice().mdp(MdpIndex{1}).choices(start).front().action.value());
  for (const auto& state : {ice().state_key(MdpIndex{1}, start), ice().state_name(MdpIndex{1}, start)}) {
    const auto reading =
        parse_policy("world,state,action\n" + world + ",\"" + state + "\"," + action + "\n", "p.csv", ice());
    ASSERT_TRUE(reading.policy) << error_of(reading);
    EXPECT_TRUE(reading.policy->is_seen[1][start.value()]);
    EXPECT_EQ(std::accumulate(reading.policy->is_seen[0].begin(), reading.policy->is_seen[0].end(), 0), 0);
  }
}

TEST(PolicyFile, SaysWhereAnErrorIs) {
  const Domain domain = corridor();
  EXPECT_THAT(error_of(parse_policy("state,action\n0,on\n9,on\n", "p", domain)), HasSubstr("E0282 3:1 "));
  EXPECT_THAT(error_of(parse_policy("state,action\n0,onn\n", "p", domain)), HasSubstr("E0283 2:3 "));
  EXPECT_THAT(error_of(parse_policy("world,state,action\n7,0,on\n", "p", domain)), HasSubstr("E0281 2:1 "));
  EXPECT_THAT(error_of(parse_policy("state,action,probability\n1,on,1.5\n", "p", domain)), HasSubstr("E0284 2:6 "));
  EXPECT_THAT(error_of(parse_policy("state,action,probability\n1,on,0.5\n1,back,0.4\n", "p", domain)),
              HasSubstr("sum to 0.9"));
  EXPECT_THAT(error_of(parse_policy("state,action\n", "p", domain)), HasSubstr("E0285"));
  EXPECT_THAT(error_of(parse_policy("state\n0\n", "p", domain)), HasSubstr("E05"));
  const auto json = parse_policy("[0, 1]", "agent.json", domain);
  EXPECT_THAT(error_of(json), HasSubstr("E0286 1:1 "));
  EXPECT_THAT(json.diagnostics.front().hint, HasSubstr("python -m kith.convert agent.json"));
}

TEST(InferredWeights, AreWrittenInPlaceOfTheOldOnesAndRead) {
  const auto text = with_inferred_weights(kCorridor, {"mud", "step"}, {-0.25, -1}, {0.75, 0.125, 0.5},
                                          {{MdpIndex{0}, StateIndex{1}}});
  EXPECT_THAT(text, ::testing::Not(HasSubstr("of nobody")));
  const auto reading = corridor(text);
  ASSERT_TRUE(reading.domain) << reading.diagnostics.front().message << text;
  EXPECT_EQ(reading.domain->weights().raw, (std::vector<double>{-0.25, -1}));
  EXPECT_EQ(*reading.domain->inferred(), (InferredWeights{0.75, 0.125, 0.5, 1}));
  EXPECT_EQ(reading.domain->starts(MdpIndex{0}), (std::vector<StateIndex>{StateIndex{0}, StateIndex{2}}));
  EXPECT_EQ(reading.domain->prior().size(), 1u);
  // Once more: the tables are replaced.
  EXPECT_EQ(
      with_inferred_weights(text, {"mud", "step"}, {-0.25, -1}, {0.75, 0.125, 0.5}, {{MdpIndex{0}, StateIndex{1}}}),
      text);
}

TEST(InferredWeights, ReplaceARewardHoweverItIsWritten) {
  const std::string table = "[reward]   # of nobody\nweights = { mud = -2, step = -1 }\n";
  const auto at = kCorridor.find(table);
  const auto with = [&](const std::string& other) {
    auto text = kCorridor;
    return text.replace(at, table.size(), other);
  };
  const auto rest = with("");
  for (const auto& old :
       {with("[\"reward\"]\n\"weights\" = { mud = -9, step = -1 }\n"), with(" [ 'reward' ]\nweights.mud = -9\n"),
        with("[reward.weights]\nmud = -9\nstep = -1\n"), "reward = { weights = {\nmud = -9, step = -1 } }\n" + rest,
        "reward.weights = { mud = -9, step = -1 }\r\n" + rest, "'reward'.weights.mud = -9\n" + rest, rest}) {
    const auto text = with_inferred_weights(old, {"mud", "step"}, {-0.25, -1}, {0.75, 0.125, 0.5}, {});
    const auto reading = corridor(text);
    ASSERT_TRUE(reading.domain) << reading.diagnostics.front().message << text;
    EXPECT_EQ(reading.domain->weights().raw, (std::vector<double>{-0.25, -1})) << text;
    EXPECT_EQ(reading.domain->prior().size(), 1u) << text;
  }
}

TEST(InferredWeights, KnowTheStatesThatTheyDoNotExplain) {
  const InferredWeights inferred{0.75, 0.125, 0.5, 1, {{MdpIndex{0}, StateIndex{1}}, {MdpIndex{0}, StateIndex{2}}}};
  const auto text =
      with_inferred_weights(kCorridor, {"mud", "step"}, {-0.25, -1}, inferred, {{MdpIndex{0}, StateIndex{1}}});
  const auto reading = corridor(text);
  ASSERT_TRUE(reading.domain) << reading.diagnostics.front().message << text;
  EXPECT_EQ(*reading.domain->inferred(), inferred);
  const auto wrong = [](const std::string& states) {
    return corridor(kCorridor + "[inferred]\nshare = 0.5\nnot_explained = [" + states + "]\n").diagnostics.front().id;
  };
  EXPECT_EQ(wrong("[0, 3]"), "E0318");
  EXPECT_EQ(wrong("[1, 0]"), "E0318");
  EXPECT_EQ(wrong("0"), "E0108");
}

TEST(InferredWeights, OfAnotherModelAreRefused) {
  const auto with = [](const std::string& left_out) {
    const auto reading = corridor(kCorridor + "[inferred]\nshare = 0.5\nleft_out = [" + left_out + "]\n");
    return reading.domain ? std::string{} : reading.diagnostics.front().id;
  };
  EXPECT_EQ(with("[0, 1], [0, 2]"), "");
  EXPECT_EQ(with("[0, 1, 1]"), "E0318");
  EXPECT_EQ(with("[0, 3]"), "E0318");
  EXPECT_EQ(with("[1, 0]"), "E0318");
  EXPECT_EQ(with("[0, 0, 1, 2]"), "E0319");
  EXPECT_EQ(with("0"), "E0108");
}

TEST(UnweighedDomain, NeedsNoReward) {
  const auto text = kCorridor.substr(0, kCorridor.find("[reward]")) + "[prior]\nhalfspaces = [ { step = -1 } ]\n";
  const auto reading = parse_unweighed_domain(text, "corridor", kTables);
  ASSERT_TRUE(reading.domain) << reading.diagnostics.front().message;
  EXPECT_TRUE(reading.domain->weights().raw.empty());
  EXPECT_EQ(reading.domain->prior().size(), 1u);
}

}  // namespace
}  // namespace kith
