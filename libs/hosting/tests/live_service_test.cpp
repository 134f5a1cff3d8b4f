#include "kith/hosting/live_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "faulty_disk.hpp"
#include "kith/hosting/session_export.hpp"
#include "kith/hosting/session_review.hpp"
#include "service_support.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using testing::FaultyDisk;
using testing::is_terminal;
using testing::next_step;
using testing::Page;
using testing::play;
using testing::ScratchFolder;
using testing::small_study;
using testing::Solver;
using testing::Stage;

constexpr const char* kQuestions =
    "questions = [{ id = \"clear\", kind = \"likert\", text = \"Was it clear?\", required = true },\n"
    "             { id = \"say\", kind = \"text\", text = \"Anything else?\" }]\n"
    "collect_query = [\"PROLIFIC_PID\"]\n";

// Three people in one room of the study, connected.
std::vector<std::unique_ptr<Page>> three_people(Stage& stage) {
  const auto code = stage.join_code();
  std::vector<std::unique_ptr<Page>> people;
  for (const auto* name : {"a", "b", "c"}) {
    const auto token = stage.join(code, {{"PROLIFIC_PID", std::string{"pid-"} + name}, {"other", "x"}});
    EXPECT_FALSE(token.empty());
    people.push_back(std::make_unique<Page>(token, name));
    people.back()->connect(stage.service());
  }
  stage.service().settle();
  for (auto& person : people) person->read();
  return people;
}

// A server with three people in its first room.
struct Group {
  explicit Group(const std::string& section = "") : stage{scratch / "live", small_study(section)} {
    people = three_people(stage);
  }
  // The server ends and starts again, and everybody reconnects.
  void restart() {
    stage.restart();
    for (auto& person : people) {
      person->lose();
      person->connect(stage.service());
    }
    stage.service().settle();
    for (auto& person : people) person->read();
  }

  ScratchFolder scratch;
  Stage stage;
  Solver solver{stage.study().study};
  std::vector<std::unique_ptr<Page>> people;
};

// Until everybody is at a stage.
bool play_until(Stage& stage, std::vector<std::unique_ptr<Page>>& people, Solver& solver, const std::string& wanted) {
  for (int round = 0; round < 300; ++round) {
    bool is_there = true;
    for (auto& person : people) {
      person->read();
      if (person->stage() == wanted) continue;
      is_there = false;
      const auto step = next_step(person->view(), solver, true);
      if (step && person->unsaved().empty()) person->ask(stage.service(), step->first, step->second);
    }
    if (is_there) return true;
    stage.service().settle();
    if (round % 4 == 3) stage.pass_ms(100);
  }
  return false;
}

// Time goes by while the pages of those who are connected are open.
void pass_with_beats(Stage& stage, std::vector<std::unique_ptr<Page>>& people, int seconds) {
  for (; seconds > 0; --seconds) {
    for (auto& person : people) person->beat(stage.service());
    stage.pass_ms(1000);
  }
}

// Whether the text is in any file of the session. @pre the server has stopped.
bool is_stored(const Stage& stage, const std::string& text) {
  const std::filesystem::directory_iterator files{stage.folder()};
  return std::any_of(begin(files), end(files), [&](const std::filesystem::directory_entry& file) {
    return read_file(file.path()).find(text) != std::string::npos;
  });
}

EventFile stored(const Stage& stage) { return EventFile::read(stage.folder()); }

std::map<std::string, std::string> exported(const Stage& stage, const SessionExportOptions& options = {}) {
  auto file = stored(stage);
  TeachingCache cache{stage.study().study->atlas};
  std::map<std::string, std::string> files;
  export_session(file, stage.study().study, cache, options,
                 [&](std::string_view name, std::string_view piece) { files[std::string{name}] += piece; });
  return files;
}

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
  for (const auto& entry : std::filesystem::directory_iterator{stage.folder()}) {
    const auto bytes = read_file(entry.path());
    EXPECT_EQ(bytes.find("pid-a"), std::string::npos) << entry.path();
    EXPECT_EQ(bytes.find("Wilhelmina"), std::string::npos) << entry.path();
  }
  const auto restored = restore_session_study(blank.identity().inputs);
  EXPECT_EQ(restored.digest, stage.study().digest);
}

