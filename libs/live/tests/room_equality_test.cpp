#include <gtest/gtest.h>

#include "kith/study/team_run.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::Play;

// The lessons and the beliefs of a simulated team.
class TeamLog final : public TeamObserver {
 public:
  void on_session(const Session&, std::span<const std::size_t>) override {}
  void on_lesson(const Session&, const Lesson&, const Learners&) override {}
  void on_feedback(const Session&, const Lesson&, const std::vector<Learner::Response>&, const Feedback&,
                   const Learners&) override {}
  void on_end(const Session& session, const Learners&) override { end.emplace(session); }
  std::optional<Session> end;
};

// A live session of simulated learners and `kith study` give the same answers, lessons and beliefs, to the bit.
void expect_room_equals_study(const std::shared_ptr<const LiveStudy>& study, const std::string& strategy,
                              const std::string& composition, std::size_t replicate) {
  Play play{study, RoomSetup{.id = "r",
                             .code = "c",
                             .strategy = strategy,
                             .composition = composition,
                             .simulated = std::vector<bool>(composition.size(), true),
                             .replicate = replicate}};
  play.settle();
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);

  TeachingCache cache{study->atlas};
  TeamAddress address;
  address.strategy = strategy;
  address.composition = composition;
  address.replicate = replicate;
  TeamLog log;
  const auto record = run_team(*study->atlas, cache, study->spec, address, &log);
  ASSERT_TRUE(log.end);
  const auto& live = play.room().session();
  ASSERT_GT(record.periods, 2u);
  EXPECT_EQ(record.discussions.empty(), !study->group().discussion.choice.is_held());
  EXPECT_EQ(live.periods(), record.periods);
  ASSERT_EQ(live.history().size(), log.end->history().size());
  EXPECT_TRUE(std::equal(live.history().begin(), live.history().end(), log.end->history().begin()));
  EXPECT_EQ(live.belief(), log.end->belief());
  EXPECT_EQ(digest_of(live), digest_of(*log.end));

  // Killed and replayed: from the events alone, with a cache that has served nobody.
  TeachingCache other{study->atlas};
  const auto again = replay(study, play.room().setup(), play.events(), other);
  EXPECT_EQ(again.session().belief(), live.belief());
  EXPECT_EQ(again.digest(), play.room().digest());
}

class RoomsOfStandIns
    : public ::testing::TestWithParam<std::tuple<const char*, const char*, std::size_t, const char*>> {};

TEST_P(RoomsOfStandIns, EqualTheStudy) {
  const auto [strategy, composition, replicate, model] = GetParam();
  expect_room_equals_study(live_study("[group.discussion]\nmodel = \"" + std::string{model} + "\"\n"), strategy,
                           composition, replicate);
}

// Also people of every kind, with time to forget, and of a mixture; the teacher asks what kind they are.
TEST(RoomsOfEveryKind, EqualTheStudy) {
  std::vector<std::string> types{"mixture = { N = 0.5, P = 0.5 }"};
  for (const auto* model : learner_models()) {
    types.push_back("kind = \"" + std::string{model->kind} +
                    "\"\nability = { mean = 0.75, sd = 0.05 }\nconfirm_gain = { half_normal = 0.03 }\n"
                    "correct_gain = { half_normal = 0.05 }");
  }
  for (const auto& type : types) {
    SCOPED_TRACE(type);
    const auto study =
        live_study("hypotheses = \"kinds\"\n[stop]\nmax_periods = 6\n[pace]\ntest_s = 60\n[learner.K]\n" + type +
                   "\n[group.discussion]\nmodel = \"majority\"\n");
    expect_room_equals_study(study, "joint", "KKN", 1);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, RoomsOfStandIns,
    ::testing::Values(std::tuple{"common", "NNP", 1u, "none"}, std::tuple{"common", "NNP", 2u, "none"},
                      std::tuple{"common", "NN", 3u, "none"}, std::tuple{"joint", "NNP", 1u, "none"},
                      std::tuple{"joint", "NNP", 3u, "none"}, std::tuple{"individual-low", "NN", 2u, "none"},
                      std::tuple{"baseline", "N", 1u, "none"}, std::tuple{"common", "NNP", 1u, "degroot"},
                      std::tuple{"joint", "NN", 2u, "degroot"}, std::tuple{"common", "NNP", 1u, "majority"},
                      std::tuple{"individual-low", "NNP", 2u, "truth-wins"}));

TEST(Room, ChoosesTheSameLessonWhoeverAnswersFirst) {
  Play a{live_study()}, b{live_study()};
  for (auto* play : {&a, &b}) play->start_tests(3);
  for (const std::size_t i : {1u, 2u, 3u}) a.answer(i, i != 2);
  for (const std::size_t i : {3u, 2u, 1u}) b.answer(i, i != 2);
  EXPECT_EQ(digest_of(a.room().session()), digest_of(b.room().session()));
}

TEST(Room, UsesALessonThatWasComputedAheadOfTime) {
  Play play{live_study()};
  play.set_teacher(false);
  play.join(3);
  const auto first = play.room().likely_teaching();
  ASSERT_EQ(first.size(), 1u);
  for (std::size_t i = 1; i <= 3; ++i) play.get_ready(i);
  ASSERT_TRUE(play.room().teaching());
  EXPECT_EQ(play.room().teaching()->key(), first.front().key());
  play.set_teacher(true);
  play.set_teacher(false);
  for (std::size_t i = 1; i <= 3; ++i) play.watch(i);
  play.answer(2);
  const auto likely = play.room().likely_teaching();
  ASSERT_EQ(likely.size(), 1u);
  const auto ahead = likely.front().run(play.cache());
  play.answer(3);
  play.answer(1);
  ASSERT_TRUE(play.room().teaching());
  EXPECT_EQ(play.room().teaching()->key(), ahead.key);
  EXPECT_EQ(play.room().teaching()->run(play.cache()).digest, ahead.digest);
  play.apply(play.room().taught(ahead, play.now()), &ahead);
  play.expect_replay();
}

}  // namespace
}  // namespace kith
