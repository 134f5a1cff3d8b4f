// What conditions mean, seen from the features that fire on given transitions.
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "domain_texts.hpp"
#include "domains_under_test.hpp"

namespace kith {
namespace {

// A corridor: start and parcel, grass, charger, two goals of which one is
// optional, and somewhere else to bring the parcel. Feature k is conditions[k].
Domain corridor(const std::vector<std::string>& conditions, const std::string& extra = "") {
  std::string text = R"(schema = "kith.domain/1"
id = "corridor"
[mdp]
actions = ["up", "down", "left", "right", "pickup", "dropoff", "exit"]
[map]
rows = ["DSgcA",
        "#...B"]
[map.legend]
"." = "floor"
"#" = "wall"
"S" = { start = true, item = "parcel" }
"D" = { destination = "parcel" }
"g" = { terrain = "grass" }
"c" = { station = "charger" }
"A" = { goal = "a" }
"B" = { goal = "b", optional = true }
)";
  std::string weights;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const std::string name = std::string{"f"}.append(std::to_string(k));
    text += "[[feature]]\nname = \"" + name + "\"\nwhen = \"" + conditions[k] + "\"\n" + extra;
    weights += name + " = 0, ";
  }
  text += "[[feature]]\nname = \"step\"\nwhen = \"action\"\n[reward]\nweights = { " + weights + "step = -1 }\n";
  return sound_domain(text);
}

// Which features fire if the robot takes these actions from the start, per action ("-": none).
std::vector<std::string> fired(const Domain& domain, const std::vector<std::string>& actions,
                               MdpIndex m = MdpIndex{1}) {
  std::vector<std::string> all;
  StateIndex s = domain.initial_state(m);
  for (const std::string& action : actions) {
    const Choice* taken = nullptr;
    for (const Choice& choice : domain.mdp(m).choices(s)) {
      if (domain.action_names()[choice.action.value()] == action) taken = &choice;
    }
    if (taken == nullptr) return {"no action " + action};
    const Outcome& outcome = domain.mdp(m).outcomes(*taken).front();
    std::string names;
    for (std::size_t k = 0; k + 1 < domain.num_features(); ++k) {
      if (domain.mdp(m).features(outcome)[k] != 0.0) names += std::to_string(k);
    }
    all.push_back(names.empty() ? "-" : names);
    s = outcome.next;
  }
  return all;
}

using Fired = std::vector<std::string>;

TEST(Condition, LeaveAndEnterFireWhenThePositionChanges) {
  const Domain domain = corridor({"leave:grass", "enter:grass"});
  EXPECT_EQ(fired(domain, {"pickup", "right", "dropoff", "pickup", "left", "right", "down"}),
            (Fired{"-", "1", "-", "-", "0", "1", "0"}));
}

TEST(Condition, NamesWhatHasToBeThere) {
  const Domain domain = corridor({"enter:grass & !carrying:parcel", "leave:charger | deliver:parcel", "!goal", "exit"});
  using Things = std::vector<FeatureThing>;
  EXPECT_EQ(domain.feature_things(0), (Things{{"enter", "terrain", "grass"}}));
  EXPECT_EQ(domain.feature_things(1), (Things{{"leave", "station", "charger"}, {"deliver", "item", "parcel"}}));
  EXPECT_TRUE(domain.feature_things(2).empty());
  EXPECT_TRUE(domain.feature_things(3).empty());
}

TEST(Condition, AStationFiresOnceAndIsGone) {
  const Domain domain = corridor({"leave:charger", "enter:charger"});
  EXPECT_EQ(fired(domain, {"right", "right", "left", "right", "left"}), (Fired{"-", "1", "0", "-", "-"}));
}

TEST(Condition, CarryingIsWhatTheRobotDidBeforeTheAction) {
  const Domain domain = corridor({"carrying:parcel"});
  EXPECT_EQ(fired(domain, {"pickup", "right", "dropoff", "left"}), (Fired{"-", "0", "0", "-"}));
}

