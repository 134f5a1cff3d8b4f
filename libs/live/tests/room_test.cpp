#include "kith/live/room.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "kith/live/screening.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::live_study;
using testing::page;
using testing::Play;

constexpr const char* kQuestions = R"([group]
completion = { prefix = "LAB", redirect = "https://example.org/done?cc={code}&pid={PID}" }
collect_query = ["PID"]
ask_name = true
questions = [
  { id = "clear", kind = "likert", text = "Was it clear?", required = true },
  { id = "why", kind = "text", text = "Why?" },
  { id = "age", kind = "choice", text = "Age?", options = ["young", "old"] },
]
)";

TEST(Room, TakesAGroupFromTheConsentToTheDebrief) {
  Play play{live_study(kQuestions)};
  play.join(3);
  EXPECT_EQ(play.room().stage_of(1), "consent");
  EXPECT_FALSE(play.room().has_free_seat());
  EXPECT_EQ(page(play, 1)["consent"]["version"], "1");
  const Json query{{"PID", "p 1"}, {"x", "y"}};
  for (const std::size_t i : {1u, 2u}) {
    ASSERT_EQ(play.seat(i, "consent", {{"accept", true}, {"version", "1"}, {"query", query}}), "");
    EXPECT_EQ(body_of(play.events().back())["query"], (Json{{"PID", "p 1"}}));
  }
  EXPECT_EQ(play.room().stage_of(1), "check");
  EXPECT_TRUE(page(play, 1)["check"]["board"].contains("map"));
  ASSERT_EQ(play.seat(1, "name", {{"name", "Ada"}}), "");
  ASSERT_EQ(play.seat(1, "checked"), "");
  EXPECT_EQ(play.room().stage_of(1), "lobby");
  EXPECT_EQ(page(play, 1)["lobby"]["present"], 1);
  EXPECT_EQ(page(play, 1)["lobby"]["size"], 3);
  play.get_ready(2);
  EXPECT_EQ(play.room().stage(), RoomStage::kLobby);
  play.get_ready(3);
  EXPECT_EQ(play.room().stage(), RoomStage::kRunning);  // everybody is there
  for (std::size_t i = 1; i <= 3; ++i) EXPECT_EQ(play.room().stage_of(i), "watch");

  EXPECT_EQ(page(play, 1)["watch"]["index"], 0);
  EXPECT_GT(page(play, 1)["watch"]["frames"].size(), 1u);
  play.watch(1);
  EXPECT_EQ(play.room().stage_of(1), "wait");
  EXPECT_EQ(page(play, 1)["wait"]["for"], "others-watching");
  EXPECT_EQ(page(play, 1)["wait"]["missing"], 2);
  play.watch(2);
  play.watch(3);
  EXPECT_EQ(play.room().stage_of(2), "predict");

  const auto start = play.room().session().lesson().tests.front().start;
  const auto right = play.right_path(start);
  const Json part = Json::array({right[0]});
  ASSERT_EQ(play.seat(1, "draft", {{"test", 0}, {"actions", part}}), "");
  EXPECT_EQ(page(play, 1)["predict"]["draft"], part);
  play.answer(1, true);
  play.answer(2, false);
  EXPECT_EQ(page(play, 1)["wait"]["for"], "answers");
  play.answer(3, true);
  EXPECT_EQ(play.room().stage_of(1), "feedback");
  const auto good = page(play, 1)["feedback"], bad = page(play, 2)["feedback"];
  EXPECT_EQ(good["all_right"], true);
  EXPECT_EQ(bad["all_right"], false);
  EXPECT_EQ(good["learned"], false);
  EXPECT_EQ(good["others_unsure"], true) << "why the group goes on";
  EXPECT_EQ(bad["others_unsure"], false) << "the own answer is reason enough";
  EXPECT_EQ(good["tests"][0]["right"], true);
  EXPECT_FALSE(good["tests"][0]["why"].empty());
  EXPECT_EQ(good["tests"][0]["differs_at"], nullptr);
  EXPECT_EQ(bad["tests"][0]["right"], false);
  EXPECT_EQ(bad["tests"][0]["differs_at"], 0);
  EXPECT_THAT(bad["tests"][0]["cost"].get<std::string>(), HasSubstr(" path"));
  for (std::size_t i = 1; i <= 3; ++i) ASSERT_EQ(play.seat(i, "continue"), "");
  EXPECT_EQ(play.room().stage_of(1), "watch");  // the second period
  EXPECT_EQ(play.room().session().periods(), 1u);

  play.play_on({1, 2, 3});
  EXPECT_EQ(play.room().stage(), RoomStage::kQuestions);
  EXPECT_EQ(page(play, 2)["questions"]["items"].size(), 3u);
  EXPECT_EQ(play.seat(2, "questions", {{"answers", {{"clear", 9}}}}), "bad-body");
  EXPECT_EQ(play.seat(2, "questions", {{"answers", {{"why", "so"}}}}), "missing-answer");
  EXPECT_EQ(play.seat(2, "questions", {{"answers", {{"clear", 7}, {"why", "so"}, {"age", 1}}}}), "");
  EXPECT_EQ(body_of(play.events().back())["answers"]["age"], "old");
  EXPECT_EQ(play.room().stage_of(2), "debrief");
  const auto debrief = page(play, 2)["debrief"];
  EXPECT_THAT(debrief["code"].get<std::string>(), ::testing::StartsWith("LAB-"));
  EXPECT_EQ(debrief["redirect"], "https://example.org/done?cc=" + debrief["code"].get<std::string>() + "&pid=p%201");
  EXPECT_FALSE(debrief["summary"].empty());
  EXPECT_TRUE(debrief["not_reached"].empty());
  EXPECT_LT(debrief["right"], debrief["tests"]);
  for (const std::size_t i : {1u, 3u}) EXPECT_EQ(play.seat(i, "questions", {{"answers", {{"clear", 1}}}}), "");
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
  EXPECT_NE(page(play, 1)["debrief"]["code"], debrief["code"]);
  play.expect_replay();
}

