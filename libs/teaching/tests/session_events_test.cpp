// Sessions as sequences of events: refused ones change nothing, accepted ones can be replayed.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>

#include "item_delivery.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/teaching/session.hpp"
#include "robots_answers.hpp"

namespace kith {
namespace {

using testing::item_delivery;
using testing::robots_answers;

Session session_of(TeachingCache& cache, std::string_view strategy, std::size_t members, TeachingOptions options = {},
                   std::uint64_t seed = 1) {
  const RandomStream root{seed};
  std::vector<RandomStream> persons;
  for (std::size_t i = 0; i < members; ++i) persons.push_back(root.split("person").split(i));
  return {cache, std::move(options), strategy_named(strategy), std::move(persons), root.split("teacher")};
}

TeachingOptions quick(std::size_t max_periods = 6) {
  TeachingOptions options;
  options.filter.particles = 60;
  options.max_periods = max_periods;
  options.keep_members = options.keep_rules = true;
  return options;
}

Session replay(const Session& original, Session fresh, TeachingCache& cache) {
  for (const auto& event : original.events()) fresh.apply(event, cache);
  return fresh;
}

// Answers of the right length most of the time: the robot's path, another one, none, an impossible one.
std::vector<Answer> some_answers(const Session& session, RandomStream& random) {
  std::size_t n = 2;
  if (session.phase() == SessionPhase::kTests)
    n = session.lesson().tests.size() + (uniform_index(10, random) == 0 ? 1 : 0);
  std::vector<Answer> answers;
  for (std::size_t t = 0; t < n; ++t) {
    if (session.phase() != SessionPhase::kTests || t >= session.lesson().tests.size()) {
      answers.emplace_back();
      continue;
    }
    const auto test = session.lesson().tests[t].start;
    const auto& paths = session.atlas().tables().coverage_set(test);
    switch (uniform_index(8, random)) {
      case 0:
        answers.emplace_back();
        break;
      case 1:
        answers.emplace_back(IntegerVector{0, 9, 0});
        break;
      case 2:
        answers.emplace_back(IntegerVector{0, 9});
        break;
      case 3:
      case 4:
        answers.emplace_back(paths[uniform_index(paths.size(), random)]);
        break;
      default:
        answers.emplace_back(session.atlas().feature_counts(test));
    }
  }
  return answers;
}

SessionEvent some_event(const Session& session, RandomStream& random) {
  const auto seat = uniform_index(session.num_members() + 1, random);  // one seat too many
  if (uniform_index(3, random) != 0) {                                 // often what comes next
    switch (session.phase()) {
      case SessionPhase::kProposal:
        return LessonProposed{};
      case SessionPhase::kLesson:
        return LessonShown{};
      case SessionPhase::kTests:
        if (uniform_index(4, random) != 0) return TestsAnswered{seat, some_answers(session, random)};
        return TestsClosed{};
      default:
        return FeedbackGiven{};
    }
  }
  switch (uniform_index(10, random)) {
    case 0:
      return LessonProposed{};
    case 1:
      return LessonShown{};
    case 2:
      return TestsClosed{};
    case 3:
      return FeedbackGiven{};
    case 4:
      return MemberLeft{seat};
    case 5:
    case 6:
      return MemberReturned{seat};
    case 7:
      return MemberReplaced{seat};
    default:
      return TestsAnswered{seat, some_answers(session, random)};
  }
}

// 1 000 sequences with invalid events mixed in. A refused event leaves the session as it was; the session equals the
// replay of what it accepted, with a cache that has served nobody else and with one that has served everybody.
TEST(SessionEvents, EqualTheReplayOfWhatWasAccepted) {
  TeachingCache shared{item_delivery()};
  std::size_t accepted = 0, refused = 0, periods = 0, finished = 0;
  for (std::uint64_t round = 0; round < 1000; ++round) {
    auto random = RandomStream{17}.split(round);
    const auto kinds = strategy_kinds();
    const auto& kind = kinds[round % kinds.size()];
    const std::size_t members = kind.name == kBaseline ? 1 : 1 + uniform_index(3, random);
    const auto options = quick(1 + round % 6);
    auto session = session_of(shared, kind.name, members, options, round);
    for (int i = 0; i < 25; ++i) {
      const auto event = some_event(session, random);
      const bool check = uniform_index(20, random) == 0;
      const auto before = check ? std::optional{session} : std::nullopt;
      const auto num_events = session.events().size();
      try {
        session.apply(event, shared);
        ++accepted;
      } catch (const Error& error) {
        EXPECT_STRNE(error.what(), "");
        ++refused;
        ASSERT_EQ(session.events().size(), num_events);
        if (before) {
          ASSERT_EQ(session, *before) << name_of(event);
        }
      }
    }
    periods += session.periods();
    finished += session.finished() ? 1u : 0u;
    ASSERT_EQ(replay(session, session_of(shared, kind.name, members, options, round), shared), session);
    if (round % 50 == 0) {
      TeachingCache own{item_delivery()};
      ASSERT_EQ(replay(session, session_of(own, kind.name, members, options, round), own), session);
    }
  }
  EXPECT_GT(accepted, 10'000u);
  EXPECT_GT(refused, 3'000u);
  EXPECT_GT(periods, 1'000u);
  EXPECT_GT(finished, 10u);
}

// Every event that can be refused, one by one.
TEST(SessionEvents, SayWhyTheyAreRefused) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "common", 2);
  const auto refusal = [&](const SessionEvent& event) -> std::string {
    const auto before = session;
    try {
      session.apply(event, cache);
    } catch (const Error& error) {
      EXPECT_EQ(session, before);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(LessonShown{}), "showing a lesson is not possible now: no lesson has been chosen yet");
  EXPECT_EQ(refusal(MemberLeft{2}), "there is no member 3: the team has 2");
  EXPECT_EQ(refusal(MemberReturned{0}), "member 1 is not away");
  EXPECT_EQ(refusal(LessonProposed{}), "accepted");
  EXPECT_EQ(refusal(LessonProposed{}), "choosing a lesson is not possible now: the lesson has not been shown yet");
  EXPECT_EQ(refusal(TestsAnswered{0, {}}), "answering is not possible now: the lesson has not been shown yet");
  EXPECT_EQ(refusal(LessonShown{}), "accepted");
  const auto n = session.lesson().tests.size();
  EXPECT_EQ(refusal(TestsAnswered{0, std::vector<Answer>(n + 1)}),
            "member 1 gave " + std::to_string(n + 1) + " answers to " + std::to_string(n) + " tests");
  std::vector<Answer> answers(n);
  answers[0] = IntegerVector{0, 9, 0};
  EXPECT_EQ(refusal(TestsAnswered{0, answers}),
            "an answer earns more than the robot's optimal behaviour, which no path can");
  answers[0] = IntegerVector{1};
  EXPECT_EQ(refusal(TestsAnswered{0, answers}), "an answer has 1 feature counts instead of 3");
  EXPECT_EQ(refusal(TestsAnswered{0, std::vector<Answer>(n)}), "accepted");
  EXPECT_EQ(refusal(TestsAnswered{0, std::vector<Answer>(n)}), "member 1 has already answered");
  EXPECT_EQ(refusal(MemberLeft{1}), "accepted");
  EXPECT_EQ(refusal(MemberLeft{1}), "member 2 is away already");
  EXPECT_EQ(refusal(TestsAnswered{1, std::vector<Answer>(n)}), "member 2 is away");
  EXPECT_EQ(refusal(FeedbackGiven{}), "giving feedback is not possible now: the tests are open");
  EXPECT_EQ(refusal(TestsClosed{}), "accepted");
  EXPECT_EQ(refusal(MemberLeft{0}), "accepted");
  EXPECT_EQ(refusal(FeedbackGiven{}), "feedback cannot be given: everybody is away");
}

TEST(SessionEvents, GoOnWithAnotherStrategy) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "common", 2, quick(20));
  ASSERT_TRUE(session.propose(cache));
  EXPECT_EQ(session.lesson().source.rule, "common");
  EXPECT_THROW(session.change_strategy(strategy_named("joint")), Error);  // a lesson is under way
  const auto right = robots_answers(session);
  session.submit(std::vector(2, right));
  EXPECT_THROW(session.change_strategy(strategy_named("baseline")), std::invalid_argument);
  session.change_strategy(strategy_named("joint"));
  EXPECT_EQ(session.strategy().name, "joint");
  ASSERT_TRUE(session.propose(cache));
  EXPECT_EQ(session.lesson().source.rule, "joint");
  EXPECT_EQ(name_of(SessionEvent{StrategyChanged{strategy_named("joint")}}), "strategy-changed");
  EXPECT_EQ(replay(session, session_of(cache, "common", 2, quick(20)), cache), session);

  auto options = quick();
  options.keep_members = options.keep_rules = false;
  auto narrow = session_of(cache, "common", 2, options);
  EXPECT_THROW(narrow.change_strategy(strategy_named("joint")), std::invalid_argument);
  EXPECT_THROW(narrow.change_strategy(strategy_named("individual-low")), std::invalid_argument);
}

// An assumed ability of 1 and answers that contradict what was taught: the teacher goes on.
TEST(SessionEvents, CertaintyAboutPeopleDoesNotEndTheSession) {
  TeachingCache cache{item_delivery()};
  auto options = quick();
  options.assumed_ability = 1.0;
  auto session = session_of(cache, "common", 2, options);
  for (int period = 0; period < 6; ++period) {
    ASSERT_TRUE(session.propose(cache));
    std::vector<std::vector<Answer>> answers(2);
    for (const auto& test : session.lesson().tests) {
      for (const auto& path : item_delivery().tables().coverage_set(test.start)) {
        if (path == item_delivery().feature_counts(test.start)) continue;
        for (auto& list : answers) list.emplace_back(path);
        break;
      }
    }
    EXPECT_FALSE(session.submit(answers).component_learned);
  }
  EXPECT_EQ(session.status(), SessionStatus::kMaxPeriods);
}

// A strategy that fails in the middle of its work: the session is as before, and goes on once the strategy works.
class FailsOnce : public Strategy {
 public:
  explicit FailsOnce(bool& broken) : broken_{&broken} {}
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<FailsOnce>(*this); }
  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    auto unit = select.for_belief(view.belief.common(), random);
    ++calls_;
    if (*broken_) throw std::runtime_error{"broken"};
    return {SourceBelief::of_team("common"), std::move(unit)};
  }

