#include "kith/explain/question.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "asking.hpp"
#include "atlases.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/explain/words.hpp"
#include "lake.hpp"

namespace kith {
namespace {

using testing::ask;
using testing::atlas_of;
using testing::complaint;
using ::testing::HasSubstr;

bool counts(const Atlas& atlas, const Example& example, std::size_t feature) {
  return atlas.feature_counts(example.start)[feature] != 0;
}

TEST(AskWhen, CountsWorldsAndShowsPairsThatDifferInOneThing) {
  const auto& atlas = atlas_of("item-delivery");
  const auto reply = ask("when does it recharge?");
  std::size_t with = 0;
  for (MdpIndex m{0}; m.value() < 64; ++m) {
    with += atlas.feature_counts(atlas.index({m, atlas.domain().initial_state(m)}))[1] != 0 ? 1U : 0U;
  }
  EXPECT_EQ(reply.text, "Stopping at the charger happens in " + std::to_string(with) +
                            " of 64 worlds on the way from the map's start.");
  ASSERT_GE(reply.examples.size(), 2u);
  ASSERT_EQ(reply.examples.size() % 2, 0u);
  for (std::size_t i = 0; i < reply.examples.size(); i += 2) {
    const auto& yes = reply.examples[i];
    const auto& no = reply.examples[i + 1];
    EXPECT_TRUE(counts(atlas, yes, 1)) << yes.text;
    EXPECT_FALSE(counts(atlas, no, 1)) << no.text;
    const auto toggled = atlas.id(yes.start).mdp.value() ^ atlas.id(no.start).mdp.value();
    EXPECT_EQ(toggled & (toggled - 1), 0u) << "one group";
    EXPECT_THAT(yes.text, HasSubstr("it does: "));
    EXPECT_THAT(no.text, HasSubstr("it does not: "));
  }
}

TEST(AskWhen, UnderstandsTheSameQuestionInManyForms) {
  const auto first = ask("when does it recharge?");
  for (const auto* question :
       {"when recharge", "When does the robot recharge", "when is it recharging?", "when does it stop at the charger?",
        "does it ever recharge?", "how often does it charge?", "will the robot go to the charger",
        "tell me when it recharges"}) {
    const auto reply = ask(question);
    EXPECT_EQ(reply.question, "When does it stop at the charger?") << question;
    EXPECT_EQ(reply.text, first.text) << question;
  }
  EXPECT_EQ(ask("when does it pick up the parcel?").question, ask("when pickup").question);
  EXPECT_EQ(ask("when does it go up").question, "When does it go up?");
}

TEST(AskWhen, LooksAtTheNextStepWhereACellIsNamed) {
  const auto& atlas = atlas_of("item-delivery");
  const auto reply = ask("when up at (4,3) carrying the parcel");
  EXPECT_EQ(reply.question, "When does it go up at (4,3) carrying parcel?");
  ASSERT_GE(reply.examples.size(), 2u);
  EXPECT_EQ(atlas.domain().action_names()[reply.examples[0].path.actions[0].value()], "up");
  EXPECT_NE(atlas.domain().action_names()[reply.examples[1].path.actions[0].value()], "up");
  EXPECT_EQ(atlas.domain().map()->state(atlas.id(reply.examples[0].start).mdp, reply.examples[0].path.states[0]).robot,
            (Cell{4, 1}));
  EXPECT_EQ(ask("where up at 4,3 carrying parcel").text, reply.text);
}

TEST(AskWhen, SaysSoWhereItIsTheSameEverywhere) {
  const auto reply = ask("when pickup");
  EXPECT_EQ(reply.text, "It picks it up in 64 of 64 worlds on the way from the map's start.");
  ASSERT_EQ(reply.examples.size(), 1u);
  EXPECT_THAT(reply.examples[0].text, HasSubstr("world 63, it does: it happens on every sensible path"));
}

TEST(AskWhere, ListsCellsWithAPathForEach) {
  const auto& atlas = atlas_of("item-delivery");
  const auto reply = ask("where does it recharge?");
  EXPECT_THAT(reply.text, HasSubstr("Stopping at the charger happens at (4,1) in "));
  ASSERT_EQ(reply.examples.size(), 1u);
  const auto& example = reply.examples[0];
  ASSERT_TRUE(example.decisive.has_value());
  EXPECT_EQ(atlas.domain().map()->state(atlas.id(example.start).mdp, example.path.states[*example.decisive]).robot,
            (Cell{4, 3}));
  EXPECT_EQ(ask("where recharge in world 0").text,
            "Stopping at the charger happens nowhere on the way from the map's start.");
}

TEST(AskWhy, ComparesTheStepWithTheOneInstead) {
  const auto reply = ask("why left, not up, at (4,3) in world 0?");
  EXPECT_EQ(reply.question, "Why does it go left and not go up at (4,3) in world 0?");
  ASSERT_EQ(reply.examples.size(), 1u);
  ASSERT_TRUE(reply.examples[0].alternative.has_value());
}

TEST(AskWhy, TellsWhenItDoesNot) {
  const auto& atlas = atlas_of("item-delivery");
  const auto start = atlas.index({MdpIndex{0}, atlas.domain().initial_state(MdpIndex{0})});
  ASSERT_EQ(atlas.domain().action_names()[atlas.trajectory(start).actions[0].value()], "pickup");
  EXPECT_THAT(ask("why up at (4,3) in world 0").text, HasSubstr("It does not: at (4,3) in world 0 it picks it up; "));
  EXPECT_EQ(ask("why up, not left, at (4,3) carrying the parcel?").text,
            ask("why up at (4,3) carrying the parcel?").text);
}

TEST(AskWhether, ShowsNothingThatTheAnswerDoesNotFollowFrom) {
  const auto reply =
      ask("is rubble worse than 4 steps");  // it is worth less than the charger, and that less than 4 steps
  ASSERT_EQ(reply.examples.size(), 2u);
  EXPECT_EQ(reply.examples[1].text, "stopping at the charger is worth more than crossing rubble");
}

TEST(AskWhy, ComparesWholeWaysWithoutACell) {
  const auto reply = ask("why does it not recharge in world 31?");
  EXPECT_THAT(reply.text, HasSubstr("in world 31; "));
  const auto goals = ask("why far and not near in world 0", "two-goals");
  EXPECT_EQ(goals.examples.size(), 1u);
}

// Without a world, a question why is answered where it is so, and by the plainest comparison.
TEST(AskWhy, ChoosesAWorldInWhichItIsSo) {
  for (const auto& [question, answer] : std::map<std::string, std::string>{
           {"why does it go around the rubble?", "does not happen in world 34; it would rather take 2 more steps"},
           {"why does it cross rubble?", "happens in world 10; it would rather cross rubble than take 4 more steps"},
           {"why does it recharge?", "happens in world 35; it will take 2 more steps to stop at the charger"},
           {"why does it not recharge?", "does not happen in world 59; it will not take 4 more steps"}})
    EXPECT_THAT(ask(question).text, HasSubstr(answer)) << question;
}

TEST(AskWhatIf, ShowsBothWorlds) {
  const auto& atlas = atlas_of("item-delivery");
  const auto reply = ask("what if there is no charger?");
  ASSERT_EQ(reply.examples.size(), 2u);
  const auto with = atlas.id(reply.examples[0].start).mdp;
  const auto without = atlas.id(reply.examples[1].start).mdp;
  EXPECT_EQ(reply.question, "What happens in world " + std::to_string(with.value()) + " without the charger at (4,1)?");
  EXPECT_EQ(toggled_groups(atlas.domain(), with, without).size(), 1u);
  const auto both = ask("what if rubble at (3,3) and charger");
  EXPECT_EQ(both.question, "What happens in world 0 with the rubble at (3,3) and the charger at (4,1)?");
  const auto none = ask("what if no charger and no rubble in world 63");
  EXPECT_EQ(atlas.id(none.examples[1].start).mdp, MdpIndex{0});
}

TEST(AskWhat, TellsTheNextStep) {
  const auto reply = ask("what does it do at (2,3) carrying the parcel?");
  EXPECT_EQ(reply.text, "At (2,3) in world 63 it goes left.");
}

TEST(AskErrors, PointIntoTheQuestion) {
  EXPECT_EQ(complaint("").substr(0, 8), "E1102 1:");
  EXPECT_THAT(complaint("wen recharge"),
              HasSubstr("E1102 1: a question begins with when, where, why, what, how much, does or would | "
                        "did you mean 'when'?"));
  EXPECT_THAT(complaint("when does it rechrge?"), HasSubstr("E1103 14: kith does not know the word 'rechrge' | did you "
                                                            "mean 'recharge'?"));
  EXPECT_THAT(complaint("when up 3"), HasSubstr("E1103 9: "));
  EXPECT_THAT(complaint("why up at (9,9)"),
              HasSubstr("E1104 12: the map has no cell (9,9) | it has 4 columns and 3 rows"));
  EXPECT_THAT(complaint("why up at (1,1)"), HasSubstr("E1104 12: the robot is never at (1,1) in world 63"));
  EXPECT_THAT(complaint("when up in world 99"),
              HasSubstr("E1105 18: there is no world 99 | they are numbered 0 to 63"));
  EXPECT_THAT(complaint("when up in world"), HasSubstr("E1105 12: which world?"));
  EXPECT_THAT(complaint("when"), HasSubstr("E1106 1: when does what happen?"));
  EXPECT_THAT(complaint("why"), HasSubstr("E1106 1: why what?"));
  EXPECT_THAT(complaint("what if"), HasSubstr("E1106 1: what if what?"));
  EXPECT_THAT(complaint("what does it do"), HasSubstr("E1106 1: what does it do where?"));
  EXPECT_THAT(complaint("when up and down"), HasSubstr("E1106 13: one thing at a time"));
  EXPECT_THAT(complaint("why down at (4,3)"), HasSubstr("E1107 5: 'down' is not possible at (4,3) in world 63"));
  EXPECT_THAT(complaint("what if no parcel"), HasSubstr("E1108 12: 'parcel' is not optional in this domain | "
                                                        "optional in this domain: rubble and charger"));
  EXPECT_THAT(complaint("what if charger in world 63"), HasSubstr("E1108 9: world 63 already has charger"));
  EXPECT_THAT(complaint("what if charger at (1,2)"), HasSubstr("E1108 9: no world has charger at (1,2)"));
  EXPECT_THAT(complaint("what at (2,3) carrying a goat"), HasSubstr("E1103 26: carrying what? | it can carry parcel"));
}

// Of listed worlds, the last one may lack what is asked about, and not every change leads to one of them.
TEST(AskWhatIf, ChangesAWorldThatCanBeChanged) {
  const std::string hospital = std::string{KITH_SOURCE_DIR} + "/libs/explain/tests/questions/hospital.toml";
  EXPECT_THAT(ask("what if there is no people?", hospital).question,
              HasSubstr("What happens in world 1 (morning round)"));
  EXPECT_THAT(ask("what if there is people?", hospital).question, HasSubstr("What happens in world 0 (night)"));
}

TEST(AskWhen, AnswersTheNegatedQuestion) {
  const auto& atlas = atlas_of("item-delivery");
  const auto yes = ask("when does it recharge?");
  for (const auto* question :
       {"when does it NOT recharge?", "when doesn't it recharge", "when does it avoid the charger?",
        "does it never recharge", "when does it go without stopping at the charger"}) {
    const auto reply = ask(question);
    EXPECT_EQ(reply.question, "When does it not stop at the charger?") << question;
    EXPECT_EQ(reply.text,
              "Stopping at the charger does not happen in 61 of 64 worlds on the way from the map's start.");
    ASSERT_EQ(reply.examples.size(), yes.examples.size());
    EXPECT_FALSE(counts(atlas, reply.examples[0], 1)) << "what was asked about comes first";
    EXPECT_TRUE(counts(atlas, reply.examples[1], 1));
  }
  EXPECT_THAT(yes.text, HasSubstr(" happens in 3 of 64 "));
  EXPECT_EQ(ask("when does it not avoid the charger").text, yes.text) << "denied twice";
  EXPECT_EQ(ask("when does it not ever avoid the charger").text, yes.text);
}

TEST(AskWhere, AnswersTheNegatedQuestion) {
  const auto& atlas = atlas_of("item-delivery");
  const auto up = ask("where does it go left in world 63");
  const auto not_up = ask("where does it not go left in world 63?");
  EXPECT_EQ(not_up.question, "Where does it not go left in world 63?");
  EXPECT_THAT(up.text, HasSubstr("It goes left at "));
  EXPECT_THAT(not_up.text, HasSubstr("It does not go left at "));
  for (const auto& example : not_up.examples) {
    const auto action = example.path.actions.at(example.decisive.value());
    EXPECT_NE(atlas.domain().action_names()[action.value()], "left") << example.text;
  }
  EXPECT_THAT(ask("where does it not go up?").text, HasSubstr(" worlds that lead there"));
}

TEST(AskWhy, UnderstandsAvoiding) {
  const auto expected = ask("why does it not cross rubble in world 31?");
  EXPECT_EQ(expected.question, "Why does it not cross rubble in world 31?");
  for (const auto* question :
       {"why does it avoid rubble in world 31", "why does it go around the rubble in world 31?",
        "why does it step around rubble in world 31", "why does it skip the rubble in world 31"}) {
    EXPECT_EQ(ask(question).text, expected.text) << question;
  }
  EXPECT_EQ(ask("why does it go left rather than up at (4,3) in world 0").question,
            "Why does it go left and not go up at (4,3) in world 0?");
}

TEST(Ask, UnderstandsSynonyms) {
  for (const auto& [said, meant] :
       std::map<std::string, std::string>{{"when does it deliver the parcel", "when dropoff"},
                                          {"when does it drop it off", "when dropoff"},
                                          {"when does it put the parcel down", "when dropoff"},
                                          {"when does it drop the parcel?", "when dropoff"},
                                          {"when does it collect the parcel", "when pickup"},
                                          {"when does it pick the parcel up", "when pickup"},
                                          {"when does it go north", "when up"},
                                          {"where does it turn left", "where left"},
                                          {"when does it drive over rubble", "when rubble"}}) {
    EXPECT_EQ(ask(said).text, ask(meant).text) << said;
  }
}

TEST(AskErrors, NameEveryWordThatIsNotKnown) {
  EXPECT_THAT(complaint("when does it purple recharge"), HasSubstr("E1103 14: kith does not know the word 'purple'"));
  EXPECT_THAT(complaint("when does it recharge bananas"), HasSubstr("E1103 23: kith does not know the word 'bananas'"));
  EXPECT_THAT(complaint("when up at (4,3) tomorrow"), HasSubstr("E1103 18: kith does not know the word 'tomorrow'"));
  EXPECT_THAT(complaint("what if there is no purple charger"),
              HasSubstr("E1103 21: kith does not know the word 'purple'"));
  EXPECT_THAT(complaint("when does it recharge the parcel"), HasSubstr("E1103 "));
  EXPECT_THAT(complaint("when pickup rubble"), HasSubstr("E1103 6: 'pickup rubble' is neither an action"));
  EXPECT_THAT(complaint("when does it \xC3\xA9viter recharge"), HasSubstr("E1103 14: kith does not know the word"));
  EXPECT_THAT(complaint("when banana"), HasSubstr("it knows up, down, left, right, pickup, dropoff"));
}

// An adverb changes nothing about when it happens.
TEST(Ask, PassesOverWordsThatDoNotMatter) {
  EXPECT_EQ(ask("when does it quickly recharge, please?").text, ask("when does it recharge").text);
  EXPECT_THAT(complaint("when does it recharge before it delivers"), HasSubstr("'before'"));
  EXPECT_THAT(complaint("when does it cross the rubbel"), HasSubstr("did you mean 'rubble'"));
}

TEST(AskErrors, RefuseToAnswerHalfAQuestion) {
  EXPECT_THAT(complaint("when up, not left"), HasSubstr("E1106 14: 'when' and 'where' take one thing"));
  EXPECT_THAT(complaint("when recharge where"), HasSubstr("E1106 15: one question at a time"));
  EXPECT_THAT(complaint("what recharge at (2,3)"), HasSubstr("E1106 6: 'what' asks for the next step"));
  EXPECT_THAT(complaint("what if no charger rubble"), HasSubstr("E1106 20: two things in one"));
  EXPECT_THAT(complaint("how many worlds"), HasSubstr("E1102 1: a question with 'how'"));
  EXPECT_THAT(complaint("how much up"), HasSubstr("E1106 10: how much does which feature count?"));
  EXPECT_THAT(complaint("how much rubble at (2,3)"), HasSubstr("E1106 1: 'how much' takes only a feature"));
}

// Numbers, signs and degrees are read whole, and what is worth something is held against what the other side costs.
TEST(AskWhether, ReadsEveryNumberAndSign) {
  const auto answer = [](const std::string& question) { return ask(question).text.substr(0, 3); };
  EXPECT_EQ(answer("is stopping at the charger worth more than 100 steps?"), "No:");
  EXPECT_EQ(answer("is stopping at the charger worth less than 4 steps?"), "Yes");
  EXPECT_EQ(answer("is the charger worth more than 3 steps?"), "Wha") << "it does not tell";
  EXPECT_EQ(answer("stopping at the charger is worth more than 100 steps"), "No:") << "as kith prints it";
  EXPECT_EQ(answer("does rubble cost more than 1.5 steps?"), "Yes");
  EXPECT_EQ(answer("does rubble cost more than half a step?"), "Yes");
  EXPECT_EQ(answer("does rubble cost more than 3.5 steps?"), "Wha");
  EXPECT_EQ(answer("does crossing rubble cost less than 1/2 steps?"), "No:");
  EXPECT_EQ(answer("does rubble cost more than 1,000 steps?"), "No:");
  for (const auto* question : {"does crossing rubble cost more than -2 steps?",
                               "is rubble at (3,3) worse than 2 steps?",
                               "does rubble cost at most 2 steps more than the charger?",
                               "is rubble worse than 2 3 steps?",
                               "is rubble worse than 2 steps in world 3?",
                               "does rubble cost as much as 2 steps or more than the charger?",
                               "what if rubble at (3,3) was not there but a charger was?",
                               "what if all rubble but the one at (3,3) is gone?",
                               "does it cross rubble more than once",
                               "does it recharge exactly once?",
                               "does it cross rubble at most once?",
                               "when does it recharge in world -1?",
                               "what does it do at (-2,3)?",
                               "what does it do at (2.5,3)?",
                               "why does it recharge in world 3 but not in world 63?",
                               "when is there a charger?",
                               "how many chargers are there?",
                               "what if there is less rubble?",
                               "what if some rubble is gone?",
                               "does it recharge and?",
                               "what if the rubble changes?",
                               "why does it cross rubble if there is no charger?",
                               "is rubble worse than 1/997 steps and 1/991 steps and 1/983 steps and 1/977 steps?",
                               "would it rather go up or left at (4,3)?",
                               "does it hardly recharge?"})
    EXPECT_THAT(complaint(question), ::testing::StartsWith("E11")) << question;
}

TEST(AskWhatIf, ReadsWhatIsDeniedBehindIt) {
  EXPECT_EQ(ask("what if the charger was not there?").question, ask("what if there is no charger?").question);
  EXPECT_EQ(ask("if there is rubble at (4,2), what would it do?").question, ask("what if rubble at (4,2)?").question);
  EXPECT_EQ(ask("what if the charger is not gone?").question, ask("what if there is a charger?").question);
}

// A condition leaves the question what it is: it is about fewer worlds.
TEST(AskWhen, IsAboutTheWorldsThatAConditionLeaves) {
  const auto& atlas = atlas_of("item-delivery");
  const auto& domain = atlas.domain();
  const auto groups = domain.optional_groups();
  for (const std::string thing : {"charger", "rubble"}) {
    for (const bool present : {false, true}) {
      for (std::size_t k = 0; k < 2; ++k) {
        std::size_t of = 0, yes = 0;
        for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
          bool is_there = false;
          for (std::size_t g = 0; g < groups.size(); ++g)
            is_there = is_there || (groups[g].name == thing && domain.present_things(m)[g]);
          if (is_there != present) continue;
          ++of;
          yes += atlas.feature_counts(atlas.index({m, domain.initial_state(m)}))[k] != 0 ? 1U : 0U;
        }
        const auto condition = std::string{"there is "} + (present ? "a " : "no ") + thing;
        const auto reply = ask("does it " + doing(domain.wording(k), 1, false) + " if " + condition + "?");
        EXPECT_THAT(reply.text, HasSubstr(" in " + std::to_string(yes) + " of " + std::to_string(of) + " worlds with"));
        EXPECT_EQ(ask("if " + condition + ", does it " + doing(domain.wording(k), 1, false)).text, reply.text);
        for (const auto& example : reply.examples) {
          const auto world = domain.present_things(atlas.id(example.start).mdp);
          bool is_there = false;
          for (std::size_t g = 0; g < groups.size(); ++g) is_there = is_there || (groups[g].name == thing && world[g]);
          EXPECT_EQ(is_there, present) << reply.question << " " << example.text;
        }
      }
    }
  }
  EXPECT_THAT(complaint("when does it recharge in world 3 if there is no rubble"), HasSubstr("E1106 49: "));
  EXPECT_THAT(complaint("does it cross rubble if there is no purple"), HasSubstr("'purple'"));
  EXPECT_THAT(complaint("does it cross rubble if"), HasSubstr("E1106"));
  EXPECT_THAT(complaint("why does it recharge if there is no rubble"), HasSubstr("'if'"));
}

TEST(AskWhat, CountsStepsOfAWorld) {
  EXPECT_EQ(ask("how many steps in world 7?").text, ask("what does it do in world 7").text);
}

// Two of three worlds are certain.
TEST(AskWhen, SaysInHowManyWorldsChanceDecides) {
  const std::string pond = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  EXPECT_THAT(ask("when does it come home?", pond).text, HasSubstr(" in 3 of 3 worlds on the way from the first state, "
                                                                   "in 1 of them only with a chance of 90 %."));
}

// In world 63 nothing changes without the charger; elsewhere it does.
TEST(AskWhatIf, LooksForAWorldWhereItMatters) {
  const auto& atlas = atlas_of("item-delivery");
  for (const auto* question : {"what if there is no charger?", "what happens if there is no charger anywhere",
                               "what would it do without the charger"}) {
    const auto reply = ask(question);
    ASSERT_EQ(reply.examples.size(), 2u);
    EXPECT_NE(reply.examples[0].path.actions, reply.examples[1].path.actions) << question;
    EXPECT_TRUE(counts(atlas, reply.examples[0], 1));
    EXPECT_THAT(reply.text, HasSubstr("(it changes the path in 3 of 32 worlds)"));
  }
  EXPECT_THAT(ask("what if no charger in world 63").text, HasSubstr(" nothing changes in world 63."));
  EXPECT_EQ(ask("what happens if everywhere is rubble").question, ask("what if rubble").question);
}

TEST(AskHowMuch, ListsWhatItsBehaviourTells) {
  const auto reply = ask("how much does rubble cost?");
  EXPECT_EQ(reply.question, "How much does crossing rubble cost?");
  EXPECT_EQ(
      reply.text,
      "From what it does you can conclude: crossing rubble costs more than 2 steps; stopping at the charger is worth "
      "more than crossing rubble.");
  EXPECT_EQ(reply.examples.size(), 2u);
  for (const auto& example : reply.examples) EXPECT_TRUE(example.alternative.has_value()) << example.text;
  EXPECT_EQ(ask("how much is the charger worth").question, "How much is stopping at the charger worth?");
}

TEST(AskErrors, NameWhatWordsCouldMean) {
  EXPECT_THAT(complaint("when goal", "two-goals"),
              HasSubstr("E1103 6: 'goal' could mean several things: near and far"));
}

TEST(AskErrors, NeverEscapeOtherwise) {
  const std::vector<std::string> odd{
      "?",         "(((",          "when (1,2),(2,1)", "1,1",           "why not",   "what if no no no",
      "when when", "where not",    "what if with and", "when carrying", "why at 1,", "when up at 99999999999,1",
      "world",     "what without", "when -1,2"};
  for (const auto& question : odd) {
    const auto said = complaint(question);
    EXPECT_TRUE(said == "answered" || said.substr(0, 3) == "E11") << question << ": " << said;
  }
}

TEST(Ask, WorksInAllSmallDomains) {
  for (const auto& name : testing::kSmallDomains) {
    const auto& atlas = atlas_of(name);
    for (const auto& feature : atlas.domain().feature_names()) {
      for (const auto* form : {"when ", "where ", "why ", "why not "}) {
        const auto reply = answer_question(atlas, form + feature);
        EXPECT_FALSE(reply.text.empty());
        EXPECT_EQ(reply.text.find('{'), std::string::npos);
        for (const auto& example : reply.examples) {
          EXPECT_FALSE(example.text.empty());
          EXPECT_TRUE(atlas.domain().mdp(atlas.id(example.start).mdp).is_terminal(example.path.states.back()));
        }
      }
    }
  }
}

}  // namespace
}  // namespace kith
