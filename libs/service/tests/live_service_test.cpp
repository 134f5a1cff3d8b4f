#include "kith/service/live_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "faulty_disk.hpp"
#include "kith/store/session_audit.hpp"
#include "kith/store/session_review.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using testing::exported;
using testing::FaultyDisk;
using testing::Group;
using testing::kQuestions;
using testing::next_step;
using testing::Page;
using testing::play;
using testing::play_until;
using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;
using testing::stored;

TEST(LiveService, TeachesThreePeopleFromTheirLinksToTheirCodes) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play(stage, people, solver, 2000, [](std::size_t person, const Json& view) {
    return person != 1 ||
           view.value(Json::json_pointer{"/predict/index"}, 1) != 0;  // one of them takes the shortest way now and then
  }));
  for (const auto& person : people) {
    EXPECT_EQ(person->stage(), "debrief");
    EXPECT_FALSE(person->view().at("debrief")["code"].get<std::string>().empty());
    EXPECT_TRUE(person->naks().empty()) << person->last_nak();
  }
  auto file = std::make_optional(stored(stage));
  EXPECT_NO_THROW(file->verify());
  const auto rooms = list_rooms(*file);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_EQ(rooms[0].joined, 3u);
  EXPECT_GT(rooms[0].answers, 0u);
  EXPECT_TRUE(rooms[0].is_taught);

  TeachingCache cache{stage.study().study->atlas};
  const auto replayed = replay_room(*file, file->rooms()[0], stage.study().study, cache);
  EXPECT_EQ(replayed.problem, "");
  EXPECT_EQ(replayed.lessons, rooms[0].lessons);

  // What was exported by default does not identify anybody.
  const auto tables = exported(stage);
  for (const auto& [name, text] : tables) {
    EXPECT_EQ(text.find("pid-"), std::string::npos) << name;
    EXPECT_EQ(text.find("Wilhelmina"), std::string::npos) << name;
  }
  EXPECT_TRUE(tables.count("SHA256SUMS"));
  const auto all = exported(stage, {.room = {}, .with_names = true, .with_text = true});
  EXPECT_NE(all.at("participants.csv").find("pid-a"), std::string::npos);
  EXPECT_NE(all.at("questions.csv").find("Wilhelmina"), std::string::npos);
  EXPECT_EQ(all.at("participants.csv").find("other"), std::string::npos) << "only collected parameters are kept";

  // Redacting keeps the session as it was.
  stage.stop();
  file.reset();
  EXPECT_GT(redact(stage.folder(), std::nullopt, stage.clock().now_us()), 0u);
  auto blank = stored(stage);
  EXPECT_EQ(replay_room(blank, blank.rooms()[0], stage.study().study, cache).problem, "");
  for (const auto* personal : {"pid-a", "Wilhelmina"}) EXPECT_FALSE(is_stored(stage, personal)) << personal;
  const auto restored = restore_session_study(blank.identity().inputs);
  EXPECT_EQ(restored.digest, stage.study().digest);
}

TEST(LiveService, WithdrawsOnePersonAndKeepsTheOthers) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play(stage, people, solver));
  EXPECT_FALSE(stage.join(stage.join_code(), {{"PROLIFIC_PID", "pid-b"}}).empty());
  stage.service().settle();
  stage.stop();
  const auto now = stage.clock().now_us();
  ASSERT_TRUE(is_stored(stage, "pid-b"));

  const auto trial = withdraw(stage.folder(), "r1", 2, now, true);
  EXPECT_GT(trial.at("answered"), 0u);
  EXPECT_EQ(trial.at("returned"), 1u);
  EXPECT_TRUE(is_stored(stage, "pid-b")) << "a trial changes nothing";
  EXPECT_THROW((void)withdraw(stage.folder(), "r1", 9, now), Error);
  EXPECT_EQ(withdraw(stage.folder(), "r1", 2, now), trial);
  EXPECT_FALSE(is_stored(stage, "pid-b"));
  EXPECT_TRUE(is_stored(stage, "pid-a"));

  // What is left of the person says nothing of paths and times.
  auto file = stored(stage);
  file.verify();
  file.for_each_event([&](const StoredEvent& event) {
    const auto body = body_of(event);
    if (event.actor != seat_actor(2)) return;
    EXPECT_TRUE(body.value("actions", Json::array()).empty()) << event.json;
    EXPECT_TRUE(body.value("keys", Json::array()).empty()) << event.json;
    EXPECT_EQ(body.value("ms", 0), 0) << event.json;
  });
  const auto audit = audit_session(stored(stage), SessionAuditOptions{});
  EXPECT_EQ(audit.report.people.size(), 2u);

  // Nobody sits there any more.
  stage.start();
  stage.service().settle();
  people[1]->connect(stage.service());
  group.settle();
  EXPECT_FALSE(people[1]->is_connected());
}