 private:
  bool* broken_;
  int calls_ = 0;
};

TEST(SessionEvents, AStrategyThatThrowsChangesNothing) {
  static bool broken = false;
  const StrategyKind kind{
      "fails", "teach, mostly",
      [](const ParameterValues&) { return TeamBeliefNeeds{.members = false, .rules = {"common"}}; },
      [](const ParameterValues&) -> std::unique_ptr<Strategy> { return std::make_unique<FailsOnce>(broken); }};
  TeachingCache cache{item_delivery()};
  Session session{cache,
                  quick(),
                  strategy_named("fails", std::span{&kind, 1}),
                  {RandomStream{1}, RandomStream{2}},
                  RandomStream{3}};
  const auto before = session;
  broken = true;
  EXPECT_THROW(session.propose(cache), std::runtime_error);
  EXPECT_EQ(session, before);
  broken = false;
  EXPECT_TRUE(session.propose(cache));
  auto common = session_of(cache, "common", 2, quick());
  EXPECT_TRUE(common.propose(cache));
}

// A copy is a look ahead: what happens to it leaves the original alone, and the original then does the same.
TEST(SessionEvents, ACopyGoesOnByItself) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "joint", 3, quick());
  ASSERT_TRUE(session.propose(cache));
  const auto before = session;
  auto copy = session;
  auto random = RandomStream{5};
  for (int i = 0; i < 40; ++i) {
    try {
      copy.apply(some_event(copy, random), cache);
    } catch (const Error&) {
    }
  }
  EXPECT_GT(copy.periods(), 1u);
  EXPECT_EQ(session, before);
  EXPECT_EQ(replay(copy, session_of(cache, "joint", 3, quick()), cache), copy);
}

