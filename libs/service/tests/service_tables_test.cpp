// Tables of sessions that the service taught.
#include "kith/service/live_service.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "kith/core/error.hpp"
#include "kith/store/session_review.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using testing::exported;
using testing::Group;
using testing::play;
using testing::play_until;
using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;
using testing::stored;

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

// What was recorded when other people took seats over.
TEST(LiveService, SaysWhatReadsASessionOfAnEarlierPolicy) {
  auto inputs = small_study().inputs;
  auto& text = inputs.at("study.toml");
  const std::string policy = "pause-then-continue";
  text.replace(text.find(policy), policy.size(), "replace-from-pool");
  try {
    static_cast<void>(restore_session_study(inputs));
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string{error.what()}.find("are read by the kith that recorded them"), std::string::npos);
  }
}

// One person of three is ready when the time in the lobby is over.
TEST(LiveService, ExportsStandInsForPeopleWhoDidNotCome) {
  Group group{"dropout = { policy = \"simulate\" }\ntime = { lobby_s = 60 }\n"};
  auto& [scratch, stage, solver, people] = group;
  for (const char* type : {"consent", "checked"}) {
    people[0]->ask(stage.service(), type, {{"accept", true}, {"version", "1"}});
    stage.service().settle();
  }
  group.pass(62);
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

  // Both tables say the same of everybody, stand-ins, too.
  const auto column = [](const std::string& table, const std::string& name) {
    std::istringstream lines{table};
    std::vector<std::string> cells;
    std::optional<std::size_t> place;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream parts{line};
      std::vector<std::string> row;
      for (std::string part; std::getline(parts, part, ',');) row.push_back(part);
      if (place) cells.push_back(row.at(*place));
      if (!place) place = static_cast<std::size_t>(std::find(row.begin(), row.end(), name) - row.begin());
    }
    return cells;
  };
  const auto answered = column(tables.at("tests.csv"), "seat"), correct = column(tables.at("tests.csv"), "correct");
  const auto seats = column(tables.at("participants.csv"), "seat"),
             right = column(tables.at("participants.csv"), "right"),
             tests = column(tables.at("participants.csv"), "tests");
  for (std::size_t i = 0; i < seats.size(); ++i) {
    std::size_t num_tests = 0, num_right = 0;
    for (std::size_t k = 0; k < answered.size(); ++k) {
      if (answered[k] != seats[i]) continue;
      ++num_tests;
      num_right += correct[k] == "true" ? 1u : 0u;
    }
    EXPECT_EQ(tests[i], std::to_string(num_tests)) << "seat " << seats[i];
    EXPECT_EQ(right[i], std::to_string(num_right)) << "seat " << seats[i];
  }
  EXPECT_NE(tests[3], "0");
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

}  // namespace
}  // namespace kith