TEST(LiveService, GoesOnAfterARestartInTheMiddleOfAPeriod) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  const auto step = next_step(people[0]->view(), solver, true);
  people[0]->ask(stage.service(), step->first, step->second);
  stage.service().settle();
  people[0]->read();
  ASSERT_TRUE(people[0]->unsaved().empty());
  const auto before = people[0]->view();

  group.restart();
  const auto& after = people[0]->view();
  EXPECT_EQ(after.at("stage"), before.at("stage"));
  EXPECT_EQ(after.value("predict", Json{}), before.value("predict", Json{}));
  ASSERT_TRUE(play(stage, people, solver));
  for (const auto& person : people) EXPECT_EQ(person->stage(), "debrief");
}

TEST(LiveService, ExportsAndRebuildsARoomOfStandIns) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  facilitator->ask(stage.service(), "room-make", {{"seats", {"N", "N", "P"}}, {"count", 1}});
  const auto row = [&]() -> Json {
    stage.show(*facilitator);
    const auto& rooms = facilitator->view().at("rooms");
    return rooms.empty() ? Json::object() : rooms[0];
  };
  for (int i = 0; i < 100 && row().value("stage", "") != "ended"; ++i) stage.pass_ms(1000);
  const auto before = row();
  ASSERT_EQ(before.value("stage", ""), "ended");
  std::set<std::string> types;
  auto file = std::make_optional(stored(stage));
  file->for_each_event([&](const StoredEvent& event) { types.insert(event.type); }, 1);
  EXPECT_EQ(types, (std::set<std::string>{"started", "lesson"}));
  // As kith session does it: with the study that is kept with the session.
  const auto kept = restore_session_study(file->identity().inputs);
  TeachingCache cache{kept.study->atlas};
  EXPECT_EQ(replay_room(*file, file->rooms()[0], kept.study, cache).problem, "");
  file.reset();
  const auto tables = stage.get("/api/export", stage.facilitator_token());
  EXPECT_EQ(tables.status, 200) << tables.body;
  EXPECT_NE(exported(stage).at("tests.csv").find("r1,"), std::string::npos);

  stage.restart();
  facilitator = stage.facilitator();
  EXPECT_EQ(row(), before);
  EXPECT_EQ(facilitator->view().at("integrity")["problems"], Json::array());
}

// One person of three is ready when the time in the lobby is over.
TEST(LiveService, ExportsStandInsForPeopleWhoDidNotCome) {
  Group group{"dropout = { policy = \"simulate\" }\ntime = { lobby_s = 60 }\n"};
  auto& [scratch, stage, solver, people] = group;
  for (const char* type : {"consent", "checked"}) {
    people[0]->ask(stage.service(), type, {{"accept", true}, {"version", "1"}});
    stage.service().settle();
  }
  pass_with_beats(stage, people, 62);
  people.resize(1);
  ASSERT_TRUE(play(stage, people, solver));
  EXPECT_EQ(people[0]->stage(), "debrief");
  const auto tables = exported(stage);
  std::istringstream participants{tables.at("participants.csv")};
  std::vector<std::string> rows;
  for (std::string row; std::getline(participants, row);) rows.push_back(row);
  ASSERT_EQ(rows.size(), 1u + 3u + 2u) << tables.at("participants.csv");
  EXPECT_EQ(rows[4].rfind("r1,4,2,", 0), 0u) << rows[4];  // the fourth seat is the second member's
  EXPECT_EQ(rows[5].rfind("r1,5,3,", 0), 0u) << rows[5];
}

