// The waiting list: who is seated with whom, and what becomes of those for whom there is no group.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "live_play.hpp"

namespace kith::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Seats = std::vector<std::optional<std::size_t>>;

// Compositions NNP and NNN; somebody who answers both tests rightly is for the place of P.
std::shared_ptr<const LiveStudy> screened_study(const std::string& more = {}) {
  return live_study("[group]\nsize = 3\nscreening = { tests = 2, cut = 0.6, high = \"P\" }\n" + more);
}

class WaitingList : public ::testing::Test {
 protected:
  explicit WaitingList(std::shared_ptr<const LiveStudy> study = screened_study())
      : play_{std::move(study), waiting_list_setup()} {}

  // Somebody comes, is screened and waits. @return the number of the seat.
  static std::size_t come(Play& play, bool is_able) {
    EXPECT_EQ(play.send("server", "join"), "");
    const auto seat = play.room().num_seats();
    play.get_ready(seat, is_able);
    EXPECT_EQ(play.room().stage_of(seat), "lobby");
    play.pass(1.0);
    return seat;
  }
  std::size_t able() { return come(play_, true); }
  std::size_t novice() { return come(play_, false); }

  static Json command_of(const PlannedGroup& group, const std::string& room) {
    auto body = to_json(group);
    body["room"] = room;
    return body;
  }
  // The group that can be formed now is formed. @return it; nothing if there is none.
  static std::optional<PlannedGroup> form(Play& play) {
    const auto group = play.room().next_group(play.now());
    if (group) {
      EXPECT_EQ(play.send("server", "group", command_of(*group, "r2")), "");
    }
    return group;
  }
  std::optional<PlannedGroup> form() { return form(play_); }

  Play play_;
};

TEST_F(WaitingList, FormsAGroupOnceSomebodyFitsEveryPlace) {
  const auto p = able();
  const auto a = novice();
  EXPECT_EQ(form(), std::nullopt);
  const auto b = novice();
  const auto group = form();
  ASSERT_TRUE(group);
  EXPECT_EQ(group->cell, (LiveCell{"common", "NNP"}));
  EXPECT_EQ(group->seats, (Seats{a, b, p}));
  EXPECT_THAT(group->simulated, ElementsAre(false, false, false));
  for (const auto seat : {p, a, b}) EXPECT_TRUE(play_.room().is_done(seat));
  EXPECT_EQ(form(), std::nullopt);
  play_.expect_replay();
}

TEST_F(WaitingList, SeatsThoseWhoHaveWaitedForLongest) {
  const auto first = able();
  const auto second = able();
  const auto a = novice();
  const auto b = novice();
  const auto c = novice();
  EXPECT_EQ(form()->seats, (Seats{a, b, first}));
  const auto d = novice();
  EXPECT_EQ(form()->seats, (Seats{c, d, second}));
}

TEST_F(WaitingList, SeatsNobodyWhoIsAway) {
  const auto p = able();
  const auto a = novice();
  EXPECT_EQ(play_.send("server", "away", {{"seat", p}}), "");
  const auto b = novice();
  EXPECT_EQ(form(), std::nullopt);
  EXPECT_EQ(play_.send("server", "present", {{"seat", p}}), "");
  EXPECT_EQ(form()->seats, (Seats{a, b, p}));
}

TEST_F(WaitingList, KeepsTheNumbersOfGroupsBalanced) {
  for (const auto* strategy : {"common", "joint", "individual-low"}) {
    for (int i = 0; i < 3; ++i) novice();
    EXPECT_EQ(form()->cell, (LiveCell{strategy, "NNN"}));
  }
  for (int i = 0; i < 3; ++i) novice();
  EXPECT_EQ(form(), std::nullopt) << "the turn of NNP";
  able();
  EXPECT_EQ(form()->cell, (LiveCell{"common", "NNP"}));
}

TEST_F(WaitingList, FormsAnyGroupForSomebodyWhoHasWaitedForTooLong) {
  for (int group = 0; group < 3; ++group) {
    for (int i = 0; i < 3; ++i) novice();
    ASSERT_TRUE(form());
  }
  const auto a = novice(), b = novice(), c = novice();
  play_.wait(1196);
  EXPECT_EQ(form(), std::nullopt);
  EXPECT_EQ(play_.room().last_call(), play_.now() + 1'000'000);
  play_.pass(2);
  EXPECT_EQ(form()->seats, (Seats{a, b, c}));
  play_.expect_replay();
}

