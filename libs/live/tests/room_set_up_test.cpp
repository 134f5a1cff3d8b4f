// Which groups a room can be made for, and how people are tested before.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/live/room.hpp"
#include "kith/live/screening.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::live_study;
using testing::page;
using testing::Play;

TEST(LiveStudy, RefusesADesignOfWhichNoGroupCanBeTaught) {
  const auto with = [](const std::string& compositions, const std::string& group) {
    auto text = testing::kLiveStudy + group;
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace("[\"common\", \"joint\", \"individual-low\", \"baseline\"]", "[\"baseline\"]");
    replace("[\"NNP\", \"NN\", \"N\"]", compositions);
    const auto reading = parse_study(text, "live.toml");
    return make_live_study(*reading.study, testing::atlas_of("item-delivery"));
  };
  EXPECT_EQ(live_cells(*with("[\"N\", \"P\"]", "")).size(), 2u);
  for (const auto& [compositions, group] :
       {std::pair{"[\"NN\", \"NNP\"]", ""}, std::pair{"[\"N\"]", "[group]\nsize = 2\n"}}) {
    try {
      (void)with(compositions, group);
      ADD_FAILURE() << compositions;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      EXPECT_THAT(error.what(), HasSubstr("Add a composition of one learner"));
    }
  }
}

TEST(LiveStudy, TellsPeopleHowMuchOfTheRobotIsExplained) {
  const auto story_with = [](const std::string& inferred, const std::string& group) {
    std::ifstream file{std::string{KITH_SOURCE_DIR} + "/domains/item_delivery.toml"};
    const std::string text{std::istreambuf_iterator<char>{file}, {}};
    auto atlas = std::make_shared<const Atlas>(*parse_domain(text + inferred, "inferred").domain);
    const auto reading = parse_study(testing::kLiveStudy + group, "live.toml");
    return make_live_study(*reading.study, std::move(atlas))->group().story;
  };
  const std::string inferred = "\n[inferred]\nshare = 0.965\n", own = "[group]\nstory = [\"A robot.\"]\n";
  const std::string told = "What it likes and dislikes explains 96 % of what it does. Only that is shown here.";
  EXPECT_EQ(story_with(inferred, "").back(), told);
  EXPECT_THAT(story_with(inferred, "").front(), HasSubstr("Here it always takes"));
  EXPECT_EQ(story_with(inferred, own), (std::vector<std::string>{"A robot.", told}));
  EXPECT_EQ(story_with("", own).size(), 1u);
  EXPECT_THAT(story_with("\n[inferred]\nshare = 1.0\n", "").back(), HasSubstr(" It always takes"));
}

TEST(Room, RefusesASetUpThatCannotBeTaught) {
  const auto study = live_study();
  TeachingCache cache{study->atlas};
  const auto refusal = [&](RoomSetup setup) -> std::string {
    try {
      (void)Room{study, std::move(setup), cache};
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal({.id = "r", .strategy = "baseline", .composition = "NN"}), HasSubstr("one person at a time"));
  EXPECT_THAT(refusal({.id = "r", .strategy = "commn", .composition = "NN"}), HasSubstr("no strategy 'commn'"));
  EXPECT_THAT(refusal({.id = "r", .strategy = "common", .composition = "NX"}), HasSubstr("no learner type 'X'"));
  EXPECT_THAT(refusal({.id = "r", .strategy = "common", .composition = ""}), HasSubstr("1 to 30 seats"));
  EXPECT_THAT(refusal({.id = "r", .strategy = "common", .composition = "NN", .simulated = {true}}), HasSubstr("seats"));
  EXPECT_THAT(refusal({.id = "r", .strategy = "adaptive", .composition = "NN", .lessons = 1}),
              HasSubstr("open the folder with the version that began it"));
  EXPECT_THAT(refusal({.id = "r", .strategy = "common", .composition = "NN", .lessons = 99}),
              HasSubstr("newer version"));
  const auto by_exam = live_study("[stop]\nmastery = \"exam\"\n");
  TeachingCache of_exam{by_exam->atlas};
  EXPECT_THROW((Room{by_exam, {.id = "r", .strategy = "common", .composition = "NN", .lessons = 2}, of_exam}), Error);
  EXPECT_NO_THROW((Room{by_exam, {.id = "r", .strategy = "common", .composition = "NN"}, of_exam}));
  const RoomSetup setup{.id = "r",
                        .code = "c",
                        .strategy = "common",
                        .composition = "NN",
                        .simulated = {true, false},
                        .replicate = 7,
                        .salt = "s"};
  EXPECT_EQ(room_setup(to_json(setup)), setup);
  EXPECT_THROW((void)room_setup(Json::array()), Error);
  // Rooms of before there was such a rule choose their lessons without it when they are repeated.
  auto old = to_json(setup);
  EXPECT_EQ(room_setup(old).lessons, RoomSetup::kLessonRules);
  old.erase("lessons");
  old["avoids_repeats"] = true;
  EXPECT_EQ(room_setup(old).lessons, 1u);
  old.erase("avoids_repeats");
  EXPECT_EQ(room_setup(old).lessons, 0u);
}

TEST(Room, AsksScreeningTestsBeforeTheLobby) {
  Play play{live_study("[group]\nscreening = { tests = 3 }\n"), "N"};
  play.join(1);
  ASSERT_EQ(play.seat(1, "consent", {{"accept", true}, {"version", "1"}}), "");
  ASSERT_EQ(play.seat(1, "checked"), "");
  ASSERT_EQ(play.room().stage_of(1), "screening");
  EXPECT_EQ(page(play, 1)["predict"]["of"], 3);
  EXPECT_EQ(play.seat(1, "screen", {{"test", 1}, {"actions", Json::array()}, {"ms", 1}}), "not-now");
  const auto& tests = play.study().screening;
  ASSERT_EQ(play.seat(1, "screen", {{"test", 0}, {"actions", play.right_path(tests[0])}, {"ms", 1}}), "");
  ASSERT_EQ(play.seat(1, "screen", {{"test", 1}, {"actions", play.wrong_path(tests[1])}, {"ms", 1}}), "");
  EXPECT_FALSE(page(play, 1).contains("feedback"));
  ASSERT_EQ(play.seat(1, "screen", {{"test", 2}, {"actions", play.right_path(tests[2])}, {"ms", 1}}), "");
  EXPECT_EQ(play.room().stage(), RoomStage::kRunning);
  const auto row = play.room().row({Viewer::Role::kFacilitator, 0});
  EXPECT_EQ(row["seats"][0]["estimate"], screening_estimate(2, 3));
  EXPECT_EQ(row["seats"][0]["estimate_is_high"], true);
  play.expect_replay();
}

TEST(Screening, EstimatesByTheRuleOfSuccession) {
  EXPECT_EQ(screening_estimate(0, 0), 0.5);
  EXPECT_EQ(screening_estimate(0, 2), 0.25);
  EXPECT_EQ(screening_estimate(3, 3), 0.8);
  EXPECT_THROW((void)screening_estimate(2, 1), std::invalid_argument);
}

}  // namespace
}  // namespace kith