// While people read the feedback the next lesson is chosen; if one of them leaves, it is chosen again.
TEST(LiveService, ExportsTheLessonThatWasTaught) {
  Group group{"dropout = { policy = \"continue-now\" }\n"};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "feedback"));
  stage.service().settle();
  people[2]->ask(stage.service(), "leave", Json::object());
  stage.service().settle();
  people.pop_back();
  ASSERT_TRUE(play(stage, people, solver));
  std::map<std::size_t, std::size_t> chosen;  // how often, by period
  auto file = stored(stage);
  file.for_each_event([&](const StoredEvent& event) {
    const auto body = Json::parse(event.json);
    if (event.type == "lesson" && !body.at("finished").get<bool>()) ++chosen[body.at("period").get<std::size_t>()];
  });
  ASSERT_EQ(chosen[2], 2u);
  const auto tables = exported(stage);
  const auto rows = [&](const char* name) {
    const auto& text = tables.at(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
  };
  EXPECT_EQ(rows("periods.csv"), chosen.size());
}

TEST(LiveService, GivesANewLinkToASeatWhoseLinkIsUnknownAfterARestart) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  facilitator->ask(stage.service(), "room-make", {{"seats", {"person", "person", "N"}}, {"count", 1}});
  const auto links = [&] {
    stage.show(*facilitator);
    std::vector<std::string> known;
    for (const auto& seat : facilitator->view().at("rooms")[0]["seats"]) known.push_back(seat.value("link", ""));
    return known;
  };
  const auto open = [&](const std::string& link) {
    auto page = std::make_unique<Page>(link.substr(link.find("#t=") + 3), "person");
    page->connect(stage.service());
    stage.service().settle();
    page->read();
    return page;
  };
  stage.show(*facilitator);
  const auto former = links();
  const auto first = open(former[0]);
  EXPECT_EQ(first->stage(), "consent");

  stage.restart();
  facilitator = stage.facilitator();
  EXPECT_EQ(links(), (std::vector<std::string>{"", "", ""}));
  for (const int seat : {1, 2}) {
    facilitator->ask(stage.service(), "readmit", {{"room", "r1"}, {"seat", seat}, {"reason", "lost the link"}});
  }
  const auto now = links();
  EXPECT_TRUE(facilitator->naks().empty()) << facilitator->last_nak();
  for (const auto& link : {now[0], now[1], former[0], former[1]}) EXPECT_EQ(open(link)->stage(), "consent") << link;
  EXPECT_EQ(now[2], "") << "stand-ins need none";
}

TEST(LiveService, AcknowledgesARepeatedMessageWithoutEffect) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  const auto step = next_step(people[0]->view(), solver, true);
  const Page::Message message{.id = "same-id", .type = step->first, .body = step->second};
  for (int i = 0; i < 3; ++i) people[0]->send(stage.service(), message);
  stage.service().settle();
  people[0]->read();
  EXPECT_EQ(std::count(people[0]->acks().begin(), people[0]->acks().end(), "same-id"), 3);
  group.restart();
  people[0]->send(stage.service(), message);
  stage.service().settle();
  people[0]->read();
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
  stage.service().settle();
  people[0]->read();
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
    const auto view = people[i]->view();
    while (people[i]->stage() == "predict") {
      const auto step = next_step(people[i]->view(), solver, true);
      people[i]->ask(stage.service(), step->first, step->second);
      stage.service().settle();
      people[i]->read();
    }
  }
  people[2]->disconnect(stage.service());
  pass_with_beats(stage, people, 12);
  people[0]->read();
  ASSERT_TRUE(people[0]->view().contains("pause")) << people[0]->view().dump();
  EXPECT_EQ(people[0]->view().at("pause")["why"], "someone-away");
  people[2]->connect(stage.service());
  stage.service().settle();
  people[0]->read();
  EXPECT_FALSE(people[0]->view().contains("pause"));
  ASSERT_TRUE(play(stage, people, solver));
}