TEST_F(WaitingList, SendsThoseHomeForWhomThereIsNoGroupInTime) {
  const auto p = able();
  const auto a = novice();
  play_.wait(1197);
  EXPECT_EQ(play_.room().stage_of(p), "lobby");
  play_.wait(1.5);
  EXPECT_EQ(play_.room().stage_of(p), "ended");
  EXPECT_EQ(play_.room().stage_of(a), "lobby") << "came a second later";
  play_.wait(1);
  EXPECT_EQ(play_.room().stage_of(a), "ended");
  const auto view = play_.room().view({Viewer::Role::kParticipant, p}, play_.now());
  EXPECT_EQ(view["end"]["reason"], "lobby-time");
  EXPECT_EQ(view["end"]["text"], "Not enough people came in time.");
  EXPECT_TRUE(view["end"].contains("code"));
  play_.expect_replay();
}

// If rooms cannot be made, for instance because the disk is full, nobody waits for ever.
TEST_F(WaitingList, EndsTheWaitAlsoIfTheGroupCannotBeMade) {
  for (int group = 0; group < 3; ++group) {
    for (int i = 0; i < 3; ++i) novice();
    ASSERT_TRUE(form());
  }
  const auto a = novice();
  novice();
  novice();
  play_.wait(1300);
  EXPECT_EQ(play_.room().stage_of(a), "lobby");
  play_.wait(1200);
  EXPECT_EQ(play_.room().stage_of(a), "ended");
}

TEST_F(WaitingList, ReleasesSeatsOfPeopleWhoGoAwayOrDoNotGetReady) {
  const auto p = able();
  ASSERT_EQ(play_.send("server", "join"), "");
  const auto slow = play_.room().num_seats();
  ASSERT_EQ(play_.send("server", "away", {{"seat", p}}), "");
  play_.wait(91);
  EXPECT_EQ(play_.room().stage_of(p), "replaced");
  play_.wait(1200);
  EXPECT_EQ(play_.room().stage_of(slow), "ended");
  play_.expect_replay();
}

TEST_F(WaitingList, LetsPeopleLeaveWithACodeAfterAWhile) {
  const auto a = novice(), b = novice();
  ASSERT_EQ(play_.seat(a, "leave"), "");
  play_.wait(301);
  ASSERT_EQ(play_.seat(b, "leave"), "");
  const auto end = [&](std::size_t seat) {
    return play_.room().view({Viewer::Role::kParticipant, seat}, play_.now())["end"];
  };
  EXPECT_FALSE(end(a).contains("code"));
  EXPECT_TRUE(end(b).contains("code"));
}

TEST_F(WaitingList, FillsUpWithSimulatedLearnersInTheEndIfTheStudySaysSo) {
  Play play{screened_study("dropout = { policy = \"simulate\" }\n"), waiting_list_setup()};
  const auto p = come(play, true);
  play.wait(1198);
  EXPECT_EQ(form(play), std::nullopt);
  play.pass(2);
  const auto group = form(play);
  ASSERT_TRUE(group);
  EXPECT_EQ(group->cell, (LiveCell{"common", "NNP"}));
  EXPECT_EQ(group->seats, (Seats{std::nullopt, std::nullopt, p}));
  EXPECT_THAT(group->simulated, ElementsAre(true, true, false));
  play.expect_replay();
}