TEST(Condition, DeliverFiresOnTheDestinationOnly) {
  const Domain domain = corridor({"deliver:parcel"});
  EXPECT_EQ(fired(domain, {"pickup", "right", "dropoff"}), (Fired{"-", "-", "-"}));
  EXPECT_EQ(fired(domain, {"pickup", "left", "dropoff"}), (Fired{"-", "-", "0"}));
}

TEST(Condition, GoalsAreToldApartByName) {
  const Domain domain = corridor({"goal:a", "goal:b", "goal"});
  EXPECT_EQ(fired(domain, {"right", "right", "right"}), (Fired{"-", "-", "02"}));
  EXPECT_EQ(fired(domain, {"down", "right", "right", "right"}), (Fired{"-", "-", "-", "12"}));
  // Without the optional goal the cell is floor.
  EXPECT_EQ(fired(domain, {"down", "right", "right", "right", "up"}, MdpIndex{0}), (Fired{"-", "-", "-", "-", "02"}));
}

TEST(Condition, ExitAndNamedActions) {
  const Domain domain = corridor({"exit", "action:left", "action:pickup | action:dropoff", "action & !exit"});
  EXPECT_EQ(fired(domain, {"left", "right", "pickup", "dropoff", "exit"}), (Fired{"13", "3", "23", "23", "0"}));
}

TEST(Condition, ExitEndsTheEpisode) {
  const Domain domain = corridor({"exit"});
  const Choice& last = domain.mdp(MdpIndex{0}).choices(StateIndex{0}).back();
  EXPECT_EQ(domain.action_names()[last.action.value()], "exit");
  const StateIndex end = domain.mdp(MdpIndex{0}).outcomes(last).front().next;
  EXPECT_TRUE(domain.mdp(MdpIndex{0}).is_terminal(end));
  EXPECT_TRUE(domain.map()->state(MdpIndex{0}, end).exited);
}

TEST(Condition, NotBindsTighterThanAndThanOr) {
  // On "left" action:left is true and action:right false, and so on.
  const Domain domain = corridor({"action:left | action:right & exit", "(action:left | action:right) & exit",
                                  "!action:left | action:left & action:left", "!(action:left | action:left)",
                                  " ! ! action:left ", "action:left&!exit|exit&!action:left"});
  EXPECT_EQ(fired(domain, {"left", "right", "exit"}), (Fired{"0245", "23", "235"}));
}

// Each condition against the truth table of its own formula over three actions.
TEST(Condition, AgreesWithTruthTables) {
  const std::vector<std::string> atoms{"action:left", "action:right", "exit"};
  for (unsigned seed = 0; seed < 60; ++seed) {
    // A random formula in disjunctive form: which signed atoms each of two clauses has.
    std::string text;
    std::vector<bool> truth(3, false);
    for (unsigned clause = 0; clause < 2; ++clause) {
      const unsigned signs = (seed * 2654435761u >> (8 + 3 * clause)) & 7u;
      std::string joined;
      std::vector<bool> holds(3, true);
      for (unsigned a = 0; a < 3; ++a) {
        const bool plain = ((signs >> a) & 1u) != 0;
        joined += (a > 0 ? " & " : "") + std::string{plain ? "" : "!"} + atoms[a];
        for (unsigned taken = 0; taken < 3; ++taken) holds[taken] = holds[taken] && ((taken == a) == plain);
      }
      text += (clause > 0 ? " | (" : "(") + joined + ")";
      for (unsigned taken = 0; taken < 3; ++taken) truth[taken] = truth[taken] || holds[taken];
    }
    const Fired expected{truth[0] ? "0" : "-", truth[1] ? "0" : "-", truth[2] ? "0" : "-"};
    EXPECT_EQ(fired(corridor({text}), {"left", "right", "exit"}), expected) << text;
  }
}

TEST(Features, OfOneExclusiveGroupOnlyTheFirstFires) {
  const Domain domain = corridor({"action:right", "enter:grass", "action"}, "exclusive = \"one\"\n");
  EXPECT_EQ(fired(domain, {"right", "left", "pickup"}), (Fired{"0", "2", "2"}));
}