TEST(LiveService, LogsWhoCameAndWhoWentAway) {
  Group group{"dropout = { policy = \"continue-now\" }\n"};
  auto& [scratch, stage, solver, people] = group;
  auto facilitator = stage.facilitator();
  people[2]->disconnect(stage.service());
  pass_with_beats(stage, people, 12);
  people[2]->connect(stage.service());
  const auto comings = [&] {
    std::vector<std::pair<std::string, std::string>> found;
    for (const auto& entry : facilitator->view().at("log")) {
      if (entry.value("room", "") == "r1") found.emplace_back(entry.value("actor", ""), entry.value("what", ""));
    }
    return found;
  };
  stage.show(*facilitator);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"seat:1", "joined"}, {"seat:2", "joined"}, {"seat:3", "joined"}, {"seat:3", "away"}, {"seat:3", "present"}};
  EXPECT_EQ(comings(), expected);
  stage.restart();
  facilitator = stage.facilitator();
  EXPECT_EQ(comings(), expected);
}

TEST(LiveService, ContinuesWithoutWhoStaysAway) {
  Group group{"dropout = { policy = \"pause-then-continue\", grace_s = 30 }\n"};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  people[2]->disconnect(stage.service());
  people.pop_back();
  pass_with_beats(stage, people, 50);
  ASSERT_TRUE(play(stage, people, solver));
  for (const auto& person : people) EXPECT_EQ(person->stage(), "debrief");
}

TEST(LiveService, SaysNothingUntilItIsSavedAndSavesItWhenTheDiskIsBack) {
  const FaultyDisk disk;
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  const auto step = next_step(people[0]->view(), solver, true);
  FaultyDisk::fail(1, 1'000'000, FaultyDisk::Fault::kFull);
  const auto id = people[0]->ask(stage.service(), step->first, step->second);
  stage.service().settle();
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

TEST(LiveService, LetsNobodyNewInWhenTheDiskIsAlmostFull) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  const auto code = stage.join_code();
  stage.free_bytes = 150'000'000;
  stage.pass_ms(1100);
  for (auto& person : people) person->beat(stage.service());
  const auto warned = Json::parse(stage.get("/api/integrity", stage.facilitator_token()).body);
  EXPECT_EQ(warned["problems"].size(), 1u);
  EXPECT_NE(stage.join(code), "") << "a warning only";
  stage.free_bytes = 40'000'000;
  stage.pass_ms(1100);
  EXPECT_EQ(stage.post("/api/join", {{"code", code}}).status, 503);
  ASSERT_TRUE(play(stage, people, solver)) << "answers are always taken";
}

TEST(LiveService, GivesAPageToWhoFindsNoSeat) {
  const ScratchFolder scratch;
  auto study = small_study();
  Stage stage{scratch / "live", study};
  stage.change_options = [](LiveServiceOptions& options) { options.max_rooms = 1; };
  stage.restart();
  const auto people = three_people(stage);
  const auto reply = stage.post("/api/join", {{"code", stage.join_code()}});
  EXPECT_EQ(reply.status, 200);
  const auto body = Json::parse(reply.body);
  EXPECT_EQ(body["full"]["stage"], "full");
  EXPECT_EQ(stage.post("/api/join", {{"code", "NOSUCH"}}).status, 404);
}

TEST(LiveService, KeepsOfWhoFindsNoSeatOnlyWhatTheStudyCollects) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  stage.change_options = [](LiveServiceOptions& options) { options.max_rooms = 1; };
  stage.restart();
  const auto people = three_people(stage);
  const Json query{{"PROLIFIC_PID", "pid-late"}, {"email", "late@example.org"}};
  const auto reply = stage.post("/api/join", {{"code", stage.join_code()}, {"query", query}});
  ASSERT_TRUE(Json::parse(reply.body).contains("full")) << reply.body;
  stage.stop();
  EXPECT_TRUE(is_stored(stage, "pid-late"));
  EXPECT_FALSE(is_stored(stage, "late@example.org"));
  EXPECT_GT(redact(stage.folder(), std::nullopt, stage.clock().now_us()), 0u);
  EXPECT_FALSE(is_stored(stage, "pid-late"));
}

