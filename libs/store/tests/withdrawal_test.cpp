// Whoever withdraws is in no table, and the session replays without them.

#include <gtest/gtest.h>

#include "../../live/tests/live_play.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/store/session_export.hpp"
#include "kith/store/session_review.hpp"
#include "kith/store/session_study.hpp"
#include "store_support.hpp"

namespace kith::testing {
namespace {

namespace fs = std::filesystem;
using Row = std::map<std::string, std::string>;
using Seats = std::set<std::pair<std::string, std::string>>;  // with their rooms

// Rooms that were played by people with ids of a platform, such as "pid-ann".
struct Played {
  explicit Played(const std::string& group)
      : study{make_session_study(parse_study(kLiveStudy + "[group]\ncollect_query = [\"PID\"]\n" + group, "live"))} {}

  // Without a composition, a waiting list.
  Play& room(const std::string& composition) {
    auto setup = waiting_list_setup();
    setup.id = "r" + std::to_string(rooms.size() + 1);
    setup.is_waiting_list = composition.empty();
    if (!composition.empty()) std::tie(setup.strategy, setup.composition) = std::pair{"common", composition};
    return *rooms.emplace_back(std::make_unique<Play>(study.study, setup));
  }
  // In a new folder.
  [[nodiscard]] fs::path store() {
    const auto folder = scratch / std::to_string(++num_stored);
    fs::create_directories(folder);
    auto batch = batch_of(others);
    for (const auto& room : rooms) {
      const auto number = static_cast<std::int64_t>(batch.rooms.size() + 1);
      batch.rooms.push_back({number, to_json(room->room().setup()).dump(), kSomeTime});
      for (const auto& event : room->events()) {
        batch.events.push_back(
            {number, event.seq, event.at_us, event.actor, std::string{event.kind().word}, body_of(event).dump(), {}});
      }
    }
    EventFile::open(folder, {study.digest, "kith test", study.inputs}, kSomeTime).write({&batch, 1});
    return folder;
  }

