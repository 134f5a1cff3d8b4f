#include <gtest/gtest.h>

#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::Play;

// Anything that anybody might send, sensible or not.
RoomCommand some_command(RandomStream& random) {
  const auto pick = [&](std::size_t n) { return uniform_index(n, random); };
  const auto actor = pick(8) == 0   ? std::string{"facilitator"}
                     : pick(6) == 0 ? std::string{"server"}
                                    : seat_actor(1 + pick(5));
  static const std::vector<std::string> kTypes{"consent", "checked",  "name",      "screen", "watched", "draft",
                                               "answer",  "continue", "questions", "leave",  "join",    "away",
                                               "present", "start",    "pause",     "resume", "extend",  "message",
                                               "readmit", "simulate", "strategy",  "end",    "dance"};
  Json body{{"accept", pick(10) != 0}, {"version", "1"},           {"seat", pick(7)},
            {"demo", pick(3)},         {"test", pick(3)},          {"ms", pick(5000)},
            {"seconds", pick(100)},    {"text", "hello"},          {"name", pick(2) == 0 ? "joint" : "common"},
            {"reason", "random"},      {"answers", Json::object()}};
  Json actions = Json::array();
  for (std::size_t i = pick(6); i > 0; --i) actions.push_back(pick(8));
  body["actions"] = actions;
  if (pick(12) == 0) body.erase(std::vector<std::string>{"seat", "test", "actions", "ms", "reason", "demo"}[pick(6)]);
  if (pick(30) == 0) body = pick(2) == 0 ? Json::array() : Json("text");
  auto type = kTypes[pick(kTypes.size())];
  if (type == "end" && pick(10) != 0) type = "pause";
  if (type == "leave" && pick(4) != 0) type = "draft";
  return {actor, type, body, "id"};
}

// How often what came about in all rounds.
struct Tally {
  std::size_t accepted = 0;
  std::size_t refused = 0;
  std::size_t periods = 0;
  std::size_t finished = 0;
};

// Random commands, invalid ones among them, with time going by: nothing throws, a refused command changes nothing, and
// the state is that of the accepted events, replayed with a fresh cache.
void play_at_random(std::uint64_t first, std::uint64_t last, Tally& tally) {
  const std::vector<std::string> policies{"pause-then-continue", "continue-now", "simulate", "end-group"};
  std::vector<std::shared_ptr<const LiveStudy>> studies;
  for (const auto& policy : policies) {
    studies.push_back(live_study("[group]\ndropout = { policy = \"" + policy + "\", grace_s = 15" +
                                 " }\ntime = { watch_s = 200, feedback_s = 300 }\n"
                                 "questions = [{ id = \"a\", kind = \"text\", text = \"?\" }]\n"));
  }
  for (auto round = first; round < last; ++round) {
    auto random = RandomStream{23}.split(round);
    Play play{studies[round % studies.size()], "NNP",
              round % 4 == 3 ? std::vector<bool>{false, true, false} : std::vector<bool>{}};
    play.join(round % 4 == 3 ? 2 : 3);
    for (int i = 0; i < 140; ++i) {
      if (uniform_index(3, random) == 0) {
        const auto seat = 1 + uniform_index(play.room().num_seats(), random);
        if (!play.room().is_person(seat)) continue;
        const auto stage = play.room().stage_of(seat);
        if (stage == "consent" && play.seat(seat, "consent", {{"accept", true}, {"version", "1"}}) == "") continue;
        if (stage == "check" && play.seat(seat, "checked") == "") continue;
        play.act(seat, uniform_index(4, random) != 0);
        continue;
      }
      if (uniform_index(5, random) == 0) play.wait(static_cast<double>(uniform_index(10, random)));
      const auto command = some_command(random);
      const auto before = i % 4 == 0 ? play.room().digest() : std::string{};
      const auto events = play.events().size();
      const auto reason = play.send(command.actor, command.type, command.body);
      if (reason.empty()) {
        tally.accepted += play.events().size() - events;
      } else {
        ++tally.refused;
        if (i % 4 == 0 && play.events().size() == events) {
          ASSERT_EQ(play.room().digest(), before) << command.type;
        }
      }
      for (std::size_t seat = 1; seat <= play.room().num_seats(); ++seat) {
        if (i % 10 == 0 && play.room().is_person(seat)) {
          ASSERT_FALSE(play.room().view({Viewer::Role::kParticipant, seat}, play.now()).empty());
        }
      }
      if (i % 40 == 0) {
        ASSERT_FALSE(play.room().view({Viewer::Role::kFacilitator, 0}, play.now()).empty());
      }
    }
    tally.periods += play.room().session().periods();
    tally.finished += play.room().stage() == RoomStage::kEnded ? 1u : 0u;
    TeachingCache fresh{play.study().atlas};
    const auto again = replay(studies[round % studies.size()], play.room().setup(), play.events(), fresh);
    ASSERT_EQ(again.digest(), play.room().digest()) << round;
    // Events survive being written down.
    for (const auto& event : play.events()) {
      const auto body = Json::parse(body_of(event).dump());
      ASSERT_EQ(room_event(event.seq, event.at_us, event.actor, event.kind().word, body), event);
    }
  }
}

