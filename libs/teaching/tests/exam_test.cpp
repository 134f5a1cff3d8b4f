#include "kith/teaching/exam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "item_delivery.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// A belief that has learned all that there is.
ParticleBelief taught_belief(const Atlas& atlas) {
  ParticleBelief belief{atlas.prior_cone(), FilterOptions{.particles = 500}};
  for (std::uint64_t i = 0; i < 8; ++i) {
    belief.observe(atlas.policy_bec_half_spaces(), HalfSpaceLikelihood{0.95}, RandomStream{3}.split(i));
  }
  return belief;
}

TEST(Exam, SaysThatPeopleWhoWereTaughtKnowMore) {
  TeachingCache cache{item_delivery()};
  const ParticleBelief before{item_delivery().prior_cone(), FilterOptions{.particles = 500}};
  const auto first = cache.exam().grade(before, cache.behaviours());
  const auto last = cache.exam().grade(taught_belief(item_delivery()), cache.behaviours());
  EXPECT_GT(last.all.share_right, first.all.share_right);
  EXPECT_LT(last.all.regret, 0.2 * first.all.regret);
  ASSERT_EQ(last.components.size(), 3u);
  // The last component uses all worlds.
  EXPECT_NEAR(last.components[2].share_right, last.all.share_right, 1e-12);
}

TEST(Exam, IsTheExpectationUnderTheBelief) {
  TeachingCache cache{item_delivery()};
  const auto belief = taught_belief(item_delivery());
  const auto grades = cache.exam().grade(belief, cache.behaviours());
  double right = 0.0;
  for (std::size_t i = 0; i < belief.size(); ++i) {
    const auto cell = cache.behaviours().locate(belief.point(i));
    right += belief.weights()[i] * cache.exam().table()->all(cell).share_right;
  }
  EXPECT_NEAR(grades.all.share_right, right, 1e-12);
}

TEST(Exam, SplitsAllStartsIntoThirdsByDifficulty) {
  TeachingCache cache{item_delivery()};
  std::set<StartIndex> all;
  for (const auto difficulty : {ExamDifficulty::kLow, ExamDifficulty::kMedium, ExamDifficulty::kHigh}) {
    const auto starts = cache.exam().starts(difficulty);
    EXPECT_EQ(starts.size(), item_delivery().num_states() / 3);
    all.insert(starts.begin(), starts.end());
  }
  EXPECT_EQ(all.size(), item_delivery().num_states());
}

TEST(Exam, AsksPeopleAboutStartsThatTheyHaveNotMet) {
  TeachingCache cache{item_delivery()};
  const auto starts = cache.exam().starts(ExamDifficulty::kLow);
  const std::vector<StartIndex> seen(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(starts.size() / 2));
  const auto questions = cache.exam().questions(9, seen, RandomStream{5});
  ASSERT_EQ(questions.size(), 9u);
  EXPECT_EQ(questions, cache.exam().questions(9, seen, RandomStream{5}));
  for (const auto question : questions) EXPECT_EQ(std::count(seen.begin(), seen.end(), question), 0);
  const auto low = std::count_if(questions.begin(), questions.end(), [&](StartIndex start) {
    return std::binary_search(starts.begin(), starts.end(), start);
  });
  EXPECT_EQ(low, 3);
}

TEST(Exam, TakesASampleOfStartsWhereNothingIsTabulated) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  TeachingCache cache{atlas};
  const auto grades = cache.exam().grade(taught_belief(atlas), cache.behaviours());
  EXPECT_GT(grades.all.share_right, 0.8);
  EXPECT_LE(grades.all.share_right, 1.0);
  EXPECT_GE(grades.all.regret, 0.0);
  EXPECT_EQ(cache.exam().starts(ExamDifficulty::kHigh).size(), 10u);
}

TEST(Exam, GradesAnAnswerByItsReturn) {
  const auto& atlas = item_delivery();
  const StartIndex start{100};
  EXPECT_EQ(grade_answer(atlas, start, atlas.feature_counts(start)), (Grade{1.0, 0.0}));
  const auto none = grade_answer(atlas, start, std::nullopt);
  EXPECT_EQ(none.share_right, 0.0);
  EXPECT_GT(none.regret, 0.0);
}

}  // namespace
}  // namespace kith