TEST(SessionEvents, WhoIsAwayNeitherLearnsNorCounts) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "individual-low", 3, quick());
  session.leave(1);
  ASSERT_TRUE(session.propose(cache));
  EXPECT_FALSE(session.takes_part(1));
  const auto untouched = session.belief().member(1);
  const auto right = robots_answers(session);
  session.show();
  session.answer(0, right);
  session.answer(2, right);
  session.come_back(1);  // too late for this lesson
  EXPECT_FALSE(session.takes_part(1));
  EXPECT_THROW(session.answer(1, right), Error);
  session.close_tests();
  const auto& feedback = session.give_feedback();
  EXPECT_TRUE(feedback.component_learned);
  EXPECT_TRUE(feedback.verdicts[1].empty());
  EXPECT_FALSE(feedback.all_correct[1]);
  EXPECT_EQ(session.belief().member(1), untouched);
  EXPECT_NE(session.belief().member(0), untouched);
  ASSERT_TRUE(session.propose(cache));
  EXPECT_TRUE(session.takes_part(1));
  session.show();
  EXPECT_NE(session.belief().member(1), untouched);
}

TEST(SessionEvents, NothingIsKnownAboutWhoTakesAPlace) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "individual-low", 3, quick());
  const auto prior = session.belief().member(1);
  ASSERT_TRUE(session.propose(cache));
  session.submit(std::vector(3, robots_answers(session)));
  const auto returned = [&] {
    auto same = session;
    same.leave(1);
    same.come_back(1);
    EXPECT_TRUE(same.propose(cache));
    return same;
  }();
  EXPECT_THROW(session.replace(1), Error) << "somebody has the place";
  session.leave(1);
  session.replace(1);
  EXPECT_THROW(session.replace(1), Error);
  EXPECT_FALSE(session.takes_part(1));
  EXPECT_NE(session.belief().member(1), prior) << "until the next lesson";
  ASSERT_TRUE(session.propose(cache));
  EXPECT_TRUE(session.takes_part(1));
  EXPECT_EQ(session.belief().member(1), prior);
  EXPECT_EQ(session.belief().common(), prior) << "not everybody knows anything";
  EXPECT_EQ(session.belief().joint(), returned.belief().joint());
  EXPECT_EQ(session.belief().member(0), returned.belief().member(0));
  EXPECT_NE(session, returned);
  session.show();
  EXPECT_NE(session.belief().member(1), prior);
}

