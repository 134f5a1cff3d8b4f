// Questions about domains without tables: worlds on demand, imported models, weights that were inferred.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asking.hpp"
#include "lake.hpp"

namespace kith {
namespace {

using testing::ask;
using testing::atlas_of;
using testing::complaint;
using ::testing::HasSubstr;

TEST(AskOnDemand, ComparesWithOneOtherStep) {
  const auto reply = ask("why stairs in world 0", "rescue-floor");
  EXPECT_EQ(reply.text,
            "A stair happens in world 0; it would rather take 2 stairs than take 4 more steps: a stair costs less than "
            "2 steps.");
  const auto& example = reply.examples.at(0);
  ASSERT_TRUE(example.alternative.has_value());
  ASSERT_TRUE(example.decisive.has_value());
  const auto t = *example.decisive;
  EXPECT_EQ(example.path.states.at(t), example.alternative->states.at(t));
  EXPECT_NE(example.path.actions.at(t), example.alternative->actions.at(t));
}

TEST(AskOnDemand, ComparesWithThoseToWhomAFeatureMeansMore) {
  const auto& atlas = atlas_of("rescue-floor");
  const auto reply = ask("why smoke in world 8", "rescue-floor");
  EXPECT_EQ(reply.text,
            "Going through smoke happens in world 8; it would rather go through smoke once more than take 7 more "
            "steps: going through smoke costs less than 7 steps.");
  const auto& mdp = atlas.domain().mdp(MdpIndex{8});
  EXPECT_TRUE(mdp.is_terminal(reply.examples.at(0).alternative->states.back()));
  EXPECT_THAT(ask("why recharge in world 15", "rescue-floor").text, HasSubstr("; it happens on every sensible path."));
  EXPECT_THAT(ask("why not rubble in world 0", "rescue-floor").text, HasSubstr("; this world has none."));
}

TEST(AskOnDemand, ShowsWorldsThatDifferAsLittleAsAnyDo) {
  const auto reply = ask("when rubble", "rescue-floor");
  EXPECT_EQ(reply.text, "Crossing rubble happens in 6 of 16 worlds on the way from the map's start.");
  ASSERT_GE(reply.examples.size(), 2u);
  EXPECT_THAT(reply.examples[0].text, HasSubstr(", it does: "));
  EXPECT_THAT(reply.examples[1].text, HasSubstr(", it does not: "));
}

TEST(AskOfAModel, ComparesExpectations) {
  const std::string pond = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  EXPECT_EQ(ask("why not water", pond).text,
            "Falling into the water does not happen in world 2 (glaze); it avoids the risk of falling into the water.");
  EXPECT_THAT(ask("where water", pond).text,
              HasSubstr("Falling into the water can happen in state 'on the ice at c1' "));
  EXPECT_EQ(ask("what at 'a1'", pond).question, "What does it do in state 'on the bank at a1'?");
  EXPECT_EQ(ask("what at \"on the bank at a1\" in world 0", pond).text,
            "In state 'on the bank at a1' in world 0 (firm ice) it goes right.");
}

TEST(AskOfAModel, GivesChances) {
  const std::string pond = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  const auto reply = ask("when does it fall into the water?", pond);
  EXPECT_THAT(reply.text,
              HasSubstr("Falling into the water can happen in 1 of 3 worlds on the way from the first state, "
                        "with a chance of "));
  for (const auto& example : reply.examples) {
    EXPECT_THAT(example.text, ::testing::AnyOf(HasSubstr(", it may, with a chance of "), HasSubstr(", it does not: ")));
    EXPECT_THAT(example.text, ::testing::Not(HasSubstr("a single other step")));
  }
  const auto world = std::to_string(atlas_of(pond).id(reply.examples.at(0).start).mdp.value());
  EXPECT_THAT(ask("when water in world " + world, pond).text, HasSubstr("can happen there, with a chance of "));
}

// One world of the lake is firm ice: nothing is left to chance there, although it is in the other worlds.
TEST(AskOfAModel, SpeaksOfNoTriesWhereNothingIsLeftToChance) {
  const std::string gallery = std::string{KITH_SOURCE_DIR} + "/domains/gallery/";
  EXPECT_EQ(
      ask("why left at 'on the ice at (3,1)' in world 0", gallery + "frozen_lake.toml").text,
      "It does not: in state 'on the ice at (3,1)' in world 0 (firm ice) it goes down; it would rather not take 2 "
      "more steps: a step costs something.");
  EXPECT_EQ(
      ask("why not hole in world 0", gallery + "frozen_lake.toml").text,
      "Falling into a hole does not happen in world 0 (firm ice); it would rather take 4 more steps than fall into "
      "a hole: falling into a hole costs more than 4 steps.");
  EXPECT_EQ(
      ask("why right, not down, at 'on the path at (5,3)' in world 0", gallery + "cliff_walking.toml").text,
      "In state 'on the path at (5,3)' in world 0 (firm path) it goes right; the best other path has no advantage: "
      "it adds falling off the cliff and 5 steps.");
  for (const char* const action : {"left", "right", "up", "down"}) {
    for (const auto& example :
         ask(std::string{"why "} + action + " in world 0", gallery + "cliff_walking.toml").examples) {
      EXPECT_EQ(example.text.find("tries"), std::string::npos) << example.text;
    }
  }
}

TEST(AskOfAModel, TakesNamesOfStatesWithoutQuotes) {
  const std::string pond = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  const auto quoted = ask("what at 'on the bank at a1' in world 0", pond);
  EXPECT_EQ(ask("what in state on the bank at a1 in world 0", pond).text, quoted.text);
  EXPECT_EQ(ask("what does it do in state a1 in world 0", pond).text, quoted.text);
  const std::string cliff = std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml";
  EXPECT_EQ(ask("what in state 36", cliff).question, ask("what in state '36'", cliff).question);
  EXPECT_THAT(complaint("what in state", pond), HasSubstr("E1104 9: which state?"));
}

TEST(AskOfAModel, NeedsTheNamesOfItsStates) {
  const std::string pond = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  EXPECT_THAT(complaint("what at 'hill'", pond), HasSubstr("E1104 10: there is no state 'hill'"));
  EXPECT_THAT(complaint("what at 'ice'", pond), HasSubstr("E1104 10: 'ice' could be "));
  EXPECT_EQ(complaint("what at (1,1)", pond), "answered") << "its picture shows a state there";
  EXPECT_THAT(complaint("what at (9,1)", pond), HasSubstr("E1104 10: no state is drawn at (9,1)"));
  EXPECT_THAT(complaint("what at (1,1)", testing::slippery_lake("undrawn", "{ step = -1 }", "0.95")),
              HasSubstr("E1104 10: this domain has no map"));
  EXPECT_THAT(complaint("what if no ice", pond), HasSubstr("E1108 12: "));
  EXPECT_THAT(complaint("what at 'a1'"), HasSubstr("E1104 10: states have no names in a domain with a map"));
}

// From a: dry (1 step) or muddy; from b: through the mud or around (3 steps). The robot was seen at a only.
TEST(AskOfInferredWeights, SaysNothingOfWhatWasNotSeen) {
  const std::string text =
      "schema = \"kith.domain/1\"\nid = \"forks\"\n[model]\nformat = \"csv\"\nstates = \"s.csv\"\n"
      "transitions = \"t.csv\"\n[[feature]]\nname = \"mud\"\n[[feature]]\nname = \"step\"\n[prior]\n"
      "halfspaces = [ { step = -1 } ]\n[reward]\nweights = { mud = -3, step = -1 }\n[inferred]\nshare = 1.0\n"
      "left_out = [[0, 1]]\nnot_explained = [[0, 1]]\n";
  const DomainFiles files{{},
                          {{"s.csv", "state,terminal\na,false\nb,false\nend,true\n"},
                           {"t.csv",
                            "state,action,next,mud,step\na,dry,end,0,1\na,muddy,end,1,1\n"
                            "b,through,end,1,1\nb,around,end,0,3\n"}}};
  const auto reading = parse_domain(text, "forks", {}, files);
  ASSERT_TRUE(reading.domain) << reading.diagnostics.front().message;
  const Atlas atlas{*reading.domain};
  EXPECT_EQ(answer_question(atlas, "what at 'a'").text, "In state 'a' in world 0 it does 'dry'.");
  for (const auto* question : {"what at 'b'", "why around at 'b'", "when does it do around at 'b'"}) {
    try {
      ADD_FAILURE() << question << ": " << answer_question(atlas, question).text;
    } catch (const Error& error) {
      EXPECT_EQ(error.diagnostics().front().id, "E1104") << error.what();
      EXPECT_THAT(error.what(), HasSubstr("nobody knows"));
    }
  }
  EXPECT_THAT(answer_question(atlas, "does mud cost more than 2 steps").text, HasSubstr("does not tell"));
  EXPECT_THAT(answer_question(atlas, "does mud cost anything").text, HasSubstr("Yes"));
}

}  // namespace
}  // namespace kith