TEST(LiveService, KeepsNothingAboutWhoDeclines) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  people[0]->ask(stage.service(), "consent", {{"accept", false}, {"version", "1"}});
  people[1]->ask(stage.service(), "consent",
                 {{"accept", true}, {"version", "1"}, {"query", {{"PROLIFIC_PID", "forged"}}}});
  stage.service().settle();
  for (auto& person : people) person->read();
  EXPECT_EQ(people[0]->stage(), "declined");
  EXPECT_EQ(people[1]->stage(), "check");
  stage.stop();
  EXPECT_FALSE(is_stored(stage, "pid-a"));
  EXPECT_TRUE(is_stored(stage, "pid-b"));
  EXPECT_FALSE(is_stored(stage, "pid-c")) << "has not consented yet";
  EXPECT_FALSE(is_stored(stage, "forged"));
}

// A person whose link has a damaged parameter takes part without it.
TEST(LiveService, DropsQueryParametersThatAreNoShortTexts) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study(kQuestions)};
  const auto code = stage.join_code();
  for (const Json& query :
       {Json{{"PROLIFIC_PID", "a\x01"}}, Json{{"PROLIFIC_PID", std::string(201, 'x')}}, Json{{"PROLIFIC_PID", 7}}}) {
    EXPECT_NE(stage.join(code, query), "") << query;
  }
  auto file = stored(stage);
  EXPECT_EQ(file.rooms().size(), 1u);
}

TEST(LiveService, LimitsHowManyJoinFromOneAddress) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  stage.change_options = [](LiveServiceOptions& options) { options.joins_per_minute = 2; };
  stage.restart();
  const auto code = stage.join_code();
  EXPECT_NE(stage.join(code), "");
  EXPECT_NE(stage.join(code), "");
  EXPECT_EQ(stage.post("/api/join", {{"code", code}}).status, 429);
  stage.pass_ms(61'000);
  EXPECT_EQ(stage.post("/api/join", {{"code", code}}).status, 200);
}

TEST(LiveService, ShowsFacilitatorsEverythingAndDoesWhatTheyAsk) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  const auto made = facilitator->ask(
      stage.service(), "room-make",
      {{"strategy", "common"}, {"seats", {"person", "N", "P"}}, {"count", 2}, {"reason", "two groups"}});
  stage.show(*facilitator);
  stage.show(*facilitator);
  EXPECT_THAT(facilitator->acks(), Contains(made)) << facilitator->last_nak();
  const auto rooms = facilitator->view().at("rooms");
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_NE(rooms[0]["code"], rooms[1]["code"]);
  ASSERT_TRUE(rooms[0]["seats"][0].contains("link"));
  EXPECT_EQ(facilitator->view().at("log").back()["what"], "room-make");
  EXPECT_EQ(facilitator->view().at("log").back()["reason"], "two groups");

  // The link of a seat is enough to take it.
  const auto link = rooms[0]["seats"][0]["link"].get<std::string>();
  Page person{link.substr(link.find("#t=") + 3), "linked"};
  person.connect(stage.service());
  stage.service().settle();
  person.read();
  EXPECT_EQ(person.stage(), "consent");

  facilitator->ask(stage.service(), "room-select", {{"room", "r1"}});
  stage.show(*facilitator);
  stage.show(*facilitator);
  EXPECT_EQ(facilitator->view().at("room")["id"], "r1");

  stage.pass_ms(10);  // so that the log tells the order
  facilitator->ask(stage.service(), "message", {{"room", "r1"}, {"text", "Welcome"}, {"reason", "hello"}});
  stage.show(*facilitator);
  person.read();
  ASSERT_EQ(person.view().at("notices").size(), 1u) << facilitator->last_nak();
  EXPECT_EQ(person.view().at("notices")[0]["text"], "Welcome");

  stage.pass_ms(10);
  facilitator->ask(stage.service(), "link-revoke", {{"token", link}, {"reason", "lost"}});
  stage.show(*facilitator);
  person.read();
  EXPECT_EQ(person.bye(), "removed");
  Page again{person.token(), "again"};
  again.connect(stage.service());
  stage.service().settle();
  again.read();
  EXPECT_EQ(again.bye(), "bad-token");

  // The log survives a restart.
  stage.restart();
  facilitator = stage.facilitator();
  std::vector<std::string> what;
  for (const auto& entry : facilitator->view().at("log")) what.push_back(entry["what"]);
  EXPECT_EQ(what, (std::vector<std::string>{"room-make", "joined", "message", "link-revoke"}));
}