// Whoever leaves again before their first lesson is still new when they return.
TEST(SessionEvents, NothingIsKnownAboutWhoTakesAPlaceAndReturns) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "individual-low", 2, quick());
  const auto prior = session.belief().member(1);
  ASSERT_TRUE(session.propose(cache));
  session.show();
  const auto right = robots_answers(session);
  session.answer(0, right);
  session.answer(1, right);  // the answers of the one who leaves count, but for nobody else
  session.leave(1);
  session.replace(1);
  session.leave(1);
  session.close_tests();
  session.give_feedback();
  session.come_back(1);
  ASSERT_TRUE(session.propose(cache));
  EXPECT_EQ(session.belief().member(1), prior);
}

TEST(SessionEvents, AnswersGivenBeforeLeavingCount) {
  TeachingCache cache{item_delivery()};
  auto stayed = session_of(cache, "common", 2, quick());
  ASSERT_TRUE(stayed.propose(cache));
  stayed.show();
  const auto right = robots_answers(stayed);
  stayed.answer(0, right);
  stayed.answer(1, right);
  auto left = stayed;
  left.leave(1);
  stayed.close_tests();
  left.close_tests();
  EXPECT_EQ(stayed.belief(), left.belief());
  stayed.give_feedback();
  left.give_feedback();
  EXPECT_EQ(stayed.belief().member(0), left.belief().member(0));
  EXPECT_NE(stayed.belief().member(1), left.belief().member(1));
}

