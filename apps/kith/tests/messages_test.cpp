// What people are told: complaints about the command line, pictures and words.
#include <gtest/gtest.h>

#include "domain_texts.hpp"
#include "run_kith.hpp"

namespace kith::testing {
namespace {

TEST(Messages, SayInPlainWordsWhatIsWrongWithAValue) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{"validate"}, "kith validate needs FILE"},
      {{"inspect", "item-delivery", "--mdp", "-1"}, "there is no world '-1': they are numbered 0 to 63"},
      {{"inspect", "item-delivery", "--color", "nevr"}, "did you mean 'never'?"},
      {{"teach", "item-delivery", "--seed", "-1"}, "--seed must be an integer, 0 or more, not '-1'"},
      {{"teach", "item-delivery", "--strategy", "jont"}, "did you mean 'joint'?"},
      {{"teach", "item-delivery", "--from", "x", "--team", "1"}, "DOMAIN cannot be combined with --from"},
      {{"teach", "--from", "x"}, "--from needs --team"},
      {{"study", "quick", "--seed", "x"}, "--seed must be an integer, 0 or more, not 'x'"},
      {{"study", "quick", "--seed"}, "--seed needs a value"},
      {{"study", "quick", "--seed", "1", "--seed", "2"}, "--seed can be given only once"},
      {{"study", "quick", "--quiet", "--yes=maybe"}, "--yes takes no value"},
      {{"study", "quick", "--shard", "4/3"}, "--shard must be I/N"},
      {{"analyze", "x", "--model", "y", "--count", "--ordinal"}, "--count cannot be combined with --ordinal"},
      {{"analyze", "x", "--model", "y", "--observed", "z", "--ordinal"},
       "--observed cannot be combined with --ordinal"},
      {{"analyze", "x", "--model", "y", "--table", "learners"}, "--table names a table of a run folder; leave it out"},
      {{"analyze", "x", "--alpha", "0.5"}, "--alpha must be a number from 0.000001 to 0.499"},
      {{"power", "quick", "--findings", "f", "--pool", "9"}, "--pool cannot be combined with --findings"},
      {{"study", "quick", "-j", "9999"}, "--threads must be an integer from 1 to 1024, not '9999'"},
      {{"study", "quick", "--progress", "qqqqqq"}, "one of: auto, bar, json, none"},
  };
  for (const auto& [arguments, message] : refused) {
    const auto ran = run_kith(arguments);
    EXPECT_EQ(ran.code, 2) << ::testing::PrintToString(arguments);
    EXPECT_THAT(ran.err, HasSubstr(message));
  }
}

TEST(Messages, NameTheEnvironmentVariableOfAWrongValue) {
  const RunWith wrong{{{"KITH_THREADS", "x"}}, "", ""};
  EXPECT_THAT(run_kith({"study", "quick", "--dry-run"}, wrong).err, HasSubstr("environment variable KITH_THREADS"));
  EXPECT_THAT(run_kith({"study", "quick", "--dry-run", "-j", "y"}, wrong).err, Not(HasSubstr("KITH_THREADS")));
}

TEST(Messages, TakeAnUnknownStudyLikeAnUnknownDomain) {
  const auto study = run_kith({"study", "qick"});
  const auto domain = run_kith({"inspect", "item-delivry"});
  EXPECT_EQ(study.code, 3);
  EXPECT_EQ(domain.code, 3);
  EXPECT_THAT(study.err, HasSubstr("did you mean 'quick'?"));
  EXPECT_THAT(domain.err, HasSubstr("did you mean 'item-delivery'?"));
}

TEST(Messages, HaveNullInJsonForAnUnknownPlace) {
  const auto error = json_of({"inspect", "item-delivery", "--mdp", "64"}, 2).at("errors").at(0);
  for (const auto* key : {"file", "line", "column"}) EXPECT_TRUE(error.at(key).is_null()) << key;
}

TEST(Messages, ListTheValuesOfAnOptionInShortHelp) {
  EXPECT_THAT(run_kith({"teach", "-h"}).out, HasSubstr("one of: baseline, individual-low"));
  EXPECT_THAT(run_kith({"inspect", "-h"}).out, HasSubstr("one of: map, policy"));
}

TEST(Transcript, ShowsTheTerrainUnderThePathAndExplainsItsSymbols) {
  const auto text = run_kith({"teach", "item-delivery", "--group", "N", "--seed", "1"}).out;
  EXPECT_THAT(text, AllOf(HasSubstr("# wall   . floor   r rubble   B charger   G destination of parcel"),
                          HasSubstr("@ robot   * item elsewhere")));
  // The first panel of every picture is the bare map.
  std::size_t rows = 0;
  for (std::size_t at = text.find("\n    #"); at != std::string::npos; at = text.find("\n    #", at + 1)) {
    EXPECT_EQ(text.substr(at + 5, 4).find_first_of("@*oS^v<>"), std::string::npos) << text.substr(at, 20);
    ++rows;
  }
  EXPECT_GT(rows, 8u);
}

TEST(Transcript, TellsAVerdictFromAnAction) {
  const auto text = run_kith({"teach", "item-delivery", "--group", "NNP", "--seed", "1"}).out;
  EXPECT_THAT(text, AllOf(HasSubstr("member 3: correct: "), HasSubstr("member 1: wrong (regret "),
                          HasSubstr("ability is reset to its initial value")));
  EXPECT_THAT(text, Not(::testing::ContainsRegex("member [0-9]: right")));
}

TEST(Inspect, ShowsADomainThatCannotBeTaught) {
  const Scratch scratch;
  std::ofstream{scratch / "d.toml"} << steps_domain("\"S..G\"");
  const auto ran = run_kith({"inspect", scratch / "d.toml"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("Map of world 0"), HasSubstr("Reward"),
                             HasSubstr("The robot's policy in world 0"), HasSubstr("from the start: right x3")));
  EXPECT_THAT(ran.err, HasSubstr("with a single feature there is nothing to weigh"));
  const auto document = json_of({"inspect", scratch / "d.toml"});
  EXPECT_EQ(document.at("schema"), "kith.inspect/1");
  EXPECT_FALSE(document.contains("bec"));
}

}  // namespace
}  // namespace kith::testing