TEST(Actions, ComeInCanonicalOrderHoweverListed) {
  std::string text = kColoredTiles;
  text.replace(text.find("[map]"), 5, "[mdp]\nactions = [\"exit\", \"right\", \"up\", \"left\", \"down\"]\n[map]");
  text.replace(text.find("when = \"action\""), 15, "when = \"action & !(enter:a & exit)\"");
  EXPECT_EQ(sound_domain(text).action_names(), (std::vector<std::string>{"up", "down", "left", "right", "exit"}));
}

TEST(Items, TwoOfThemAreCarriedOneAtATime) {
  const Domain domain = sound_domain(R"(schema = "kith.domain/1"
id = "two-items"
[map]
rows = ["SpqG"]
[map.legend]
"S" = { start = true }
"p" = { item = "pen" }
"q" = { item = "cup" }
"G" = { destination = "cup" }
[[feature]]
name = "step"
when = "action"
[reward]
weights = { step = -1 }
)");
  EXPECT_EQ(domain.num_features(), 1u);
  EXPECT_EQ(domain.map()->item_names(), (std::vector<std::string>{"pen", "cup"}));
  const Mdp& mdp = domain.mdp(MdpIndex{0});
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    const GridState state = domain.map()->state(MdpIndex{0}, StateIndex{s});
    EXPECT_LE(state.carried[0] + state.carried[1], 1);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(!state.carried[i] || state.items[i] == state.robot);
  }
  // 4 robot cells; pen anywhere or carried; cup on three cells or carried; never both carried:
  // both lying 4*4*3, one carried 4*3 + 4*4. The cup is terminal on the fourth cell.
  EXPECT_EQ(mdp.num_states(), 4u * 4 * 3 + 4 * 3 + 4 * 4);
}

TEST(OptionalGroups, OfOneNameToggleTogetherAcrossSymbols) {
  std::string text = kColoredTiles;
  for (const std::string symbol : {"\"a\", optional = true", "\"b\", optional = true"}) {
    text.replace(text.find(symbol), symbol.size(), symbol.substr(0, 3) + ", optional = \"all\"");
  }
  const Domain domain = sound_domain(text);
  EXPECT_EQ(domain.num_mdps(), 2u);
  EXPECT_EQ(domain.describe_world(MdpIndex{0}), "a@{} b@{}");
  EXPECT_EQ(domain.map()->content(MdpIndex{1}, {2, 2}).terrain, "a");
  EXPECT_EQ(domain.map()->content(MdpIndex{1}, {2, 4}).terrain, "b");
  EXPECT_EQ(domain.map()->content(MdpIndex{0}, {2, 2}).terrain, "");
}

TEST(Maps, OfOneRowAndOfOneStepAreFine) {
  const std::string text = testing::steps_domain("\"SG\"");
  const Domain domain = sound_domain(text);
  EXPECT_EQ(domain.num_starts(), 1u);
  EXPECT_EQ(domain.mdp(MdpIndex{0}).choices(StateIndex{0}).size(), 1u);
  EXPECT_TRUE(domain.prior().empty());
  std::string one_cell = text;
  one_cell.replace(one_cell.find("SG"), 2, "S");
  EXPECT_EQ(parse_domain(one_cell, "t").diagnostics.at(0).id, "E0210");
}

TEST(Weights, AreTakenAsTheDecimalFractionsThatTheyShow) {
  const auto integer = [](const std::string& a, const std::string& b) {
    std::string text = kColoredTiles;
    text.replace(text.find("a = -6.5"), 8, "a = " + a);
    text.replace(text.find("b = -5.25"), 9, "b = " + b);
    return sound_domain(text).weights().integer;
  };
  EXPECT_EQ(integer("-0.1", "-0.3"), (IntegerVector{-1, -3, -10}));
  EXPECT_EQ(integer("-1e3", "0"), (IntegerVector{-1000, 0, -1}));
  EXPECT_EQ(integer("-1_000.5", "-2.5e-1"), (IntegerVector{-4002, -1, -4}));
  EXPECT_EQ(integer("-2147483647", "0"), (IntegerVector{-2147483647, 0, -1}));
}

}  // namespace
}  // namespace kith