TEST(Room, TeachesASinglePersonAtAnyTime) {
  for (const char* strategy : {"common", "baseline"}) {
    Play play{live_study(), RoomSetup{.id = "r", .code = "c", .strategy = strategy, .composition = "N"}};
    play.start(1);
    play.play_on({1});
    EXPECT_EQ(play.room().stage(), RoomStage::kEnded) << strategy;
    EXPECT_EQ(play.room().stage_of(1), "debrief");
    play.expect_replay();
  }
}

// With imagined sessions the forecast knows how long others took; without, only the periods so far.
TEST(Room, ForecastsWhatIsLeft) {
  for (const std::string record : {"", "[record]\nforecast = 8\n"}) {
    Play play{live_study(record), RoomSetup{.id = "r", .code = "c", .strategy = "common", .composition = "N"}};
    play.start(1);
    const auto row = [&] { return play.room().row({Viewer::Role::kObserver, 0}); };
    EXPECT_FALSE(row().contains("forecast"));
    for (int i = 0; i < 20 && !row().contains("forecast"); ++i) {
      play.pass(10.0);
      play.act(1);
    }
    const auto ahead = row()["forecast"];
    ASSERT_TRUE(ahead.is_object()) << row().dump();
    EXPECT_GT(ahead["periods"], 0.0);
    EXPECT_LE(ahead["minutes_low"], ahead["minutes_high"]);
    EXPECT_EQ(ahead.contains("done_within"), !record.empty());
    if (!record.empty()) {
      EXPECT_EQ(play.study().imagined.at({"common", "N"}).size(), 8u);
    }
  }
}

TEST(Room, MixesPeopleAndStandIns) {
  Play play{live_study(), "NNP", {false, true, true}};
  play.start(1);
  play.play_on({1});
  EXPECT_EQ(play.room().stage_of(1), "debrief");
  EXPECT_GT(play.room().session().periods(), 2u);
  play.expect_replay();
}

