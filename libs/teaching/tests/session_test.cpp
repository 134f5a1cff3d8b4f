#include "kith/teaching/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "item_delivery.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "robots_answers.hpp"

namespace kith {
namespace {

using testing::item_delivery;

std::vector<RandomStream> persons(std::size_t n) {
  std::vector<RandomStream> streams;
  for (std::size_t i = 0; i < n; ++i) streams.push_back(RandomStream{99}.split("person").split(i));
  return streams;
}

Session make_session(TeachingCache& cache, std::string_view strategy, std::size_t members,
                     const TeachingOptions& options = {}) {
  Session session{cache, options, strategy_named(strategy), persons(members), RandomStream{99}.split("teacher")};
  session.propose(cache);
  return session;
}

// A whole period; the next lesson is chosen at once.
Feedback submit(Session& session, TeachingCache& cache, std::span<const std::vector<Answer>> answers) {
  auto feedback = session.submit(answers);
  session.propose(cache);
  return feedback;
}

// Everybody answers like the robot.
std::vector<std::vector<Answer>> all_right(const Session& session) {
  return std::vector(session.num_members(), testing::robots_answers(session));
}

// A path that is worse than the robot's: another vertex of the coverage set.
IntegerVector worse_answer(StartIndex test) {
  for (const auto& vertex : item_delivery().tables().coverage_set(test)) {
    if (vertex != item_delivery().feature_counts(test)) return vertex;
  }
  throw std::logic_error{"a test without an alternative does not discriminate"};
}

std::vector<std::vector<Answer>> wrong_answers(const Session& session) {
  std::vector<Answer> answers;
  for (const auto& test : session.lesson().tests) answers.emplace_back(worse_answer(test.start));
  return std::vector(session.num_members(), answers);
}

class EveryStrategy : public ::testing::TestWithParam<std::string_view> {
 protected:
  [[nodiscard]] std::size_t team_size() const { return GetParam() == kBaseline ? 1 : 3; }
  // Whether it teaches everything at once, in short lessons whose tests it chooses itself.
  [[nodiscard]] static bool teaches_whole() { return find_strategy_kind(GetParam())->teaches_whole; }
  TeachingCache cache_{item_delivery()};
};

TEST_P(EveryStrategy, PerfectAnswersLearnEveryComponentInOnePeriodEach) {
  auto session = make_session(cache_, GetParam(), team_size());
  while (!session.finished()) {
    const auto feedback = submit(session, cache_, all_right(session));
    EXPECT_TRUE(feedback.component_learned || teaches_whole());
  }
  EXPECT_EQ(session.status(), SessionStatus::kComplete);
  EXPECT_LE(session.periods(), teaches_whole() ? 6u : 3u);  // short lessons need six tests
  for (const auto status : session.components()) EXPECT_NE(status, ComponentStatus::kOpen);
}

TEST_P(EveryStrategy, AnUnlearnedComponentIsNeverLeft) {
  auto session = make_session(cache_, GetParam(), team_size(), {.max_periods = 12});
  const std::size_t first = teaches_whole() ? session.components().size() - 1 : 0;
  while (!session.finished()) {
    EXPECT_EQ(session.lesson().component, first);
    EXPECT_FALSE(session.lesson().demonstrations.empty());
    EXPECT_FALSE(session.lesson().tests.empty());
    submit(session, cache_, wrong_answers(session));
  }
  EXPECT_EQ(session.status(), SessionStatus::kMaxPeriods);
  EXPECT_EQ(session.periods(), 12u);
  EXPECT_EQ(session.components()[first], ComponentStatus::kOpen);
}

TEST_P(EveryStrategy, LessonsKeepTheirPromises) {
  const auto& atlas = item_delivery();
  auto session = make_session(cache_, GetParam(), team_size());
  std::vector<HalfSpace> taught;  // by short lessons, in this one or before
  for (std::size_t period = 1; !session.finished() && period <= 12; ++period) {
    const auto lesson = session.lesson();
    const auto& component = atlas.knowledge_components()[lesson.component];
    EXPECT_EQ(lesson.period, period);
    auto conveyed = atlas.prior();
    double log_gain = 0.0;
    for (const auto& shown : lesson.demonstrations) {
      EXPECT_TRUE(component.uses_mdp[atlas.id(shown.start).mdp.value()]);
      if (!lesson.source.is_everybody()) {  // chosen for its gain
        EXPECT_GT(shown.gain, 1.0);
        EXPECT_GE(shown.num_new, 1u);
      }
      log_gain += std::log(shown.gain);
      conveyed |= cache_.numbers_of(shown.half_spaces);
    }
    if (!lesson.repeats) {
      EXPECT_NEAR(lesson.gain, log_gain, 1e-9);
    }
    EXPECT_NEAR(lesson.area_sr, cache_.regions().of(conveyed).area_sr, 1e-12);
    EXPECT_LE(lesson.running_area_sr, lesson.area_sr + 1e-12);
    std::vector<HalfSpace> covered;
    for (const auto& test : lesson.tests) {
      EXPECT_TRUE(component.uses_mdp[atlas.id(test.start).mdp.value()]);
      EXPECT_FALSE(test.covered.empty());
      covered.insert(covered.end(), test.covered.begin(), test.covered.end());
    }
    std::sort(covered.begin(), covered.end());
    covered.erase(std::unique(covered.begin(), covered.end()), covered.end());
    if (!teaches_whole()) {
      EXPECT_EQ(covered.size() + lesson.untested, lesson.taught.size());
      taught.clear();
    }
    taught.insert(taught.end(), lesson.taught.begin(), lesson.taught.end());
    for (const auto& constraint : covered) {
      EXPECT_NE(std::find(taught.begin(), taught.end(), constraint), taught.end());
    }
    submit(session, cache_, period % 3 == 0 ? all_right(session) : wrong_answers(session));
  }
}

TEST_P(EveryStrategy, EqualStreamsAndAnswersGiveEqualSessions) {
  TeachingCache other_cache{item_delivery()};
  (void)other_cache.regions().of(item_delivery().policy_bec());  // a cache that has seen other things
  auto a = make_session(cache_, GetParam(), team_size());
  auto b = make_session(other_cache, GetParam(), team_size());
  for (int i = 0; i < 5 && !a.finished(); ++i) {
    ASSERT_FALSE(b.finished());
    ASSERT_EQ(a.lesson().demonstrations.size(), b.lesson().demonstrations.size());
    for (std::size_t k = 0; k < a.lesson().demonstrations.size(); ++k) {
      EXPECT_EQ(a.lesson().demonstrations[k].start, b.lesson().demonstrations[k].start);
    }
    submit(a, cache_, i % 2 == 0 ? wrong_answers(a) : all_right(a));
    submit(b, other_cache, i % 2 == 0 ? wrong_answers(b) : all_right(b));
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryStrategy, ::testing::ValuesIn([] {
                           std::vector<std::string_view> names;
                           for (const auto& kind : strategy_kinds()) names.push_back(kind.name);
                           return names;
                         }()),
                         [](const auto& c) {
                           std::string name{c.param};
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// All beliefs about a team of one are that member's.
TEST(Session, ATeamOfOneIsTaughtAlikeForEveryBelief) {
  std::vector<std::vector<StartIndex>> shown;
  for (const auto* name : {"baseline", "individual-low", "individual-high", "common", "joint"}) {
    TeachingCache cache{item_delivery()};
    auto session = make_session(cache, name, 1);
    auto& list = shown.emplace_back();
    for (int i = 0; i < 6 && !session.finished(); ++i) {
      for (const auto& one : session.lesson().demonstrations) list.push_back(one.start);
      for (const auto& test : session.lesson().tests) list.push_back(test.start);
      submit(session, cache, i % 2 == 0 ? wrong_answers(session) : all_right(session));
    }
  }
  for (const auto& list : shown) EXPECT_EQ(list, shown.front());
}

TEST(Session, ConsecutiveCorrectAsksForSeveralGoodPeriods) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "common", 2, {.consecutive_correct = 2});
  EXPECT_FALSE(submit(session, cache, all_right(session)).component_learned);
  EXPECT_FALSE(submit(session, cache, wrong_answers(session)).component_learned);
  EXPECT_FALSE(submit(session, cache, all_right(session)).component_learned);
  EXPECT_TRUE(submit(session, cache, all_right(session)).component_learned);
}

TEST(Session, DuplicateSetsAskAboutEveryConstraintThatOften) {
  TeachingCache cache{item_delivery()};
  const auto once = make_session(cache, "common", 2);
  const auto twice = make_session(cache, "common", 2, {.duplicate_sets = 2});
  EXPECT_GE(twice.lesson().tests.size(), 2 * once.lesson().tests.size());
}

TEST(Session, DuplicateSetsShowEveryConstraintOnce) {
  TeachingCache cache{item_delivery()};
  auto once = make_session(cache, "common", 2);
  auto twice = make_session(cache, "common", 2, {.duplicate_sets = 2});
  const auto right_once = submit(once, cache, all_right(once));
  const auto right_twice = submit(twice, cache, all_right(twice));
  EXPECT_EQ(right_twice.half_spaces, right_once.half_spaces);
  EXPECT_TRUE(twice.belief() == once.belief());
}

TEST(Session, OneWrongMemberKeepsTheComponentOpen) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "joint", 3);
  auto answers = all_right(session);
  answers[1][0] = worse_answer(session.lesson().tests[0].start);
  const auto feedback = submit(session, cache, answers);
  EXPECT_THAT(feedback.all_correct, ::testing::ElementsAre(true, false, true));
  EXPECT_FALSE(feedback.component_learned);
  EXPECT_GT(feedback.verdicts[1][0].regret, 0.0);
  EXPECT_EQ(feedback.verdicts[0][0].regret, 0.0);
}

TEST(Session, AMissingAnswerIsWrongAndShowsNothing) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "common", 1);
  const auto feedback =
      submit(session, cache, std::vector<std::vector<Answer>>(1, std::vector<Answer>(session.lesson().tests.size())));
  for (const auto& verdict : feedback.verdicts[0]) {
    EXPECT_FALSE(verdict.correct);
    EXPECT_FALSE(verdict.answered);
    EXPECT_TRUE(verdict.half_spaces.empty());
  }
}

