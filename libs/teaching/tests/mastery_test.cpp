// How long a component is taught, and what it may show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/session.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::HasSubstr;
using testing::item_delivery;
using ::testing::ThrowsMessage;

std::vector<RandomStream> two_people() { return {RandomStream{7}.split("anna"), RandomStream{7}.split("ben")}; }

Session session_of_two(TeachingCache& cache, std::string_view strategy, const TeachingOptions& options) {
  return {cache, options, strategy_named(strategy), two_people(), RandomStream{7}.split("teacher")};
}

// Everybody answers as the robot would; or nobody answers.
std::vector<std::vector<Answer>> answers_to(const Session& session, bool right) {
  std::vector<Answer> answers;
  for (const auto& test : session.lesson().tests) {
    answers.push_back(right ? Answer{item_delivery().feature_counts(test.start)} : Answer{});
  }
  return std::vector(session.num_members(), answers);
}

TEST(Mastery, FixedTeachesEveryComponentEquallyLong) {
  TeachingCache cache{item_delivery()};
  for (const bool right : {true, false}) {
    auto session = session_of_two(
        cache, "plan",
        {.scaffold = Scaffold::kFeatures, .mastery = stop_rule_named("fixed"), .periods_per_component = 2});
    while (session.propose(cache)) session.submit(answers_to(session, right));
    EXPECT_EQ(session.status(), SessionStatus::kComplete);
    ASSERT_EQ(session.periods(), 6u);
    for (std::size_t p = 0; p < 6; ++p) EXPECT_EQ(session.history()[p].lesson.component, p / 2);
  }
}

TEST(Mastery, PosteriorStopsOnceItIsSureEnough) {
  TeachingCache cache{item_delivery()};
  auto periods_for = [&](double probability) {
    auto session = session_of_two(cache, "plan", {.mastery = stop_rule_named("posterior"), .probability = probability});
    while (session.propose(cache)) {
      session.submit(answers_to(session, true));
      EXPECT_THAT(session.level_of_mastery(), ::testing::AllOf(Ge(0.0), ::testing::Le(1.0)));
      if (session.history().back().feedback.component_learned) {
        EXPECT_GE(session.level_of_mastery(), probability);
      }
    }
    return session.periods();
  };
  EXPECT_LT(periods_for(0.6), periods_for(0.95));
}

TEST(Mastery, MinPeriodsHoldsBackThePosterior) {
  TeachingCache cache{item_delivery()};
  const auto periods_of_components = [&](std::size_t min_periods) {
    auto session = session_of_two(
        cache, "joint", {.mastery = stop_rule_named("posterior"), .probability = 0.01, .min_periods = min_periods});
    std::vector<std::size_t> periods(3, 0);
    while (session.propose(cache)) {
      ++periods[session.lesson().component];
      session.submit(answers_to(session, true));
    }
    return periods;
  };
  // The first component also has to show that people learn at all.
  EXPECT_THAT(periods_of_components(1), ElementsAre(Ge(1u), 1u, 1u));
  EXPECT_THAT(periods_of_components(2), ElementsAre(Ge(2u), 2u, 2u));
  EXPECT_THAT(periods_of_components(4), ElementsAre(4u, 4u, 4u));
}