TEST(LiveService, ShowsFacilitatorsHowFarAwayPeopleAre) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  auto facilitator = stage.facilitator();
  stage.service().measured(people[1]->connection(), std::chrono::microseconds{12'500});
  people[0]->disconnect(stage.service());  // something new, so that the view is sent
  pass_with_beats(stage, people, 12);
  stage.show(*facilitator);
  const auto& seats = facilitator->view().at("rooms")[0]["seats"];
  EXPECT_FALSE(seats[0].contains("latency_ms"));
  EXPECT_EQ(seats[1]["latency_ms"], 12.5);
  EXPECT_FALSE(seats[2].contains("latency_ms")) << "not measured yet";
}

// The design has groups of three only.
TEST(LiveService, MakesRoomsOfOtherSizesThanTheDesigns) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  const auto made = facilitator->ask(stage.service(), "room-make", {{"seats", {"person", "P"}}, {"count", 1}});
  stage.show(*facilitator);
  EXPECT_THAT(facilitator->acks(), Contains(made)) << facilitator->last_nak();
  const auto& room = facilitator->view().at("rooms")[0];
  EXPECT_EQ(room["strategy"], "common");
  EXPECT_EQ(room["composition"], "NP");
  const auto unknown = facilitator->ask(stage.service(), "room-make", {{"strategy", "comon"}});
  stage.show(*facilitator);
  EXPECT_THAT(facilitator->naks(), Contains(unknown));
  EXPECT_EQ(facilitator->last_nak()["text"], "this study has no strategy 'comon'");
}

TEST(LiveService, ServesWorldsCodesAndTables) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  const auto key = world_key(*stage.study().study, MdpIndex{0});
  EXPECT_EQ(stage.get("/api/world/" + key).status, 401);
  const auto world = stage.get("/api/world/" + key, people[0]->token());
  EXPECT_EQ(world.status, 200);
  EXPECT_EQ(Json::parse(world.body)["key"], key);
  EXPECT_EQ(stage.get("/api/world/none", people[0]->token()).status, 404);
  const auto picture = stage.get("/api/qr?text=http%3A%2F%2Ftest%2Fj%23t%3Dabc", stage.facilitator_token());
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.body.rfind("<svg", 0), 0u);
  const auto tables = stage.get("/api/export?room=r1", stage.facilitator_token());
  EXPECT_EQ(tables.status, 200) << tables.body;
  EXPECT_EQ(tables.body.substr(257, 5), "ustar");
  EXPECT_EQ(stage.get("/api/export?room=r9", stage.facilitator_token()).status, 404);
  EXPECT_EQ(Json::parse(stage.get("/api/texts").body),
            (Json{{"lang", "en"}, {"dir", "ltr"}, {"strings", Json::object()}}));
  EXPECT_EQ(stage.get("/api/health").status, 200);
  EXPECT_EQ(stage.get("/api/nothing").status, 404);
}

TEST(LiveService, RefusesConnectionsThatDoNotSayWhoTheyAre) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  const auto first_frame = [&](const std::string& frame) {
    const auto socket = std::make_shared<testing::FakeSocket>();
    const auto connection = stage.service().open(socket);
    stage.service().receive(connection, frame);
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