TEST(Room, AcceptsARepeatedMessageWithoutAnEvent) {
  Play play{live_study()};
  play.start(3);
  ASSERT_EQ(play.seat(1, "watched", {{"demo", 0}}), "");
  const auto events = play.events().size();
  EXPECT_EQ(play.seat(1, "watched", {{"demo", 0}}), "");
  EXPECT_EQ(play.seat(1, "checked"), "");
  EXPECT_EQ(play.seat(1, "consent", {{"accept", true}, {"version", "1"}}), "");
  EXPECT_EQ(play.events().size(), events);
  for (std::size_t i = 1; i <= 3; ++i) play.watch(i);
  const auto path = play.right_path(play.room().session().lesson().tests.front().start);
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", path}, {"ms", 1}}), "");
  const auto after = play.events().size();
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", path}, {"ms", 1}}), "");
  EXPECT_EQ(play.events().size(), after);
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", Json::array()}, {"ms", 1}}), "already-answered");
}

// The group moved on while somebody had no connection: what they send again is not taken for the next round's.
TEST(Room, TakesNothingThatWasMeantForAnotherRound) {
  Play play{live_study("[group]\ntime = { watch_s = 10, predict_s = 20, feedback_s = 30 }\n"), "NN"};
  play.start(2);
  play.wait(10 + 20 + 30);
  ASSERT_EQ(page(play, 1)["stage"], "watch");
  ASSERT_EQ(page(play, 1)["progress"]["round"], 2);
  const auto events_after = [&](const std::string& type, Json body, std::size_t round) {
    const auto before = play.events().size();
    body["round"] = round;
    EXPECT_EQ(play.seat(1, type, body), "") << type;
    return play.events().size() - before;
  };
  EXPECT_EQ(events_after("watched", {{"demo", 0}}, 1), 0u);
  EXPECT_EQ(events_after("watched", {{"demo", 0}}, 2), 1u);
  for (const std::size_t seat : {1u, 2u}) play.watch(seat);
  const auto path = play.right_path(play.room().session().lesson().tests.front().start);
  Json answer{{"test", 0}, {"actions", path}, {"ms", 1}, {"round", 1}};
  EXPECT_EQ(play.seat(1, "answer", answer), "too-late");
  EXPECT_EQ(page(play, 1)["predict"]["index"], 0);
  answer["round"] = -1;
  EXPECT_EQ(play.seat(1, "answer", answer), "bad-body");
  EXPECT_EQ(events_after("answer", answer, 2), 1u);
  for (const std::size_t seat : {1u, 2u}) play.answer(seat);
  EXPECT_EQ(events_after("continue", Json::object(), 1), 0u);
  EXPECT_EQ(events_after("continue", Json::object(), 2), 1u);
  play.expect_replay();
}

// A page lets nobody drive that far; a program that does is told the true reason.
TEST(Room, RefusesAPathThatIsTooLongForWhatItIs) {
  Play play{live_study()};
  play.start_tests(3);
  const auto& study = play.study();
  const auto most = max_answer_actions(study.atlas->domain());
  const auto id = study.atlas->id(play.room().session().lesson().tests.front().start);
  const auto next = world_json(study, id.mdp).at("next");
  // There and back again: up and down, or left and right.
  std::vector<std::size_t> back_and_forth;
  const auto start = id.start.value();
  for (std::size_t a = 0; a < next[start].size() && back_and_forth.empty(); ++a) {
    if (next[start][a] < 0) continue;
    const auto there = next[start][a].get<std::size_t>();
    for (std::size_t b = 0; b < next[there].size(); ++b) {
      if (next[there][b] == start) back_and_forth = {a, b};
    }
  }
  ASSERT_FALSE(back_and_forth.empty());
  for (const auto n : {most + 1, std::size_t{501}, std::size_t{2000}}) {
    std::vector<std::size_t> actions;
    for (std::size_t i = 0; i < n; ++i) actions.push_back(back_and_forth[i % 2]);
    const Json body{{"test", 0}, {"actions", actions}, {"ms", 1}};
    for (const auto* type : {"answer", "draft"}) {
      const auto decision = play.room().decide({"seat:1", type, body, "id"}, play.now());
      ASSERT_TRUE(decision.refusal) << n;
      EXPECT_EQ(decision.refusal->reason, "too-long");
      EXPECT_THAT(decision.refusal->text, HasSubstr("at most " + std::to_string(most) + " moves"));
    }
    actions.resize(most);
    EXPECT_FALSE(
        play.room().decide({"seat:1", "draft", {{"test", 0}, {"actions", actions}}, "id"}, play.now()).refusal);
  }
}

