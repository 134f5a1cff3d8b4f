// kith lesson, study and audit for people who know the robot as it was before an update.
#include <gtest/gtest.h>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

std::string updated(const std::string& name) { return std::string{KITH_SOURCE_DIR} + "/tests/updates/" + name; }

TEST(KnowingCommand, PrintsWhatIsNewAndWhatIsNot) {
  const auto ran = out_of({"lesson", updated("rubble_free.toml"), "--knowing", "item-delivery"});
  EXPECT_THAT(ran, HasSubstr("The robot has been updated. Now crossing rubble is better than 2 steps."));
  EXPECT_THAT(ran, HasSubstr("it is as before the update"));
  const auto document = json_of({"lesson", updated("rubble_free.toml"), "--knowing", "item-delivery"});
  EXPECT_EQ(document.at("update").at("now"), Json::array({"crossing rubble is better than 2 steps"}));

  const auto same = out_of({"lesson", "item-delivery", "--knowing", updated("unchanged.toml")});
  EXPECT_THAT(same, AllOf(HasSubstr("it decides as before"), Not(HasSubstr("Demonstration"))));

  const auto other = run_kith({"lesson", "item-delivery", "--knowing", "two-goals"});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("weighs other features"));
}

// Who gets a lesson about the new robot and who gets none are told apart by what they answer.
TEST(KnowingCommand, SaysWhoStillBelievesInTheOlderRobot) {
  const Scratch scratch;
  const auto run = scratch / "run";
  const auto study = run_kith({"study", "quick", "-o", run, "-q", "--set", "replicates=1", "--set",
                               "domain=\"" + updated("rubble_free.toml") + "\"", "--set",
                               "learner.N.knowing=\"item-delivery\"", "--set", "learner.P.knowing=\"item-delivery\""});
  ASSERT_EQ(study.code, 0) << study.err;
  const auto told = out_of({"audit", run});
  EXPECT_THAT(told, HasSubstr("to believe in the robot as it was before the update"));
  EXPECT_THAT(told, HasSubstr("as it was before the update with probability"));
  // The study says what people knew; so can whoever asks.
  EXPECT_EQ(run_kith({"audit", run, "--knowing", "item-delivery"}).out, told);
  const auto document = json_of({"audit", run});
  for (const auto& person : document.at("people")) {
    EXPECT_GE(person.at("believes_older"), 0.0);
    EXPECT_LE(person.at("believes_older"), 1.0);
  }

  const auto dry = run_kith({"study", "quick", "--dry-run", "--set", "learner.N.knowing=\"item-delivery\""});
  EXPECT_THAT(dry.out, HasSubstr("learners N know the robot before an update, item-delivery"));
}

}  // namespace
}  // namespace kith::testing