TEST(SessionEvents, WhoDoesNotAnswerIsWrong) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "common", 2, quick());
  ASSERT_TRUE(session.propose(cache));
  session.show();
  const auto right = robots_answers(session);
  session.answer(0, right);
  session.close_tests();
  const auto& feedback = session.give_feedback();
  EXPECT_FALSE(feedback.component_learned);
  ASSERT_EQ(feedback.verdicts[1].size(), right.size());
  EXPECT_FALSE(feedback.verdicts[1][0].answered);
}

TEST(SessionEvents, NobodyThereNoLesson) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "common", 1, quick());
  session.leave(0);
  EXPECT_THROW(session.propose(cache), Error);
  session.come_back(0);
  EXPECT_TRUE(session.propose(cache));
}

// Sessions on several threads over one atlas, with caches that go from thread to thread.
TEST(SessionEvents, ThreadsShareAnAtlasAndHandCachesOn) {
  const auto taught = [](TeachingCache& cache, std::uint64_t seed) {
    auto session = session_of(cache, "joint", 2, quick(3), seed);
    auto random = RandomStream{seed}.split("answers");
    while (session.propose(cache)) {
      std::vector<std::vector<Answer>> answers(2);
      for (auto& list : answers) {
        for (const auto& test : session.lesson().tests) {
          const auto paths = item_delivery().tables().coverage_set(test.start);
          list.emplace_back(paths[uniform_index(paths.size(), random)]);
        }
      }
      session.submit(answers);
    }
    return session;
  };
  constexpr std::size_t kThreads = 3;
  std::vector<TeachingCache> caches;
  for (std::size_t i = 0; i < kThreads; ++i) caches.emplace_back(item_delivery());
  for (std::size_t round = 0; round < 3; ++round) {
    std::vector<std::optional<Session>> sessions(kThreads);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < kThreads; ++i) {
      threads.emplace_back([&, i] { sessions[i] = taught(caches[(i + round) % kThreads], i); });
    }
    for (auto& thread : threads) thread.join();
    TeachingCache own{item_delivery()};
    for (std::size_t i = 0; i < kThreads; ++i) EXPECT_EQ(*sessions[i], taught(own, i));
  }
}

// The cache may be trimmed, exchanged and handed to another thread while sessions live.
TEST(SessionEvents, NeitherCacheNorThreadMatters) {
  TeachingCache cache{item_delivery()};
  auto session = session_of(cache, "joint", 2, quick());
  auto other = session;
  TeachingCache small{item_delivery(), 1};  // forgets everything before each lesson
  for (int period = 0; period < 4 && session.propose(cache); ++period) {
    std::thread{[&] { other.propose(period % 2 == 0 ? small : cache); }}.join();
    ASSERT_EQ(session, other);
    auto random = RandomStream{9}.split(static_cast<std::uint64_t>(period));
    std::vector<std::vector<Answer>> answers(2);
    for (auto& list : answers) {
      for (const auto& test : session.lesson().tests) {
        const auto& paths = item_delivery().tables().coverage_set(test.start);
        list.emplace_back(paths[uniform_index(paths.size(), random)]);
      }
    }
    session.submit(answers);
    other.submit(answers);
  }
  EXPECT_GT(session.periods(), 2u);
}

}  // namespace
}  // namespace kith
