#include "kith/service/lesson_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "kith/core/error.hpp"
#include "kith/live/lesson_log.hpp"
#include "kith/live/room.hpp"
#include "kith/store/session_review.hpp"
#include "store_support.hpp"

namespace kith::testing {
namespace {

constexpr const char* kLesson = R"(schema = "kith.study/1"
id = "lesson"
title = "A lesson"
domain = "item-delivery"
seed = 3
replicates = 2
[design]
strategies = ["joint"]
compositions = ["N"]
[learner.N]
ability = { mean = 0.7, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { half_normal = 0.05 }
[teacher]
particles = 100
[group]
size = 1
)";

SessionStudy lesson_study() {
  const auto reading = parse_study(kLesson, "lesson.toml");
  if (!reading.study) throw std::logic_error{to_text(reading.diagnostics.front())};
  return make_session_study(reading);
}

// What a page does until somebody has watched the first lesson; `more` says whether they also answer, with nothing.
Json log_of(const SessionStudy& session, bool more = false) {
  const auto document = lesson_document(session, "kith test");
  TeachingCache cache{session.study->atlas};
  auto setup = room_setup(document.at("setup"));
  setup.id = "somebody";
  Room room{session.study, setup, cache};
  Json events = Json::array(), lessons = Json::array();
  std::string seal;
  std::int64_t now = 1'000'000;
  const auto happen = [&](const RoomEvent& event) {
    room.apply(event, cache);
    seal = sealed(seal, event);
    events.push_back(to_json(event));
  };
  const auto ask = [&](const std::string& actor, const std::string& type, Json body) {
    now += 1000;
    for (const auto& event : room.decide({actor, type, std::move(body), {}}, now).events) happen(event);
    for (auto due = room.due(now); !due.empty(); due = room.due(now)) {
      for (const auto& event : due) happen(event);
    }
    if (const auto task = room.teaching()) {
      const auto lesson = task->run(cache);
      happen(room.taught(lesson, now));
      lessons.push_back(lesson_content(lesson, room.seq()));
    }
  };
  ask("server", "join", {{"seat", 1}});
  ask("server", "present", {{"seat", 1}});
  ask("seat:1", "consent", {{"accept", true}, {"version", session.study->group().consent_version}});
  ask("seat:1", "checked", Json::object());
  for (std::size_t start = 0; room.stage_of(1) == "watch"; ++start) ask("seat:1", "watched", {{"demo", start}});
  if (more) ask("seat:1", "answer", {{"test", 0}, {"actions", Json::array()}, {"keys", Json::array()}, {"ms", 5}});
  return {{"schema", "kith.lesson-log/1"}, {"kith", "kith test"},     {"study", session.digest},
          {"inputs", session.inputs},      {"setup", to_json(setup)}, {"events", events},
          {"messages", Json::array()},     {"lessons", lessons},      {"seal", seal}};
}

std::string id_of_refusal(const std::filesystem::path& folder, const std::string& text) {
  try {
    (void)import_lesson_log(folder, text, "answers.json", "kith test", 5);
  } catch (const Error& error) {
    return error.diagnostics().empty() ? error.what() : error.diagnostics().front().id;
  }
  return "accepted";
}

TEST(LessonLog, BecomesARoomThatReplays) {
  const ScratchFolder scratch;
  const auto session = lesson_study();
  const auto log = log_of(session);
  const auto imported = import_lesson_log(scratch.path(), log.dump(), "answers.json", "kith test", 5);
  EXPECT_EQ(imported.room, "somebody");
  EXPECT_EQ(imported.events, log.at("events").size());
  auto file = EventFile::read(scratch.path());
  TeachingCache cache{session.study->atlas};
  const auto replayed = replay_room(file, find_room(file, "somebody"), session.study, cache);
  EXPECT_EQ(replayed.problem, "");
  EXPECT_EQ(replayed.events, log.at("events").size());
}

TEST(LessonLog, AddsWhatIsNew) {
  const ScratchFolder scratch;
  const auto session = lesson_study();
  const auto first = log_of(session);
  const auto second = log_of(session, true);
  const auto import = [&](const Json& log) {
    return import_lesson_log(scratch.path(), log.dump(), "answers.json", "kith test", 5).events;
  };
  EXPECT_EQ(import(first), first.at("events").size());
  EXPECT_EQ(import(first), 0u);
  EXPECT_EQ(import(second), second.at("events").size() - first.at("events").size());
  EXPECT_EQ(import(first), 0u);
}

TEST(LessonLog, ThatWentAnotherWayIsRefused) {
  const ScratchFolder scratch;
  const auto session = lesson_study();
  (void)import_lesson_log(scratch.path(), log_of(session).dump(), "answers.json", "kith test", 5);
  auto other = log_of(session);
  auto& events = other.at("events");
  events.erase(events.begin() + 3, events.end());
  other["lessons"] = Json::array();
  events.back()["at_us"] = events.back()["at_us"].get<std::int64_t>() + 1;
  std::string seal;
  for (const auto& event : events) seal = sealed(seal, room_event(event));
  other["seal"] = seal;
  EXPECT_EQ(id_of_refusal(scratch.path(), other.dump()), "E1623");
}

TEST(LessonLog, UnderAnotherNameIsNotAnotherPerson) {
  const ScratchFolder scratch;
  const auto session = lesson_study();
  (void)import_lesson_log(scratch.path(), log_of(session).dump(), "answers.json", "kith test", 5);
  for (const bool more : {false, true}) {
    auto copy = log_of(session, more);
    copy["setup"]["id"] = "somebody-else";
    EXPECT_EQ(id_of_refusal(scratch.path(), copy.dump()), "E1623");
  }
}

TEST(LessonLog, ThatWasChangedIsRefused) {
  const ScratchFolder scratch;
  const auto text = log_of(lesson_study()).dump();
  EXPECT_EQ(id_of_refusal(scratch.path(), text.substr(0, text.size() / 2)), "E1621");
  EXPECT_EQ(id_of_refusal(scratch.path(), "{}"), "E1621");
  EXPECT_EQ(id_of_refusal(scratch.path(), R"({"schema": "kith.lesson-log/1"})"), "E1621");
  auto log = Json::parse(text);
  log["events"].erase(log["events"].size() - 1);
  EXPECT_EQ(id_of_refusal(scratch.path(), log.dump()), "E1622");
  log = Json::parse(text);
  const auto lesson = log["lessons"].front();
  log["lessons"].push_back(lesson);
  EXPECT_EQ(id_of_refusal(scratch.path(), log.dump()), "E1621");
  log["lessons"].back()["seq"] = 1;
  EXPECT_EQ(id_of_refusal(scratch.path(), log.dump()), "E1622");
  log = Json::parse(text);
  log["inputs"]["study.toml"] = log["inputs"]["study.toml"].get<std::string>() + "# more\n";
  EXPECT_EQ(id_of_refusal(scratch.path(), log.dump()), "E1622");
}

// What goes wrong with files: a byte is another one, a piece is missing, is there twice, or stands elsewhere.
std::string damaged(std::string text, std::size_t begin, std::mt19937& random) {
  const auto at = begin + random() % (text.size() - begin);
  const auto size = 1 + random() % 40;
  const auto piece = text.substr(at, size);
  switch (random() % 5) {
    case 0:
      return text.substr(0, at);
    case 1:
      return text.erase(at, size);
    case 2:
      return text.insert(at, piece);
    case 3:
      return text.erase(at, size).insert(begin + random() % (text.size() - begin), piece);
    default:
      text[at] = static_cast<char>(32 + random() % 95);
      return text;
  }
}

// A damaged log is refused, or says the same in another way.
void expect_to_survive(int times) {
  const auto text = log_of(lesson_study(), true).dump();
  const auto log = Json::parse(text);
  std::mt19937 random{7};
  int refused = 0;
  for (int i = 0; i < times; ++i) {
    const ScratchFolder scratch;
    const auto changed = damaged(text, i % 4 == 0 ? 0 : text.find("\"events\""), random);
    const auto id = id_of_refusal(scratch.path(), changed);
    refused += id == "accepted" ? 0 : 1;
    if (id != "accepted") continue;
    const auto accepted = Json::parse(changed);
    for (const auto* key : {"lessons", "inputs", "seal"}) EXPECT_EQ(accepted.at(key), log.at(key)) << i;
    // Members that no event has are passed over.
    ASSERT_EQ(accepted.at("events").size(), log.at("events").size()) << i;
    for (std::size_t e = 0; e < log.at("events").size(); ++e) {
      EXPECT_TRUE(room_event(accepted.at("events")[e]) == room_event(log.at("events")[e])) << i << ": event " << e;
    }
  }
  EXPECT_GT(refused, times / 2);
}

TEST(LessonLog, SurvivesDamage) { expect_to_survive(60); }
TEST(LessonLogSlow, SurvivesDamage) { expect_to_survive(2000); }

TEST(LessonDocument, IsForOnePerson) {
  const auto document = lesson_document(lesson_study(), "kith test");
  EXPECT_EQ(document.at("schema"), "kith.lesson/1");
  EXPECT_EQ(document.at("setup").at("composition"), "N");
  EXPECT_EQ(document.at("setup").at("strategy"), "joint");
}

}  // namespace
}  // namespace kith::testing