TEST(Session, AWrongAnswerShowsTheHalfSpaceInWhichItWins) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "common", 1);
  const auto test = session.lesson().tests[0].start;
  auto answers = wrong_answers(session);
  const auto loss = item_delivery().feature_counts(test) - *answers[0][0];
  const auto feedback = submit(session, cache, answers);
  ASSERT_EQ(feedback.verdicts[0][0].half_spaces.size(), 1u);
  EXPECT_EQ(feedback.verdicts[0][0].half_spaces[0], HalfSpace{-loss});
}

// The skateboard's weights lie on the edge: often two paths with different feature counts are equally good. Whoever
// answers with the other one shows nothing, and never the opposite of it.
TEST(Session, ARightAnswerByAnotherPathIsNoEvidence) {
  const Atlas atlas{load_domain("skateboard")};
  TeachingCache cache{atlas};
  std::size_t others = 0, same = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Session session{
        cache, {.max_periods = 8}, strategy_named("common"), {RandomStream{seed}}, RandomStream{seed + 100}};
    auto random = RandomStream{seed}.split("answers");
    while (session.propose(cache)) {
      std::vector<Answer> answers;
      for (const auto& test : session.lesson().tests) {
        const auto& paths = atlas.tables().coverage_set(test.start);
        answers.emplace_back(paths[uniform_index(paths.size(), random)]);
        if (session.periods() % 4 == 3) answers.back() = atlas.feature_counts(test.start);
        for (const auto& path : atlas.tables().coverage_set(test.start)) {
          const auto loss = atlas.feature_counts(test.start) - path;
          const bool as_good = sign_of_dot(atlas.domain().weights().integer, loss) == 0;
          if (as_good && path != atlas.feature_counts(test.start)) answers.back() = path;
        }
      }
      const auto lesson = session.lesson();
      const auto feedback = session.submit(std::vector<std::vector<Answer>>{answers});
      for (std::size_t t = 0; t < answers.size(); ++t) {
        const auto& verdict = feedback.verdicts[0][t];
        if (!verdict.correct) continue;
        const auto difference = *answers[t] - atlas.feature_counts(lesson.tests[t].start);
        if (difference == IntegerVector{0, 0, 0}) {
          EXPECT_EQ(verdict.half_spaces, lesson.tests[t].covered);
          ++same;
        } else {
          EXPECT_TRUE(verdict.half_spaces.empty());
          ++others;
        }
      }
    }
  }
  EXPECT_GT(same, 10u);
  EXPECT_GT(others, 10u);
}