TEST_F(WaitingList, WaitsWithoutLimitForAFacilitatorWhoStartsTheGroups) {
  Play play{screened_study("auto_start = false\n"), waiting_list_setup()};
  for (int i = 0; i < 6; ++i) come(play, false);
  ASSERT_TRUE(form(play));
  ASSERT_TRUE(form(play)) << "balanced or not: nothing else would end the wait";
  const auto p = come(play, true);
  play.wait(100'000);
  EXPECT_EQ(play.room().stage_of(p), "lobby");
}

TEST_F(WaitingList, LeavesPlacesOfSimulatedMembersToThem) {
  Play play{screened_study("people = [2, 3]\n"), waiting_list_setup()};
  const auto p = come(play, true);
  const auto a = come(play, false);
  const auto group = form(play);
  ASSERT_TRUE(group);
  EXPECT_EQ(group->seats, (Seats{std::nullopt, a, p}));
  EXPECT_THAT(group->simulated, ElementsAre(true, false, false));
}

TEST_F(WaitingList, RefusesAGroupThatIsNotTheOnePlanned) {
  able();
  novice();
  novice();
  const auto body = command_of(*play_.room().next_group(play_.now()), "r2");
  auto other = body;
  std::swap(other["seats"][0], other["seats"][2]);
  EXPECT_EQ(play_.send("server", "group", other), "not-now");
  other = body;
  other["strategy"] = "joint";
  EXPECT_EQ(play_.send("server", "group", other), "not-now");
  other = body;
  other.erase("room");
  EXPECT_EQ(play_.send("server", "group", other), "not-now");
  EXPECT_EQ(play_.send("facilitator", "group", body), "unknown-type");
  // Nor does an event like this fit.
  auto events = play_.events();
  other = body;
  std::swap(other["seats"][0], other["seats"][2]);
  events.push_back(room_event(play_.room().seq() + 1, play_.now(), "server", "grouped", other));
  EXPECT_THROW((void)replay(screened_study(), waiting_list_setup(), events, play_.cache()), Error);
}

// From one page somebody could conclude how able others take them to be.
TEST_F(WaitingList, ShowsEverybodyTheSame) {
  const auto p = able(), a = novice();
  const auto page = [&](std::size_t seat) {
    auto view = play_.room().view({Viewer::Role::kParticipant, seat}, play_.now());
    view["me"].erase("seat");
    for (const auto* time : {"since_ms", "leave_after_ms", "until_ms"}) view["lobby"].erase(time);
    return view;
  };
  EXPECT_EQ(page(p), page(a));
  EXPECT_EQ(page(p)["lobby"]["present"], 2);
  EXPECT_EQ(page(p)["lobby"]["size"], 3);
}

TEST_F(WaitingList, ShowsFacilitatorsWhoWaitsWithTheirEstimates) {
  const auto p = able(), a = novice(), b = novice();
  const auto row = [&] { return play_.room().row({Viewer::Role::kFacilitator, 0}); };
  EXPECT_EQ(row()["waiting_list"], true);
  EXPECT_EQ(row()["strategy"], "waiting list");
  ASSERT_EQ(row()["seats"].size(), 3u);
  EXPECT_EQ(row()["seats"][p - 1]["estimate"], 0.75);
  EXPECT_EQ(row()["seats"][p - 1]["estimate_is_high"], true);
  EXPECT_EQ(row()["seats"][a - 1]["estimate_is_high"], false);
  ASSERT_EQ(play_.room().view({Viewer::Role::kFacilitator, 0}, play_.now())["room"]["beliefs"], Json::array());
  ASSERT_TRUE(form());
  EXPECT_EQ(row()["seats"], Json::array()) << b;
}

TEST_F(WaitingList, IsEndedByFacilitatorsAndNothingElse) {
  const auto p = able();
  for (const auto* type : {"start", "pause", "resume", "strategy", "simulate", "readmit", "extend"}) {
    EXPECT_EQ(play_.facilitator(type, {{"seat", p}, {"name", "joint"}, {"seconds", 5}}), "not-now") << type;
  }
  EXPECT_EQ(play_.facilitator("message", {{"text", "Almost there."}}), "");
  EXPECT_EQ(play_.facilitator("end"), "");
  EXPECT_EQ(play_.room().stage_of(p), "ended");
  EXPECT_FALSE(play_.room().has_free_seat());
  play_.expect_replay();
}

TEST_F(WaitingList, HandsPeopleOverToTheirRoom) {
  const auto study = screened_study("ask_name = true\ncollect_query = [\"PID\"]\n");
  Play list{study, waiting_list_setup()};
  const auto p = come(list, true), a = come(list, false), b = come(list, false);
  ASSERT_EQ(list.seat(p, "name", {{"name", "Ada"}}), "");
  const auto group = list.room().next_group(list.now());
  ASSERT_TRUE(group);
  Play room{study, RoomSetup{.id = "r2",
                             .code = "DEF",
                             .strategy = group->cell.strategy,
                             .composition = group->cell.composition,
                             .simulated = group->simulated,
                             .salt = "salt"}};
  room.pass(static_cast<double>(list.now() - room.now()) / 1e6);
  for (std::size_t m = 0; m < 3; ++m) {
    auto body = list.room().person_for(*group->seats[m]);
    body["member"] = m;
    if (m == 2) body["query"] = {{"PID", "77"}, {"other", "x"}};
    ASSERT_EQ(room.send("server", "seat", body), "");
    EXPECT_NE(room.send("server", "seat", body), "") << "the place is taken";
  }
  EXPECT_EQ(room.room().stage_of(1), "watch") << "everybody is ready";
  const auto row = room.room().row({Viewer::Role::kFacilitator, 0});
  EXPECT_EQ(row["seats"][2]["name"], "Ada");
  EXPECT_EQ(row["seats"][2]["estimate"], 0.75);
  EXPECT_EQ(row["seats"][0]["estimate_is_high"], false);
  EXPECT_EQ(body_of(room.events()[2])["query"], (Json{{"PID", "77"}}));
  EXPECT_EQ(body_of(room.events()[0])["from"], (Json{{"room", "r1"}, {"seat", a}})) << b;
  room.play_on({1, 2, 3});
  EXPECT_EQ(room.room().stage_of(3), "debrief");
  room.expect_replay();
}

TEST_F(WaitingList, RefusesToSeatWhoIsNoPersonOfAList) {
  Play room{screened_study()};
  const Json good{{"member", 0},     {"from", {{"room", "r1"}, {"seat", 1}}},
                  {"version", "1"},  {"query", Json::object()},
                  {"name", ""},      {"screened", {true, false}},
                  {"ready_us", 1000}};
  for (const auto* key : {"member", "from", "version", "name", "screened", "ready_us"}) {
    auto body = good;
    body.erase(key);
    EXPECT_EQ(room.send("server", "seat", body), "bad-body") << key;
  }
  auto body = good;
  body["member"] = 3;
  EXPECT_EQ(room.send("server", "seat", body), "bad-body");
  body = good;
  body["screened"] = {true};
  EXPECT_EQ(room.send("server", "seat", body), "bad-body");
  EXPECT_EQ(play_.send("server", "seat", good), "started") << "on the list itself";
  EXPECT_EQ(room.send("server", "seat", good), "");
}

// People come, go away, return and leave at random: everybody who waits is seated where they fit, once, or sent home.
TEST_F(WaitingList, SeatsEverybodyOnceOrSendsThemHome) {
  for (const bool fills_up : {false, true}) {
    const auto study = screened_study(fills_up ? "dropout = { policy = \"simulate\" }\ntime = { lobby_s = 300 }\n"
                                               : "time = { lobby_s = 300 }\n");
    for (std::uint64_t round = 0; round < 6; ++round) {
      auto random = RandomStream{71}.split(round);
      Play play{study, waiting_list_setup()};
      std::map<std::size_t, bool> able;
      std::map<std::size_t, std::size_t> seated;
      const auto form_all = [&] {
        while (const auto group = form(play)) {
          for (std::size_t m = 0; m < group->seats.size(); ++m) {
            EXPECT_EQ(group->seats[m].has_value(), !group->simulated[m]);
            if (!group->seats[m]) continue;
            ++seated[*group->seats[m]];
            EXPECT_EQ(able.at(*group->seats[m]), group->cell.composition[m] == 'P');
          }
        }
      };
      for (int step = 0; step < 60; ++step) {
        const auto what = uniform_index(6, random);
        const auto seat = play.room().num_seats() == 0 ? 0 : 1 + uniform_index(play.room().num_seats(), random);
        if (what < 3) {
          const bool is_able = uniform_index(3, random) == 0;
          able[come(play, is_able)] = is_able;
        } else if (what == 3 && seat > 0) {
          (void)play.send("server", uniform_index(2, random) == 0 ? "away" : "present", {{"seat", seat}});
        } else if (what == 4 && seat > 0) {
          (void)play.seat(seat, "leave");
        } else {
          play.wait(static_cast<double>(uniform_index(40, random)));
        }
        form_all();
      }
      for (int minute = 0; minute < 12; ++minute) {
        play.wait(60);
        form_all();
      }
      for (const auto& [seat, count] : seated) EXPECT_EQ(count, 1u) << seat;
      for (const auto& [seat, is_able] : able) {
        EXPECT_TRUE(play.room().is_done(seat)) << seat << play.room().stage_of(seat);
        EXPECT_EQ(play.room().stage_of(seat) == "moved", seated.count(seat) == 1) << seat;
      }
      play.expect_replay();
    }
  }
}

TEST(LiveStudyOfPeople, NeedsAPlaceForEverybodyWhoIsScreened) {
  const std::string screening = "[group]\nscreening = { tests = 2, high = \"";
  EXPECT_THROW((void)live_study(screening + "NP\" }\n"), Error);
  try {
    (void)live_study(screening + "P\" }\npeople = [1, 2]\n");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("people whose estimate of ability is high would wait for nothing"));
  }
  EXPECT_FALSE(live_study("[group]\nscreening = { tests = 2 }\n")->seats_by_ability());
  EXPECT_TRUE(screened_study()->seats_by_ability());
}

}  // namespace
}  // namespace kith::testing