// The last page says all of a component that was taught, however many periods it took, and apart from it what the
// group did not get to.
TEST(Room, TellsAtTheEndAllThatWasTaughtAndWhatWasNot) {
  const auto sentences_of = [](const Atlas& atlas, std::size_t component) {
    const auto& constraints = atlas.knowledge_components()[component].constraints;
    std::set<std::string> texts;
    for (auto& text :
         all_in_words(atlas.domain(), atlas.constraints().half_spaces(constraints.without(atlas.prior())))) {
      text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
      texts.insert(text + ".");
    }
    return texts;
  };
  const auto as_set = [](const Json& list) { return list.get<std::set<std::string>>(); };
  for (const bool is_whole : {true, false}) {
    Play play{live_study("[group]\ntime = { max_minutes = 60 }\n")};
    play.start(3);
    if (is_whole) {
      play.play_on({1, 2, 3});
    } else {  // time is up during the first component
      for (std::size_t i = 1; i <= 3; ++i) play.act(i, true);
      for (std::size_t i = 1; i <= 3; ++i) play.act(i, false);
      for (std::size_t i = 1; i <= 3; ++i) play.act(i, true);
      play.wait(3700);
    }
    const auto& atlas = *play.study().atlas;
    const auto debrief = page(play, 1)["debrief"];
    std::set<std::string> taught, all;
    for (std::size_t k = 0; k < atlas.knowledge_components().size(); ++k) {
      const auto own = sentences_of(atlas, k);
      all.insert(own.begin(), own.end());
      if (is_whole || k == 0) taught.insert(own.begin(), own.end());
    }
    EXPECT_EQ(as_set(debrief["summary"]), taught) << is_whole;
    auto both = as_set(debrief["summary"]);
    for (const auto& text : debrief["not_reached"]) EXPECT_TRUE(both.insert(text.get<std::string>()).second) << text;
    EXPECT_EQ(both, all);
    EXPECT_EQ(debrief["not_reached"].empty(), is_whole);
  }
}

// What people can send and what they are told.
TEST(Room, RefusesWhatCannotBe) {
  Play play{live_study()};
  EXPECT_EQ(play.seat(1, "watched", {{"demo", 0}}), "not-joined");
  EXPECT_EQ(play.seat(9, "checked"), "no-seat");
  EXPECT_EQ(play.send("nobody", "checked"), "no-seat");
  play.join(3);
  EXPECT_EQ(play.send("server", "join"), "full");
  EXPECT_EQ(play.seat(1, "checked"), "not-now");
  EXPECT_EQ(play.seat(1, "consent", {{"accept", true}, {"version", "0"}}), "other-version");
  EXPECT_EQ(play.seat(1, "consent", {{"accept", 1}, {"version", "1"}}), "bad-body");
  EXPECT_EQ(play.seat(1, "consent", "yes"), "bad-body");
  EXPECT_EQ(play.seat(1, "dance"), "unknown-type");
  EXPECT_EQ(play.seat(1, "name", {{"name", "x"}}), "not-now");  // nobody asks for names
  for (std::size_t i = 1; i <= 3; ++i) play.get_ready(i);
  EXPECT_EQ(play.seat(1, "watched", {{"demo", 7}}), "not-now");
  EXPECT_EQ(play.seat(1, "watched", {{"demo", -1}}), "bad-body");
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", Json::array()}, {"ms", 1}}), "not-now");
  EXPECT_EQ(play.send("server", "join"), "started");
  for (std::size_t i = 1; i <= 3; ++i) play.watch(i);
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", Json::array({99})}, {"ms", 1}}), "illegal-path");
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", Json::array({-1})}, {"ms", 1}}), "bad-body");
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", Json::array()}, {"ms", -1}}), "bad-body");
  EXPECT_EQ(play.seat(1, "answer", {{"test", 1000}, {"actions", Json::array()}, {"ms", 1}}), "not-now");
  EXPECT_EQ(play.seat(1, "draft", {{"test", 0}, {"actions", Json::array({99})}}), "illegal-path");
  EXPECT_EQ(play.seat(1, "questions", {{"answers", Json::object()}}), "not-now");
  EXPECT_EQ(play.send("facilitator", "pause"), "no-reason");
  EXPECT_EQ(play.facilitator("dance"), "unknown-type");
  EXPECT_EQ(play.facilitator("start"), "not-now");
  EXPECT_EQ(play.facilitator("extend", {{"seconds", 60}}), "not-now");
  EXPECT_EQ(play.facilitator("strategy", {{"name", "commn"}}), "no-strategy");
  EXPECT_EQ(play.facilitator("strategy", {{"name", "baseline"}}), "no-strategy");
  EXPECT_EQ(play.facilitator("simulate", {{"seat", 1}, {"type", "X"}}), "no-type");
  EXPECT_EQ(play.facilitator("simulate", {{"seat", 7}}), "no-seat");
  EXPECT_EQ(play.facilitator("message", {{"text", 1}}), "bad-body");
}

