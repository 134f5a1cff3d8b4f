// What a teacher takes from answers that members revised after they had seen each other's.

#include <gtest/gtest.h>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/teaching/session.hpp"
#include "robots_answers.hpp"

namespace kith {
namespace {

using testing::item_delivery;
using testing::robots_answers;

constexpr std::size_t kMembers = 3;

class Discussions : public ::testing::Test {
 protected:
  // Three members in front of the tests of the first lesson: the first is right, the others are wrong.
  [[nodiscard]] Session answered() {
    auto session = fresh();
    session.propose(cache_);
    session.show();
    session.answer(0, robots_answers(session));
    for (std::size_t i = 1; i < kMembers; ++i) session.answer(i, wrong_answers(session));
    return session;
  }

  [[nodiscard]] Session fresh() {
    TeachingOptions options;
    options.filter.particles = 200;
    options.keep_members = options.keep_rules = options.keep_bank = true;
    const RandomStream root{7};
    std::vector<RandomStream> persons;
    for (std::size_t i = 0; i < kMembers; ++i) persons.push_back(root.split("person").split(i));
    return {cache_, options, strategy_named("common"), persons, root.split("teacher")};
  }

  [[nodiscard]] static std::vector<Answer> wrong_answers(const Session& session) {
    std::vector<Answer> answers;
    for (const auto& test : session.lesson().tests) {
      for (const auto& path : session.atlas().tables().coverage_set(test.start)) {
        if (path == session.atlas().feature_counts(test.start)) continue;
        answers.emplace_back(path);
        break;
      }
    }
    return answers;
  }

  TeachingCache cache_{item_delivery()};
};

TEST_F(Discussions, TwoMembersWhoCopyAThirdDoNotTripleTheEvidence) {
  auto alone = answered(), one = answered(), two = answered();
  const auto right = robots_answers(alone);
  one.discuss({{}, right, {}});
  two.discuss({{}, right, right});
  for (auto* session : {&alone, &one, &two}) session->close_tests();
  // Whoever is copied is not believed the more for it, and neither is what the group knows.
  for (const auto* session : {&one, &two}) {
    EXPECT_EQ(session->belief().common(), alone.belief().common());
    EXPECT_EQ(session->belief().joint(), alone.belief().joint());
    EXPECT_EQ(session->belief().member(0), alone.belief().member(0));
    EXPECT_EQ(session->bank()->member(0), alone.bank()->member(0));
  }
  // Nor does it matter to a member who copies how many others do; each is believed to know more than before.
  EXPECT_EQ(two.belief().member(1), one.belief().member(1));
  for (std::size_t i = 1; i < kMembers; ++i) {
    const auto& covered = two.lesson().tests.front().covered;
    EXPECT_GT(two.belief().member(i).mass_in(covered), alone.belief().member(i).mass_in(covered));
  }
}

TEST_F(Discussions, AnswersThatAreKeptShowNothingASecondTime) {
  auto alone = answered(), talked = answered();
  talked.discuss({robots_answers(talked), {}, wrong_answers(talked)});
  alone.close_tests();
  talked.close_tests();
  EXPECT_EQ(talked.belief(), alone.belief());
}

TEST_F(Discussions, ComponentsGoByTheFirstAnswersAndPeopleHearOfTheirLast) {
  auto session = answered();
  const auto right = robots_answers(session);
  session.discuss({{}, right, right});
  session.close_tests();
  const auto feedback = session.give_feedback();
  EXPECT_FALSE(feedback.component_learned);
  EXPECT_FALSE(feedback.all_correct[1]);
  EXPECT_TRUE(feedback.all_right_in_the_end(1));
  EXPECT_EQ(session.history().back().revised[1], right);
  EXPECT_TRUE(session.history().back().revised[0].empty());
  EXPECT_NE(session.history().back().answers[1], right);
  EXPECT_FALSE(session.has_discussed());
}

TEST_F(Discussions, AreReplayedToTheBit) {
  auto session = answered();
  session.discuss({{}, robots_answers(session), {}});
  session.close_tests();
  session.give_feedback();
  session.propose(cache_);
  auto again = fresh();
  for (const auto& event : session.events()) again.apply(event, cache_);
  EXPECT_EQ(again, session);
}

TEST_F(Discussions, AreRefusedWhereTheyMakeNoSense) {
  auto session = fresh();
  const auto refused = [&](std::vector<std::vector<Answer>> revised) {
    const auto before = session;
    EXPECT_THROW(session.discuss(std::move(revised)), Error);
    EXPECT_EQ(session, before);
  };
  refused({{}, {}, {}});  // there is no lesson
  session.propose(cache_);
  session.show();
  session.answer(0, robots_answers(session));
  refused({{}, {}, {}});  // there is nobody to talk to
  session.answer(1, robots_answers(session));
  refused({{}, {}});                           // one list is missing
  refused({{}, {}, robots_answers(session)});  // this member has given no answers
  refused({{}, {std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt}, {}});
  session.discuss({{}, {}, {}});
  refused({{}, {}, {}});  // a second time
  EXPECT_THROW(session.answer(2, robots_answers(session)), Error);
}

}  // namespace
}  // namespace kith