TEST(LiveService, GoesOnAfterARestartInTheMiddleOfAPeriod) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  group.act(*people[0]);
  ASSERT_TRUE(people[0]->unsaved().empty());
  const auto before = people[0]->view();

  group.restart();
  const auto& after = people[0]->view();
  EXPECT_EQ(after.at("stage"), before.at("stage"));
  EXPECT_EQ(after.value("predict", Json{}), before.value("predict", Json{}));
  ASSERT_TRUE(play(stage, people, solver));
  for (const auto& person : people) EXPECT_EQ(person->stage(), "debrief");
}

// Limits and grace periods begin where they were, or later: when the server stopped is known by the last event.
TEST(LiveService, LetsNoTimeGoByWhileTheServerIsStopped) {
  Group group{"time = { predict_s = 120, max_minutes = 5 }\ndropout = { grace_s = 60 }\n"};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  people[2]->disconnect(stage.service());
  group.pass(30);
  stage.stop();
  stage.clock().advance_ms(600'000);
  group.restart();
  for (const auto& person : people) EXPECT_EQ(person->stage(), "predict");
  EXPECT_GT(people[0]->view()["limit_ms"], people[0]->view()["server_ms"].get<std::int64_t>() + 80'000);
}

TEST(LiveService, AcknowledgesARepeatedMessageWithoutEffect) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  const auto step = next_step(people[0]->view(), solver, true);
  const Page::Message message{.id = "same-id", .type = step->first, .body = step->second};
  for (int i = 0; i < 3; ++i) people[0]->send(stage.service(), message);
  group.settle();
  EXPECT_EQ(std::count(people[0]->acks().begin(), people[0]->acks().end(), "same-id"), 3);
  group.restart();
  people[0]->send(stage.service(), message);
  group.settle();
  EXPECT_EQ(people[0]->acks().back(), "same-id");
  auto file = stored(stage);
  std::size_t times = 0;
  file.for_each_event([&](const StoredEvent& event) { times += event.message == "same-id" ? 1u : 0u; });
  EXPECT_EQ(times, 1u);
}

TEST(LiveService, LetsASecondTabTakeOver) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  Page second{people[0]->token(), "second"};
  second.connect(stage.service());
  group.settle();
  second.read();
  EXPECT_EQ(people[0]->bye(), "opened-elsewhere");
  EXPECT_FALSE(people[0]->is_connected());
  EXPECT_EQ(second.stage(), "consent");
  stage.service().closed(people[0]->connection());
  stage.pass_ms(3000);
  second.beat(stage.service());
  stage.service().settle();
  second.read();
  EXPECT_TRUE(second.is_connected()) << "closing the first tab does not affect the second";
}

TEST(LiveService, NoticesWhoIsAwayAndWhoIsBack) {
  Group group{"dropout = { policy = \"pause-then-continue\", grace_s = 60 }\n"};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  for (std::size_t i : {0u, 1u}) {
    while (people[i]->stage() == "predict") group.act(*people[i]);
  }
  people[2]->disconnect(stage.service());
  group.pass(12);
  ASSERT_TRUE(people[0]->view().contains("pause")) << people[0]->view().dump();
  EXPECT_EQ(people[0]->view().at("pause")["why"], "someone-away");
  people[2]->connect(stage.service());
  group.settle();
  EXPECT_FALSE(people[0]->view().contains("pause"));
  ASSERT_TRUE(play(stage, people, solver));
}

TEST(LiveService, ContinuesWithoutWhoStaysAway) {
  Group group{"dropout = { policy = \"pause-then-continue\", grace_s = 30 }\n"};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  people[2]->disconnect(stage.service());
  people.pop_back();
  group.pass(50);
  ASSERT_TRUE(play(stage, people, solver));
  for (const auto& person : people) EXPECT_EQ(person->stage(), "debrief");
}