TEST(Room, StopsShortIsAWrongAnswerAndNoEvidence) {
  Play play{live_study(), "NN"};
  play.start_tests(2);
  play.answer(1);
  const auto tests = play.room().session().lesson().tests.size();
  for (std::size_t t = 0; t < tests; ++t) {
    ASSERT_EQ(play.seat(2, "answer", {{"test", t}, {"actions", Json::array()}, {"ms", 1}}), "");
  }
  const auto& verdicts = play.room().session().history().back().feedback.verdicts[1];
  EXPECT_FALSE(verdicts.front().correct);
  EXPECT_FALSE(verdicts.front().answered);
  const auto shown = page(play, 2)["feedback"]["tests"][0];
  EXPECT_TRUE(shown["unfinished"]);
  EXPECT_FALSE(shown.contains("cost"));
  EXPECT_TRUE(play.room().view({Viewer::Role::kFacilitator, 0}, play.now())["room"]["answers"].back()["stopped_short"]);
}

// A damaged file, or a log that somebody edited, may say anything of an answer that was erased.
TEST(Room, TakesOnlyWhatCanBeLeftOfAnErasedAnswer) {
  Play play{live_study(), "N"};
  play.start(1);
  play.watch(1);
  const auto& last = play.events().back();
  const auto refused = [&](const Json& erased) {
    auto room = play.room();
    happening::Answered answer;
    answer.erased = erased;
    try {
      room.apply({last.seq + 1, last.at_us, "seat:1", answer}, play.cache());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kMismatch) << erased;
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused({{"counts", nullptr}, {"finished", false}}));
  const Json malformed = {"x",
                          7,
                          Json::object(),
                          {{"counts", nullptr}},
                          {{"counts", {1, 0, 2}}, {"finished", 1}},
                          {{"counts", {1, 0}}, {"finished", true}},
                          {{"counts", {1, 0, 2, 3}}, {"finished", true}},
                          {{"counts", {1, 0, 0.5}}, {"finished", true}},
                          {{"counts", "102"}, {"finished", true}}};
  for (const auto& erased : malformed) EXPECT_TRUE(refused(erased)) << erased;
}

TEST(Room, ShowsThePartThatFeedbackIsAbout) {
  Play play{live_study(), "NN"};
  play.start(2);
  Json part;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < 400 && play.room().stage() == RoomStage::kRunning; ++i) {
    const auto stage = play.room().stage_of(1);
    const auto shown = page(play, 1)["progress"]["part"];
    if (stage == "watch" && shown != part) {
      part = shown;
      ++parts;
    }
    if (stage == "feedback") {
      EXPECT_EQ(shown, part);
    }
    for (const std::size_t number : {1u, 2u}) play.act(number);
  }
  EXPECT_GT(parts, 1u);
}