TEST(Session, RefusesAnswersOfTheWrongShapeOrBetterThanOptimal) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "common", 2);
  const auto before = session;
  auto answers = all_right(session);
  EXPECT_THROW(session.submit(std::span{answers}.first(1)), Error);
  auto short_list = answers;
  short_list[1].pop_back();
  EXPECT_THROW(session.submit(short_list), Error);
  answers[1][0] = IntegerVector{0, 5, 0};
  EXPECT_THROW(session.submit(answers), Error);
  answers[1][0] = IntegerVector{0, 5};
  EXPECT_THROW(session.submit(answers), Error);
  EXPECT_EQ(session, before);
}

TEST(Session, RefusesBadOptionsAndTeams) {
  TeachingCache cache{item_delivery()};
  EXPECT_THROW(make_session(cache, "common", 0), std::invalid_argument);
  EXPECT_THROW(make_session(cache, "common", 31), std::invalid_argument);
  EXPECT_THROW(make_session(cache, "baseline", 2), std::invalid_argument);
  EXPECT_THROW(make_session(cache, "common", 1, {.counterfactuals = 0}), std::invalid_argument);
  EXPECT_THROW(make_session(cache, "common", 1, {.max_periods = 0}), std::invalid_argument);
  EXPECT_THROW(make_session(cache, "common", 1, {.assumed_ability = 0.4}), std::invalid_argument);
}