TEST(LiveService, SaysNothingUntilItIsSavedAndSavesItWhenTheDiskIsBack) {
  const FaultyDisk disk;
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  FaultyDisk::fail(1, 1'000'000, FaultyDisk::Fault::kFull);
  const auto id = group.act(*people[0]);
  stage.pass_ms(3000);
  people[0]->read();
  EXPECT_THAT(people[0]->acks(), ::testing::Not(Contains(id)));
  const auto page = Json::parse(stage.get("/api/integrity", stage.facilitator_token()).body);
  EXPECT_GT(page["unsaved"], 0);
  EXPECT_FALSE(page["problems"].empty());
  FaultyDisk::heal();
  for (auto& person : people) person->beat(stage.service());
  stage.pass_ms(500);
  people[0]->read();
  EXPECT_THAT(people[0]->acks(), Contains(id));
  EXPECT_EQ(Json::parse(stage.get("/api/integrity", stage.facilitator_token()).body)["unsaved"], 0);
  ASSERT_TRUE(play(stage, people, solver));
}

TEST(LiveService, RefusesConnectionsThatDoNotSayWhoTheyAre) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  const auto first_frame = [&](const std::string& frame) {
    const auto socket = std::make_shared<testing::FakeSocket>();
    const auto connection = stage.service().open(socket);
    stage.service().receive(connection, frame);
    stage.service().settle();
    EXPECT_EQ(socket->close_code(), 1008) << frame;
    EXPECT_FALSE(socket->is_authenticated()) << frame;
    return socket;
  };
  for (const auto* frame : {R"({"t":"hello","v":1,"token":"AAAAAAAAAAAAAAAAAAAAAA"})", R"({"t":"hello"})"}) {
    EXPECT_EQ(first_frame(frame)->take().front()["reason"], "bad-token") << frame;
  }
  // Nothing is wrong with the link of these: a page that reads "bad-token" would ask for another one.
  for (const auto* frame : {"{}", "[1]", "x", R"({"t":"answer","id":"1","body":{}})"}) {
    const auto socket = first_frame(frame);
    EXPECT_TRUE(socket->take().empty()) << frame;
    EXPECT_EQ(socket->close_reason(), "the first message must be a hello") << frame;
  }
  // A slow page is not told that its link is wrong either; how long it may take is up to the server in front.
  const auto slow = std::make_shared<testing::FakeSocket>();
  const auto connection = stage.service().open(slow);
  stage.pass_ms(60'000);
  EXPECT_FALSE(slow->close_code());
  stage.service().receive(connection, Json{{"t", "hello"}, {"v", 1}, {"token", stage.facilitator_token()}}.dump());
  stage.service().settle();
  EXPECT_TRUE(slow->is_authenticated());
  EXPECT_EQ(slow->take().front()["t"], "welcome");
}

TEST(LiveService, SurvivesMessagesThatMakeNoSense) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  auto& person = *people[0];
  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "[";
  for (const auto& frame : std::vector<std::string>{
           std::string{"[]"}, std::string{"{"}, std::string{"\xff\xfe"}, deep, std::string{R"({"t":7})"},
           std::string{R"({"t":"answer"})"}, std::string{R"({"t":"answer","id":"x"})"},
           std::string{R"({"t":"answer","id":"x","body":[]})"},
           std::string{R"({"t":"answer","id":"x","body":{"test":1e300}})"},
           std::string{R"({"t":"consent","id":"y","body":{"accept":"yes"}})"},
           R"({"t":"hello","id":"z"})" + std::string{},
           R"({"t":"consent","id":")" + std::string(100, 'i') + R"(","body":{}})"}) {
    stage.service().receive(person.connection(), frame);
  }
  stage.service().settle();
  const auto frames = person.socket()->take();
  EXPECT_EQ(frames.size(), 12u);
  for (const auto& frame : frames) EXPECT_EQ(frame["t"], "nak") << frame;
  EXPECT_TRUE(person.is_connected());
}

TEST(LiveService, IsRefusedWhereAnotherServes) {
  const ScratchFolder scratch;
  const auto study = small_study();
  Stage stage{scratch / "live", study};
  try {
    Stage second{scratch / "live", study};
    FAIL() << "two servers on one folder";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBusy);
    EXPECT_EQ(error.diagnostics().front().id, "E1610");
  }
}

}  // namespace
}  // namespace kith