// What a study switches on is sent, and nothing else; events are the same.
TEST(Room, SendsScreensThatAStudySwitchesOn) {
  const std::string group = "[group.screens]\npredict_first = true\nbrackets = true\n";
  Play with{live_study(group), "NN"}, without{live_study(), "NN"};
  std::size_t brackets = 0;
  with.start(2);
  without.start(2);
  for (std::size_t i = 0; i < 30; ++i) {
    for (const std::size_t number : {1u, 2u}) {
      const auto on = page(with, number), off = page(without, number);
      ASSERT_EQ(on["stage"], off["stage"]);
      if (on["stage"] == "watch") {
        EXPECT_TRUE(on["watch"].contains("world") && on["watch"].contains("state"));
        EXPECT_FALSE(off["watch"].contains("world"));
      }
      if (on["stage"] == "feedback") {
        EXPECT_FALSE(off["feedback"].contains("brackets"));
        brackets += on["feedback"]["brackets"].size();
      }
      with.act(number);
      without.act(number);
    }
  }
  EXPECT_GT(brackets, 0u);
}

TEST(Room, KeepsTimeLimits) {
  Play play{live_study("[group]\ntime = { watch_s = 10, predict_s = 20, feedback_s = 30 }\n"), "NN"};
  play.start(2);
  play.watch(1);
  play.wait(9);
  EXPECT_EQ(play.room().stage_of(2), "watch");
  play.wait(2);
  EXPECT_EQ(play.room().stage_of(2), "predict");
  play.answer(1);
  ASSERT_EQ(play.facilitator("extend", {{"seconds", 10}}), "");
  play.wait(25);
  EXPECT_EQ(play.room().stage_of(2), "predict");
  ASSERT_EQ(play.facilitator("pause"), "");
  play.wait(1000);
  EXPECT_EQ(page(play, 2)["pause"]["why"], "facilitator");
  ASSERT_EQ(play.facilitator("resume"), "");
  EXPECT_EQ(play.room().stage_of(2), "predict");
  play.wait(6);
  EXPECT_EQ(play.room().stage_of(2), "feedback");
  const auto shown = page(play, 2)["feedback"]["tests"][0];
  EXPECT_EQ(shown["mine"], nullptr);
  EXPECT_FALSE(shown["unfinished"]);
  EXPECT_FALSE(shown.contains("cost"));
  play.wait(31);
  EXPECT_EQ(play.room().stage_of(1), "watch");
  play.expect_replay();
}

TEST(Room, EndsTeachingWhenTheTimeOfTheSessionIsOver) {
  Play play{live_study("[group]\ntime = { max_minutes = 1 }\n"), "NN"};
  play.start(2);
  play.wait(61);
  EXPECT_EQ(play.room().stage_of(1), "debrief");
  EXPECT_EQ(play.room().row({Viewer::Role::kObserver, 0})["ended"], "time-limit");
}

// Tampered events are not applied, and change nothing.
TEST(Room, AppliesOnlyEventsThatItsStateCanHaveLedTo) {
  Play play{live_study()};
  play.start(3);
  play.watch(1);
  auto room = play.room();
  const auto digest = room.digest();
  const auto& last = play.events().back();
  const auto refused = [&](RoomEvent event) {
    try {
      room.apply(event, play.cache());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kMismatch);
      return room.digest() == digest;
    }
    return false;
  };
  const auto next = last.seq + 1;
  EXPECT_TRUE(refused({next + 1, last.at_us, "seat:2", happening::Watched{0}}));
  EXPECT_TRUE(refused({next, last.at_us - 1, "seat:2", happening::Watched{0}}));
  EXPECT_TRUE(refused({next, last.at_us, "seat:2", happening::Watched{1}}));
  EXPECT_TRUE(refused({next, last.at_us, "server", happening::Dropped{1, "", {}, {}}}));
  EXPECT_TRUE(refused({next, last.at_us, "server", happening::LessonChosen{}}));
  EXPECT_TRUE(refused({next, last.at_us, "server", happening::TimeOver{"watch"}}));
  room.apply({next, last.at_us, "seat:2", happening::Watched{0}}, play.cache());
  EXPECT_NE(room.digest(), digest);
  // A lesson with another digest.
  auto events = play.events();
  const auto lesson = std::find_if(events.begin(), events.end(), [](const RoomEvent& event) {
    return event.get<happening::LessonChosen>() != nullptr;
  });
  std::get<happening::LessonChosen>(lesson->what).digest = "0";
  EXPECT_THROW((void)replay(live_study(), play.room().setup(), events, play.cache()), Error);
}

}  // namespace
}  // namespace kith