TEST(Mastery, ExamStopsOnceItIsCertainThatEverybodyPredictsEnoughStarts) {
  const Atlas on_demand{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  for (const auto* atlas : {&item_delivery(), &on_demand}) {
    TeachingCache cache{*atlas};
    const auto taught = [&](double share_right, bool right) {
      auto session = session_of_two(
          cache, "joint", {.mastery = stop_rule_named("exam"), .max_periods = 20, .share_right = share_right});
      while (session.propose(cache)) {
        session.submit(answers_to(session, right));
        EXPECT_THAT(session.level_of_mastery(), ::testing::AllOf(Ge(0.0), ::testing::Le(1.0)));
        EXPECT_EQ(session.history().back().feedback.component_learned, session.level_of_mastery() >= 0.9);
      }
      return session;
    };
    const auto lenient = taught(0.5, true), strict = taught(0.999, true);
    EXPECT_LT(lenient.periods(), strict.periods());
    EXPECT_EQ(lenient.status(), SessionStatus::kComplete);
    EXPECT_GE(taught(0.5, false).periods(), lenient.periods());
    auto again =
        session_of_two(cache, "joint", {.mastery = stop_rule_named("exam"), .max_periods = 20, .share_right = 0.999});
    for (const auto& event : strict.events()) again.apply(event, cache);
    EXPECT_EQ(again, strict);
    EXPECT_EQ(again.level_of_mastery(), strict.level_of_mastery());
  }
}

TEST(Mastery, ExamTakesLongerTheMoreCertainItHasToBe) {
  TeachingCache cache{item_delivery()};
  std::size_t least = 0;
  for (const double probability : {0.3, 0.9, 0.99}) {
    auto session = session_of_two(cache, "joint",
                                  {.mastery = stop_rule_named("exam"), .max_periods = 40, .probability = probability});
    while (session.propose(cache)) session.submit(answers_to(session, true));
    EXPECT_EQ(session.status(), SessionStatus::kComplete);
    EXPECT_GE(session.periods(), least);
    least = session.periods();
  }
}

TEST(Mastery, RegretStopsSoonerTheMoreMayBeLost) {
  TeachingCache cache{item_delivery()};
  std::size_t most = 1000;
  for (const double max_regret : {0.05, 0.5, 2.0}) {
    auto rule = stop_rule_named("regret");
    rule.parameters.set("max_regret", max_regret);
    auto session = session_of_two(cache, "joint", {.mastery = rule, .max_periods = 40});
    while (session.propose(cache)) session.submit(answers_to(session, true));
    EXPECT_EQ(session.status(), SessionStatus::kComplete);
    EXPECT_LE(session.periods(), most);
    most = session.periods();
  }
  EXPECT_LT(most, 10u);
  const Atlas on_demand{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  TeachingCache sampled{on_demand};
  EXPECT_THAT([&] { session_of_two(sampled, "joint", {.mastery = stop_rule_named("regret")}); },
              ThrowsMessage<Error>(HasSubstr("tabulated")));
}

TEST(Mastery, MinPeriodsHoldsBackTheExam) {
  TeachingCache cache{item_delivery()};
  auto session =
      session_of_two(cache, "joint", {.mastery = stop_rule_named("exam"), .share_right = 0.01, .min_periods = 2});
  while (session.propose(cache)) session.submit(answers_to(session, true));
  EXPECT_EQ(session.periods(), 6u);
}

TEST(Mastery, ExamNeedsAShareBetweenNothingAndEverything) {
  TeachingCache cache{item_delivery()};
  for (const double share : {0.0, 1.0, -0.5, 2.0}) {
    EXPECT_THROW((session_of_two(cache, "joint", {.mastery = stop_rule_named("exam"), .share_right = share})),
                 std::invalid_argument);
  }
}

// The first member is right at once, the second from the third period of a component on.
std::vector<std::vector<Answer>> answers_of_two_speeds(const Session& session) {
  auto answers = answers_to(session, true);
  const auto of_component = std::count_if(session.history().begin(), session.history().end(), [&](const auto& past) {
    return past.lesson.component == session.lesson().component;
  });
  if (of_component < 2) answers[1] = answers_to(session, false)[1];
  return answers;
}

TEST(Release, SendsMembersAwayUntilTheNextComponent) {
  TeachingCache cache{item_delivery()};
  auto session = session_of_two(cache, "joint", {.release = stop_rule_named("all-right")});
  std::vector<std::size_t> present;
  while (session.propose(cache)) {
    present.push_back((session.takes_part(0) ? 1u : 0u) + (session.takes_part(1) ? 1u : 0u));
    session.submit(answers_of_two_speeds(session));
  }
  EXPECT_EQ(session.status(), SessionStatus::kComplete);
  EXPECT_EQ(present, (std::vector<std::size_t>{2, 1, 1, 2, 1, 1, 2, 1, 1}));
  EXPECT_EQ(session.history()[0].feedback.released, std::vector<std::size_t>{0});
  EXPECT_TRUE(session.history()[1].answers[0].empty());
  // Repeating the events gives the same session: releasing is no event.
  auto again = session_of_two(cache, "joint", {.release = stop_rule_named("all-right")});
  for (const auto& event : session.events()) again.apply(event, cache);
  EXPECT_EQ(again, session);
}

// Those who are released do not have to be right again: everybody needs to be right once.
TEST(Release, NeedsNoPeriodInWhichAllAreRight) {
  TeachingCache cache{item_delivery()};
  const auto periods = [&](std::optional<StopChoice> release) {
    auto session = session_of_two(cache, "joint", {.max_periods = 30, .release = release});
    while (session.propose(cache)) {
      auto answers = answers_to(session, true);
      const auto wrong = session.periods() % 2;  // never both right at the same time
      answers[wrong] = answers_to(session, false)[wrong];
      session.submit(answers);
    }
    return session.periods();
  };
  EXPECT_EQ(periods(std::nullopt), 30u);
  EXPECT_EQ(periods(stop_rule_named("all-right")), 6u);
}

TEST(Release, ByThePosteriorEndsTheComponentOnceEverybodyIsDone) {
  TeachingCache cache{item_delivery()};
  auto session = session_of_two(cache, "joint",
                                {.mastery = stop_rule_named("fixed"),
                                 .periods_per_component = 9,
                                 .probability = 0.5,
                                 .release = stop_rule_named("posterior")});
  while (session.propose(cache)) session.submit(answers_to(session, true));
  EXPECT_LT(session.periods(), 27u);
  EXPECT_EQ(session.status(), SessionStatus::kComplete);
}

TEST(Scaffold, NoneTeachesTheLastComponentAlone) {
  TeachingCache cache{item_delivery()};
  auto session = session_of_two(cache, "joint", {.scaffold = Scaffold::kNone});
  ASSERT_TRUE(session.propose(cache));
  EXPECT_EQ(session.lesson().component, 2u);
  EXPECT_EQ(session.components()[0], ComponentStatus::kSkipped);
  EXPECT_EQ(session.components()[1], ComponentStatus::kSkipped);
  session.submit(answers_to(session, true));
  EXPECT_FALSE(session.propose(cache));
  EXPECT_EQ(session.status(), SessionStatus::kComplete);
}

TEST(Review, StartsEveryComponentFromThePrior) {
  TeachingCache cache{item_delivery()};
  const auto taught_after_two = [&](bool review) {
    auto session = session_of_two(cache, "joint", {.review = review});
    for (int i = 0; i < 2; ++i) {
      EXPECT_TRUE(session.propose(cache));
      session.submit(answers_to(session, true));
    }
    return session.taught_region();
  };
  EXPECT_EQ(taught_after_two(true), item_delivery().prior_cone().minimal_set());
  EXPECT_NE(taught_after_two(false), item_delivery().prior_cone().minimal_set());
}

TEST(MaxDemonstrations, LimitsEveryLesson) {
  TeachingCache cache{item_delivery()};
  for (const auto* strategy : {"joint", "plan"}) {
    auto session = session_of_two(cache, strategy, {.max_demonstrations = 1});
    while (session.propose(cache)) {
      EXPECT_EQ(session.lesson().demonstrations.size(), 1u) << strategy;
      session.submit(answers_to(session, true));
    }
  }
}

TEST(Session, RefusesTheTruthAboutAnotherTeam) {
  TeachingCache cache{item_delivery()};
  auto session = session_of_two(cache, "oracle", {});
  EXPECT_THROW(session.propose(cache, std::vector<MemberTruth>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace kith
