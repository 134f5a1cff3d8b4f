// What participants must not see (R19).
#include <gtest/gtest.h>

#include <set>

#include "kith/core/distributions.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::Play;

void collect_keys(const Json& json, std::set<std::string>& keys) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      keys.insert(key);
      collect_keys(value, keys);
    }
  } else if (json.is_array()) {
    for (const auto& value : json) collect_keys(value, keys);
  }
}

// Members of views that would give something away, on any page.
const std::set<std::string> kForbidden{"features", "weight",    "weights",  "beliefs",   "belief",       "points",
                                       "source",   "gain",      "normal",   "sentences", "runners_up",   "truth",
                                       "bec",      "prior",     "curves",   "p_bec",     "regret",       "answers",
                                       "estimate", "component", "strategy", "type",      "kind_of_seat", "presence"};
// Those that belong to feedback only.
const std::set<std::string> kAfterwards{"right",      "robot_path", "why",     "cost",          "mine",
                                        "differs_at", "all_right",  "learned", "others_unsure", "spared"};

void expect_blind(const Json& view) {
  std::set<std::string> keys;
  collect_keys(view, keys);
  for (const auto& key : keys) EXPECT_EQ(kForbidden.count(key), 0u) << key << " in " << view["stage"];
  if (view["stage"] == "feedback" || view["stage"] == "debrief") return;
  auto rest = view;
  if (rest.contains("pause")) rest["pause"].erase("why");
  keys.clear();
  collect_keys(rest, keys);
  for (const auto& key : keys) EXPECT_EQ(kAfterwards.count(key), 0u) << key << " in " << view["stage"];
  if (view["stage"] == "predict" || view["stage"] == "wait") {
    EXPECT_EQ(keys.count("frames"), 0u) << view["stage"];
  }
}

// Random histories: nobody's page ever has a member that gives something away.
TEST(Blinding, NoPageHasAForbiddenMember) {
  const auto study = live_study("[group]\ndropout = { policy = \"continue-now\" }\n");
  std::size_t views = 0;
  for (std::uint64_t round = 0; round < 12; ++round) {
    auto random = RandomStream{5}.split(round);
    Play play{study};
    play.start(3);
    for (int i = 0; i < 150 && play.room().stage() == RoomStage::kRunning; ++i) {
      const auto seat = 1 + uniform_index(3, random);
      if (uniform_index(40, random) == 0) {
        static_cast<void>(play.send("server", uniform_index(2, random) == 0 ? "away" : "present", {{"seat", seat}}));
      } else {
        play.act(seat, uniform_index(3, random) != 0);
      }
      for (std::size_t viewer = 1; viewer <= 3; ++viewer) {
        expect_blind(play.room().view({Viewer::Role::kParticipant, viewer}, play.now()));
        ++views;
      }
    }
  }
  EXPECT_GT(views, 3000u);
}

// Only another person's answer differs: the bytes are the same until everybody sees the feedback.
TEST(Blinding, AnotherPersonsAnswerShowsNowhereBeforeTheFeedback) {
  const auto study = live_study();
  std::size_t compared = 0;
  for (std::uint64_t round = 0; round < 20; ++round) {
    Play a{study}, b{study};
    for (auto* play : {&a, &b}) {
      auto random = RandomStream{7}.split(round);
      play->start(3);
      for (std::uint64_t period = 0; period < round % 3; ++period) {
        for (std::size_t i = 0; i < 9; ++i) {
          const bool right = uniform_index(2, random) == 0;
          play->act(1 + i % 3, right);
        }
      }
    }
    if (a.room().stage_of(1) != "watch") continue;
    const auto same = [&] {
      for (const std::size_t viewer : {1u, 3u}) {
        const auto of_a = a.room().view({Viewer::Role::kParticipant, viewer}, a.now());
        const auto of_b = b.room().view({Viewer::Role::kParticipant, viewer}, b.now());
        ASSERT_EQ(of_a.dump(), of_b.dump());
        ++compared;
      }
    };
    for (std::size_t i = 1; i <= 3; ++i) {
      a.watch(i);
      b.watch(i);
    }
    same();
    a.answer(2, true);  // the only difference
    b.answer(2, false);
    same();
    a.answer(1, round % 2 == 0);
    b.answer(1, round % 2 == 0);
    same();
    a.answer(3);
    b.answer(3);
    ASSERT_EQ(a.room().stage_of(1), "feedback");
    const auto mine = a.room().view({Viewer::Role::kParticipant, 1}, a.now())["feedback"]["tests"];
    EXPECT_EQ(mine, b.room().view({Viewer::Role::kParticipant, 1}, b.now())["feedback"]["tests"]);
  }
  EXPECT_GT(compared, 60u);
}

TEST(Blinding, ThePageShowsNoWeightOfAnyFeature) {
  Play play{live_study()};
  play.start(3);
  const auto view = play.room().view({Viewer::Role::kParticipant, 1}, play.now());
  EXPECT_FALSE(view["watch"]["board"]["domain"].contains("features"));
  EXPECT_FALSE(view["watch"]["board"]["domain"].contains("title"));
  EXPECT_TRUE(view["watch"]["board"]["domain"].contains("legend"));
}

TEST(Blinding, AWorldTableTellsNothingAboutTheReward) {
  const auto study = live_study();
  std::set<std::string> keys;
  collect_keys(world_json(*study, MdpIndex{0}), keys);
  for (const auto& key : keys) EXPECT_EQ(kForbidden.count(key), 0u) << key;
}

}  // namespace
}  // namespace kith