  SessionStudy study;
  std::vector<std::unique_ptr<Play>> rooms;
  std::vector<StoredEvent> others;
  ScratchFolder scratch;
  std::size_t num_stored = 0;
};

// Every room is replayed for the tables.
std::map<std::string, std::vector<Row>> exported(const Played& played, const fs::path& folder) {
  auto file = EventFile::read(folder);
  TeachingCache cache{played.study.study->atlas};
  std::map<std::string, std::string> texts;
  export_session(file, played.study.study, cache, {.with_names = true},
                 [&](std::string_view name, std::string_view piece) { texts[std::string{name}] += piece; });
  std::map<std::string, std::vector<Row>> tables;
  for (const auto& [name, text] : texts) {
    if (fs::path{name}.extension() != ".csv") continue;
    const auto columns = read_csv_header(text, name);
    static_cast<void>(read_csv(text, name, columns, [&rows = tables[name], &columns](const CsvRow& row) {
      auto& values = rows.emplace_back();
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const auto* cell = std::get_if<std::string>(&row.cells[c]);
        values[columns[c].name] = cell == nullptr ? "" : *cell;
      }
    }));
  }
  return tables;
}

// Whether a row is of or about one of these seats.
bool mentions(Row row, const Seats& seats) {
  const auto body = row["body"].empty() ? Json::object() : Json::parse(row["body"]);
  auto named = body.value("seats", Json::array());
  named.push_back(body.value("seat", Json{}));
  const auto is_theirs = [&](const std::string& seat) { return seats.count({row["session"], seat}) != 0; };
  if (row.count("belief") != 0) row["seat"] = row["member"];  // of these rooms they are the same
  return is_theirs(row["seat"]) || seats.count({row["group"], row["user_id"]}) != 0 ||
         is_theirs(row["actor"].substr(row["actor"].find(':') + 1)) ||
         std::any_of(named.begin(), named.end(), [&](const Json& seat) { return is_theirs(seat.dump()); });
}

// Payments have the codes that people were told. Everybody withdraws, each from a session of their own.
void expect_codes_and_withdrawals(Played& played) {
  auto all = exported(played, played.store());
  std::map<std::string, Seats> people;
  for (auto& row : all["participants.csv"]) {
    if (row["session"].empty()) continue;
    if (!row["query"].empty()) people[Json::parse(row["query"])["PID"]].emplace(row["session"], row["seat"]);
    const auto shown = page(*played.rooms.at(std::stoul(row["session"].substr(1)) - 1), std::stoul(row["seat"]));
    const auto last = shown.contains("debrief") ? shown["debrief"] : shown.value("end", Json::object());
    EXPECT_EQ(row["code"], last.value("code", "")) << row["session"] << " " << row["seat"];
  }
  for (const auto& [id, seats] : people) {
    for (const auto& [room, seat] : seats) {
      const auto folder = played.store();
      withdraw(folder, room, std::stoul(seat), kSomeTime);
      for (const auto& one : fs::directory_iterator{folder}) EXPECT_EQ(read_file(one).find(id), std::string::npos);
      const auto has_gone = [&id = id, &seats = seats](Row row) {
        return mentions(row, seats) || row["query"].find(id) != std::string::npos;
      };
      auto after = exported(played, folder);
      for (auto& row : after["sessions.csv"]) {
        const auto is_here = [&](const auto& one) { return one.first == row["session"]; };
        EXPECT_EQ(row["withdrawn"], std::to_string(std::count_if(seats.begin(), seats.end(), is_here))) << id;
      }
      for (auto& [name, rows] : after) {
        EXPECT_TRUE(std::none_of(rows.begin(), rows.end(), has_gone)) << id << ": " << name;
        auto left = all[name];
        if (left.empty() || left.front().count("seat") == 0) continue;
        std::erase_if(left, has_gone);
        EXPECT_EQ(rows, left) << id << ": " << name;
      }
    }
  }
}

// They join and consent, one after the other.
void come(Play& play, const std::vector<std::string>& names) {
  for (const auto& name : names) {
    play.join(1);
    const Json body{{"accept", true}, {"version", "1"}, {"query", {{"PID", "pid-" + name}}}};
    EXPECT_EQ(play.seat(play.events().back().get<happening::Joined>()->seat, "consent", body), "");
  }
}

TEST(Withdrawal, LeavesAWaitingListAndItsGroup) {
  Played played{"size = 2\nscreening = { tests = 1, cut = 0.6, high = \"P\" }\n"};
  auto& list = played.room("");
  come(list, {"bob", "ann", "eve"});
  for (const auto seat : {1u, 2u, 3u}) EXPECT_EQ(list.seat(seat, "checked"), "");
  for (const auto seat : {2u, 1u}) {  // whoever came second is ready first
    list.pass(50);
    EXPECT_EQ(list.seat(seat, "screen", {{"test", 0}, {"actions", Json::array()}, {"ms", 5}}), "");
  }
  const auto group = list.room().next_group(list.now()).value();
  ASSERT_EQ(group.seats, (std::vector<std::optional<std::size_t>>{2, 1}));
  auto body = to_json(group);
  body["room"] = "r2";
  auto& taught = played.room(group.cell.composition);
  taught.pass(100);
  for (const auto m : {0u, 1u}) {
    auto person = list.room().person_for(*group.seats[m]);
    person["member"] = m;
    EXPECT_EQ(taught.send("server", "seat", person), "");
  }
  EXPECT_EQ(list.send("server", "group", body), "");
  taught.play_on({1, 2});
  expect_codes_and_withdrawals(played);
}

// Boards of the exam that were answered rightly keep it going, so that somebody can leave it.
TEST(Withdrawal, LeavesAnExam) {
  Played played{"exam = true\n"};
  auto& room = played.room("NN");
  come(room, {"ann", "bob"});
  for (const auto seat : {1u, 2u}) EXPECT_EQ(room.seat(seat, "checked"), "");
  room.play_on({1, 2});
  for (std::size_t test = 0; test < 3; ++test) {
    for (const auto seat : {1u, 2u}) {
      Json body{{"test", test}, {"actions", Json::array()}, {"ms", 5}};
      const auto asked = room.room().decide({seat_actor(seat), "examine", body, {}}, room.now());
      ASSERT_FALSE(asked.events.empty()) << test;
      body["actions"] = room.right_path(StartIndex{asked.events.front().get<happening::Examined>()->start});
      EXPECT_EQ(room.seat(seat, "examine", body), "");
    }
  }
  EXPECT_EQ(room.seat(1, "leave"), "");
  EXPECT_EQ(room.send("server", "away", {{"seat", 2}}), "");
  room.wait(200);
  EXPECT_EQ(room.room().status_of(2), "dropped");
  expect_codes_and_withdrawals(played);
}

TEST(Withdrawal, LeavesFormerSeatsAndThoseWhoWereTurnedAway) {
  Played played{"ask_name = true\n"};
  for (const std::uint64_t seq : {1u, 2u}) {
    const Json body{{"code", "CODE"}, {"query", {{"PID", seq == 1 ? "pid-eve" : "pid-ann"}}}};
    played.others.push_back({0, seq, kSomeTime, "server", "turned-away", body.dump(), {}});
  }
  auto& room = played.room("NNN");
  come(room, {"ann", "bob", "cid"});
  EXPECT_EQ(room.seat(2, "checked"), "");
  EXPECT_EQ(room.seat(3, "leave"), "");  // before being ready: there is no code
  EXPECT_EQ(room.send("server", "away", {{"seat", 1}}), "");
  room.wait(100);
  ASSERT_EQ(room.room().stage_of(1), "replaced");
  come(room, {"ann", "dan"});
  EXPECT_EQ(room.seat(4, "checked"), "");
  EXPECT_EQ(room.send("facilitator", "start", {{"reason", "Anna Schmidt waits"}}), "");
  EXPECT_EQ(room.room().stage_of(5), "full");
  EXPECT_EQ(room.send("facilitator", "end", {{"reason", "Anna Schmidt went home"}}), "");
  expect_codes_and_withdrawals(played);

  const auto folder = played.store();
  auto tables = exported(played, folder);
  for (auto& row : tables["events.csv"]) EXPECT_EQ(row["body"].find("Schmidt"), std::string::npos);
  EXPECT_EQ(tables["sessions.csv"].at(0)["ended"], "facilitator");
  for (const auto left : {2, 1}) {  // of those who found no seat
    const auto rows = exported(played, folder)["participants.csv"];
    EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.at("code") == "CODE"; }), left);
    withdraw(folder, "r1", 1, kSomeTime);
  }
}

TEST(Withdrawal, ErasesNothingOfARoomThatDoesNotReplay) {
  Played played{""};
  played.room("NN").join(2);
  played.others.push_back({1, 3, kSomeTime, "seat:1", "left", R"({"by":9,"type":null})", {}});
  const auto folder = played.store();
  const auto before = read_file(folder / kEventFile);
  EXPECT_EQ(id_of_error([&] { withdraw(folder, "r1", 2, kSomeTime); }), "E1614");
  EXPECT_EQ(read_file(folder / kEventFile), before);
}

}  // namespace
}  // namespace kith::testing