TEST(Session, HasNoLessonOnceFinished) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "common", 1);
  while (!session.finished()) submit(session, cache, all_right(session));
  EXPECT_THROW((void)session.lesson(), Error);
  EXPECT_THROW(session.submit({}), Error);
  EXPECT_FALSE(session.propose(cache));
}

TEST(Session, ThirtyMembersAreTaught) {
  TeachingCache cache{item_delivery()};
  auto session = make_session(cache, "joint", 30, {.max_periods = 3});
  for (int i = 0; !session.finished(); ++i) {
    auto answers = all_right(session);
    for (std::size_t m = 0; m < 15; ++m) answers[2 * m] = wrong_answers(session)[0];
    submit(session, cache, answers);
  }
  EXPECT_EQ(session.periods(), 3u);
}

// A learner who already holds the policy's BEC as prior has nothing to learn.
TEST(Session, SkipsEveryComponentWhenThePriorSaysItAll) {
  std::string text;
  for (const auto& domain : built_in_domains()) {
    if (domain.name == "item-delivery") text = domain.text;
  }
  const std::string prior = "halfspaces = [ { step = -1 } ]";
  const auto at = text.find(prior);
  ASSERT_NE(at, std::string::npos);
  text.replace(
      at, prior.size(),
      "halfspaces = [ { rubble = -1, step = 2 }, { recharge = -1, step = -4 }, { rubble = 1, recharge = 1 } ]");
  auto reading = parse_domain(text, "all-known.toml");
  ASSERT_TRUE(reading.domain.has_value());
  const Atlas atlas{*reading.domain};
  TeachingCache cache{atlas};
  Session session{cache, {}, strategy_named("common"), persons(2), RandomStream{1}};
  EXPECT_FALSE(session.propose(cache));
  EXPECT_EQ(session.status(), SessionStatus::kComplete);  // nothing is open
  EXPECT_EQ(session.periods(), 0u);
  for (const auto status : session.components()) EXPECT_EQ(status, ComponentStatus::kSkipped);
}

TEST(Strategies, AreFoundByTheirNames) {
  for (const auto& kind : strategy_kinds()) {
    EXPECT_EQ(find_strategy_kind(kind.name)->name, kind.name);
    EXPECT_EQ(strategy_named(kind.name).name, kind.name);
  }
  EXPECT_EQ(find_strategy_kind("individual"), nullptr);
  EXPECT_THROW((void)strategy_named("individual"), std::invalid_argument);
}

}  // namespace
}  // namespace kith