TEST(RandomCommands, LeadToTheReplayOfWhatWasAccepted) {
  Tally tally;
  play_at_random(0, 10, tally);
  EXPECT_GT(tally.accepted, 25u);
  EXPECT_GT(tally.refused, 250u);
  EXPECT_GT(tally.periods, 6u);
  EXPECT_GE(tally.finished, 1u);
}

TEST(RandomCommandsSlow, LeadToTheReplayOfWhatWasAccepted) {
  Tally tally;
  play_at_random(0, 40, tally);
  EXPECT_GT(tally.accepted, 100u);
  EXPECT_GT(tally.refused, 1000u);
  EXPECT_GT(tally.periods, 25u);
  EXPECT_GE(tally.finished, 3u);
}

TEST(RandomCommands, CopiesGoOnIndependently) {
  Play play{live_study()};
  play.start(3);
  play.watch(1);
  const auto copy = play.room();
  const auto digest = copy.digest();
  play.play_on({1, 2, 3}, true, 4);
  EXPECT_EQ(copy.digest(), digest);
  EXPECT_NE(play.room().digest(), digest);
}

// What a store holds of an event of every kind, made of what its members can be.
template <typename Event>
void expect_strict(Event event) {
  const std::string word{Event::kKind.word};
  const RoomEvent whole{3, 5, "seat:1", event};
  const auto body = body_of(whole);
  EXPECT_EQ(room_event(3, 5, "seat:1", word, body), whole) << word;
  for (const auto& [name, value] : body.items()) {
    auto broken = body;
    broken.erase(name);
    EXPECT_THROW((void)room_event(3, 5, "seat:1", word, broken), Error) << word << " without " << name;
  }
  auto more = body;
  more["nonsense"] = 1;
  EXPECT_THROW((void)room_event(3, 5, "seat:1", word, more), Error) << word;
  EXPECT_THROW((void)room_event(3, 5, "seat:1", word, Json::array()), Error) << word;
  EXPECT_THROW((void)room_event(3, 5, "seat:1", "danced", body), Error);
}

TEST(RoomEvents, OfEveryKindAreReadAsTheyAreWritten) {
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (expect_strict(std::variant_alternative_t<kIndex, RoomHappening>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<RoomHappening>>{});
}

TEST(RoomEvents, HaveWordsOfTheirOwn) {
  for (const auto& kind : kRoomEventKinds) EXPECT_EQ(room_event_kind(kind.word)->command, kind.command) << kind.word;
}

// As stores have held them since the first version.
TEST(RoomEvents, AreWrittenInAFixedOrder) {
  const auto text = [](const std::string& actor, RoomHappening what) { return body_of({1, 2, actor, what}).dump(); };
  EXPECT_EQ(text("server", happening::Ended{"lobby-time", "Nobody came."}),
            R"({"reason":"lobby-time","text":"Nobody came."})");
  EXPECT_EQ(text("facilitator", happening::Ended{"rain", "It is over."}), R"({"text":"It is over.","reason":"rain"})");
  EXPECT_EQ(text("server", happening::Started{"server", true}), R"({"by":"server","fill":true})");
  EXPECT_EQ(text("facilitator", happening::Started{"facilitator", false, "now"}),
            R"({"by":"facilitator","fill":false,"reason":"now"})");
  EXPECT_EQ(text("seat:1", happening::Answered{0, {1, 2}, Json::array(), 7, false}),
            R"({"test":0,"actions":[1,2],"keys":[],"ms":7})");
  EXPECT_EQ(text("seat:1", happening::Answered{0, {}, Json::array(), 7, true}),
            R"({"test":0,"actions":[],"keys":[],"ms":7,"for_ever":true})");
  EXPECT_EQ(text("server", happening::Grouped{"joint", "NP", {false, true}, {3u, std::nullopt}, "r2"}),
            R"({"strategy":"joint","composition":"NP","simulated":[false,true],"seats":[3,null],"room":"r2"})");
}

TEST(RoomEvents, TellSeatsFromOtherActors) {
  EXPECT_EQ(seat_of_actor("seat:12"), 12u);
  for (const char* wrong : {"seat:", "seat:0", "seat:1x", "seat:-1", "sea:1", "", "server"}) {
    EXPECT_EQ(seat_of_actor(wrong), std::nullopt) << wrong;
  }
}

}  // namespace
}  // namespace kith
