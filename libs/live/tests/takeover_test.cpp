// Somebody from the waiting list takes over the place of somebody who drops out of a group that has begun.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/core/error.hpp"
#include "live_play.hpp"

namespace kith::testing {
namespace {

using ::testing::ElementsAre;

std::shared_ptr<const LiveStudy> pooled_study(const std::string& dropout = {}, const std::string& more = {}) {
  return live_study(
      "[group]\nsize = 3\nscreening = { tests = 2, cut = 0.6, high = \"P\" }\n"
      "dropout = { policy = \"replace-from-pool\", grace_s = 20" +
      dropout + " }\n" + more);
}

// A group of three, and people who wait.
class Takeover : public ::testing::Test {
 protected:
  explicit Takeover(std::shared_ptr<const LiveStudy> study = pooled_study())
      : list_{study, waiting_list_setup()}, group_{std::move(study)} {}

  std::size_t come(bool is_able) {
    EXPECT_EQ(list_.send("server", "join"), "");
    const auto seat = list_.room().num_seats();
    EXPECT_EQ(list_.seat(seat, "consent", {{"accept", true}, {"version", "1"}}), "");
    EXPECT_EQ(list_.seat(seat, "checked"), "");
    for (std::size_t t = 0; t < 2; ++t) {
      const auto path = is_able ? list_.right_path(list_.study().screening[t]) : Json::array();
      EXPECT_EQ(list_.seat(seat, "screen", {{"test", t}, {"actions", path}, {"ms", 5}}), "");
    }
    list_.pass(1.0);
    group_.pass(1.0);
    return seat;
  }

  // What the group does next because somebody drops out.
  [[nodiscard]] RoomEvent departure_of(std::size_t seat) {
    EXPECT_EQ(group_.send("server", "away", {{"seat", seat}}), "");
    group_.pass(21);
    list_.pass(21);
    const auto due = group_.room().due(group_.now());
    EXPECT_EQ(due.size(), 1u);
    EXPECT_TRUE(due.front().get<happening::Dropped>() != nullptr);
    return due.front();
  }
  [[nodiscard]] static Json call(std::size_t seat, const Vacancy& vacancy) {
    return {{"seat", seat},
            {"room", "r2"},
            {"for", vacancy.seat},
            {"type", std::string{vacancy.type}},
            {"why", vacancy.why}};
  }
  // Somebody from the list takes over.
  void take_over(const RoomEvent& departure) {
    const auto vacancy = group_.room().vacancy(departure);
    ASSERT_TRUE(vacancy);
    const auto seat = list_.room().next_for(vacancy->type);
    ASSERT_TRUE(seat);
    const auto person = list_.room().person_for(*seat);
    ASSERT_EQ(list_.send("server", "call", call(*seat, *vacancy)), "");
    for (const auto& event : group_.room().replaced(departure, person, group_.now())) group_.apply(event);
    group_.settle();
  }
  [[nodiscard]] Json page(std::size_t seat) const {
    return group_.room().view({Viewer::Role::kParticipant, seat}, group_.now());
  }

  Play list_;
  Play group_;
};

TEST_F(Takeover, IsPartOfTheNextPeriodAndStartsFromThePrior) {
  group_.start(3);
  const auto prior = group_.room().session().belief().member(1);
  const auto novice = come(false);
  for (int i = 0; i < 20 && (group_.room().session().periods() == 0 || group_.room().stage_of(2) != "watch"); ++i) {
    for (const auto seat : {1u, 2u, 3u}) group_.act(seat);
  }
  ASSERT_GE(group_.room().session().periods(), 1u);
  ASSERT_EQ(group_.room().stage_of(2), "watch");
  const auto known = group_.room().session().belief().member(0);
  EXPECT_NE(group_.room().session().belief().member(1), prior);
  take_over(departure_of(2));
  EXPECT_EQ(group_.room().num_seats(), 4u);
  EXPECT_EQ(group_.room().stage_of(2), "replaced");
  EXPECT_TRUE(page(2)["end"].contains("code"));
  EXPECT_EQ(list_.room().stage_of(novice), "moved");
  ASSERT_EQ(group_.room().stage_of(4), "wait");
  EXPECT_EQ(page(4)["wait"]["for"], "joining");
  EXPECT_EQ(page(4)["me"]["label"], "Learner B");
  EXPECT_EQ(page(1)["group"]["active"], 3);
  EXPECT_EQ(group_.room().session().belief().member(0), known);
  // The others finish the period; then everybody gets the next lesson.
  const auto period = group_.room().session().periods();
  for (int i = 0; i < 20 && group_.room().session().periods() == period; ++i) {
    for (const auto seat : {1u, 3u}) group_.act(seat);
    EXPECT_EQ(group_.room().stage_of(4), "wait");
  }
  EXPECT_EQ(page(4)["wait"]["for"], "joining");
  for (const auto seat : {1u, 3u}) group_.act(seat);
  ASSERT_EQ(group_.room().stage_of(4), "watch");
  EXPECT_EQ(group_.room().session().belief().member(1), prior);
  EXPECT_EQ(group_.room().session().belief().common(), prior);
  group_.play_on({1, 3, 4});
  EXPECT_EQ(group_.room().stage_of(4), "debrief");
  list_.expect_replay();
  group_.expect_replay();
}

TEST_F(Takeover, FollowsALeaverAtOnce) {
  group_.start(3);
  come(true);
  const auto decision = group_.room().decide({seat_actor(3), "leave", Json::object(), "id"}, group_.now());
  ASSERT_EQ(decision.events.size(), 1u);
  EXPECT_EQ(group_.room().vacancy(decision.events.front()), (Vacancy{3, 'P', "left"}));
  take_over(decision.events.front());
  EXPECT_EQ(group_.room().stage_of(3), "ended");
  EXPECT_EQ(page(4)["wait"]["for"], "joining");
  group_.play_on({1, 2, 4});
  EXPECT_EQ(group_.room().stage_of(4), "debrief");
  group_.expect_replay();
}

// Before the first lesson nothing has been missed.
TEST_F(Takeover, BeforeTheFirstLessonIsLikeHavingBeenThere) {
  group_.set_teacher(false);
  group_.start(3);
  come(false);
  take_over(departure_of(1));
  EXPECT_EQ(page(4)["wait"]["for"], "teacher");
  group_.set_teacher(true);
  EXPECT_EQ(group_.room().stage_of(4), "watch");
}

TEST_F(Takeover, IsForPeopleWhomThePlaceFits) {
  EXPECT_EQ(list_.room().next_for('P'), std::nullopt);
  const auto able = come(true);
  EXPECT_EQ(list_.room().next_for('P'), able);
  EXPECT_EQ(list_.room().next_for('N'), std::nullopt);
  const auto first = come(false);
  const auto second = come(false);
  EXPECT_EQ(list_.room().next_for('N'), first);
  ASSERT_EQ(list_.send("server", "away", {{"seat", first}}), "");
  EXPECT_EQ(list_.room().next_for('N'), second);
  ASSERT_EQ(list_.send("server", "present", {{"seat", first}}), "");
  ASSERT_EQ(list_.send("server", "call", call(first, {2, 'N', "away"})), "");
  EXPECT_EQ(list_.room().next_for('N'), second) << "nobody is called twice";
  EXPECT_EQ(group_.room().next_for('N'), std::nullopt) << "no waiting list";
  list_.expect_replay();
}

TEST_F(Takeover, TakesNobodyTwice) {
  come(true);
  const auto a = come(false);
  come(false);
  const auto planned = list_.room().next_group(list_.now());
  ASSERT_TRUE(planned);
  ASSERT_EQ(list_.send("server", "call", call(a, {2, 'N', "left"})), "");
  auto body = to_json(*planned);
  body["room"] = "r3";
  EXPECT_EQ(list_.send("server", "group", body), "not-now");
}

TEST_F(Takeover, RefusesWhatDoesNotFit) {
  group_.start(3);
  const auto novice = come(false);
  const auto good = call(novice, {2, 'N', "away"});
  for (const auto* key : {"seat", "room", "for", "type", "why"}) {
    auto body = good;
    body.erase(key);
    EXPECT_EQ(list_.send("server", "call", body), "bad-body") << key;
  }
  EXPECT_EQ(list_.send("server", "call", call(novice, {3, 'P', "away"})), "not-now");
  EXPECT_EQ(list_.send("server", "call", call(novice + 1, {2, 'N', "away"})), "bad-body");
  EXPECT_EQ(list_.send("facilitator", "call", good), "unknown-type");
  EXPECT_EQ(list_.seat(novice, "call", good), "unknown-type");
  EXPECT_EQ(group_.send("server", "call", good), "not-now");

  auto person = list_.room().person_for(novice);
  person["member"] = nullptr;
  Play fresh{pooled_study()};
  EXPECT_EQ(fresh.send("server", "seat", person), "started") << "in the lobby people get a place";
  Play other{live_study("[group]\nsize = 3\nscreening = { tests = 2, cut = 0.6, high = \"P\" }\n")};
  other.start(3);
  other.pass(2.0);
  EXPECT_EQ(other.send("server", "seat", person), "started") << "another policy";
  group_.play_on({1, 2, 3});
  EXPECT_EQ(group_.send("server", "seat", person), "started") << "teaching is over";
}

TEST_F(Takeover, HasNoVacancyWhereNobodyDropsOutOfARunningGroup) {
  group_.join(3);
  const RoomEvent left{1, group_.now(), seat_actor(1), happening::Left{}};
  EXPECT_EQ(group_.room().vacancy(left), std::nullopt) << "in the lobby";
  for (std::size_t i = 1; i <= 3; ++i) group_.get_ready(i);
  EXPECT_TRUE(group_.room().vacancy(left));
  EXPECT_EQ(group_.room().vacancy({1, 0, seat_actor(1), happening::Watched{0}}), std::nullopt);
  Play other{live_study("[group]\nsize = 3\nscreening = { tests = 2, cut = 0.6, high = \"P\" }\n")};
  other.start(3);
  EXPECT_EQ(other.room().vacancy(left), std::nullopt) << "another policy";
  group_.play_on({1, 2, 3});
  EXPECT_EQ(group_.room().vacancy(left), std::nullopt) << "teaching is over";
}

// The smallest number of people counts those who are there afterwards.
TEST(TakeoverOfAGroup, GoesOnThatWouldOtherwiseBeTooSmall) {
  for (const std::size_t waiting : {0u, 1u}) {
    Play play{pooled_study(", min_active = 3")};
    play.start(3);
    play.set_waiting(waiting);
    ASSERT_EQ(play.seat(1, "leave"), "");
    EXPECT_EQ(play.room().stage(), waiting == 0 ? RoomStage::kEnded : RoomStage::kRunning);
    play.expect_replay();
  }
}

TEST(TakeoverOfAGroup, IsFollowedByTheSecondChoiceIfNobodyWaits) {
  const auto after = [](const std::string& otherwise, std::size_t waiting) {
    auto play = std::make_unique<Play>(pooled_study(otherwise));
    play->start(3);
    play->set_waiting(waiting);
    EXPECT_EQ(play->send("server", "away", {{"seat", 1}}), "");
    play->wait(21);
    play->expect_replay();
    return play;
  };
  EXPECT_EQ(after("", 0)->room().stage_of(1), "wait") << "may return";
  const auto simulated = after(", otherwise = \"simulate\"", 0);
  EXPECT_EQ(simulated->room().stage_of(1), "replaced");
  ASSERT_EQ(simulated->room().num_seats(), 4u);
  EXPECT_FALSE(simulated->room().is_person(4));
  EXPECT_EQ(after(", otherwise = \"end-group\"", 0)->room().stage(), RoomStage::kEnded);
  for (const auto* otherwise : {"", ", otherwise = \"simulate\"", ", otherwise = \"end-group\""}) {
    const auto play = after(otherwise, 1);
    EXPECT_EQ(play->room().stage(), RoomStage::kRunning) << otherwise;
    ASSERT_EQ(play->room().num_seats(), 4u) << otherwise;
    EXPECT_TRUE(play->room().is_person(4)) << otherwise;
    EXPECT_EQ(play->room().stage_of(1), "replaced") << otherwise;
  }
}

TEST(TakeoverOfAGroup, MayHappenAgainAndAgain) {
  Play play{pooled_study()};
  play.start(3);
  play.set_waiting(5);
  for (int i = 0; i < 5; ++i) {
    const auto last = play.room().num_seats();
    const auto seat = i == 0 ? 3 : last;
    ASSERT_EQ(play.seat(seat, "leave"), "");
    play.play_on({1, 2}, true, 1);
  }
  EXPECT_EQ(play.num_waiting(), 0u);
  EXPECT_EQ(play.room().num_seats(), 8u);
  play.play_on({1, 2, 8});
  EXPECT_EQ(play.room().stage_of(8), "debrief");
  play.expect_replay();
}

// Also if nobody is left who has seen the lesson.
TEST(TakeoverOfAGroup, StartsANewLessonIfEverybodyElseIsGone) {
  Play play{pooled_study()};
  play.start(3);
  play.play_on({1, 2, 3}, true, 4);
  const auto prior = Room{play.study_of_room(), play.room().setup(), play.cache()}.session().belief().member(0);
  play.set_waiting(3);
  for (const auto seat : {1u, 2u, 3u}) ASSERT_EQ(play.seat(seat, "leave"), "");
  EXPECT_EQ(play.room().stage(), RoomStage::kRunning);
  for (const auto seat : {4u, 5u, 6u}) EXPECT_EQ(play.room().stage_of(seat), "watch") << seat;
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(play.room().session().belief().member(m).size(), prior.size());
    EXPECT_EQ(play.room().session().belief().member(m), prior) << "member " << m;
  }
  play.play_on({4, 5, 6});
  EXPECT_EQ(play.room().stage_of(6), "debrief");
  play.expect_replay();
}

// Whoever was away and returns sees that the group has gone on.
TEST(TakeoverOfAGroup, DiffersFromReturning) {
  Play play{pooled_study()};
  play.start(3);
  ASSERT_EQ(play.send("server", "away", {{"seat", 1}}), "");
  play.wait(21);
  ASSERT_EQ(play.send("server", "present", {{"seat", 1}}), "");
  ASSERT_EQ(play.room().stage_of(1), "wait");
  EXPECT_EQ(play.room().view({Viewer::Role::kParticipant, 1}, play.now())["wait"]["for"], "rejoining");
  play.play_on({2, 3}, true, 3);
  EXPECT_NE(play.room().stage_of(1), "wait");
}

}  // namespace
}  // namespace kith::testing
