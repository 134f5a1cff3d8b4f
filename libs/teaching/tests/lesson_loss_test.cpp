#include "../src/lesson_loss.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "item_delivery.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/exam_worth.hpp"

namespace kith {
namespace {

using testing::item_delivery;
using Members = std::vector<std::vector<MemberHypothesis>>;

class LessonLossTest : public ::testing::Test {
 protected:
  [[nodiscard]] LessonLoss loss_of(const Members& members, const std::vector<std::uint64_t>& tie_breaks,
                                   const LessonLoss::Options& options = {.points = 500}) {
    return LessonLoss{cache_, kAll, members, tie_breaks, options, RandomStream{8}};
  }
  // After a demonstration of everything that there is to know, and feedback that repeats it.
  [[nodiscard]] double after_everything(LessonLoss& loss) const {
    const auto all = item_delivery().knowledge_components()[kAll].constraints.without(item_delivery().prior());
    auto product = loss.before();
    loss.show(product, all);
    loss.repeat(product, all);
    return loss.of(product);
  }

  static constexpr std::size_t kAll = 2;  // the last component
  TeachingCache cache_{item_delivery()};
  ParticleBelief novice_{item_delivery().prior_cone(), FilterOptions{.particles = 500}};
  ParticleBelief expert_ = [] {
    ParticleBelief belief{item_delivery().prior_cone(), FilterOptions{.particles = 500}};
    belief.observe(item_delivery().policy_bec_half_spaces(), HalfSpaceLikelihood{0.95}, RandomStream{1});
    return belief;
  }();
};

TEST_F(LessonLossTest, OfNothingIsTheLogarithmOfTheExpectedRegret) {
  auto loss = loss_of({{{1.0, &novice_, 0.8, 0.8}}}, {1});
  double regret = 0.0;
  for (std::size_t i = 0; i < novice_.size(); ++i) {
    regret += novice_.weights()[i] *
              cache_.exam().table()->component(cache_.behaviours().locate(novice_.point(i)), kAll).regret;
  }
  const double floor = 0.001 * cache_.worth_of(kAll).before().regret;
  EXPECT_NEAR(loss.of(loss.before()), std::log(regret + floor), 1e-9);
}

TEST_F(LessonLossTest, FallsWithWhatIsShownAndWithAbility) {
  double before = std::numeric_limits<double>::infinity();
  for (const double ability : {0.75, 0.85, 0.95}) {
    auto loss = loss_of({{{1.0, &novice_, ability, ability}}}, {1});
    const double after = after_everything(loss);
    EXPECT_LT(after, loss.of(loss.before()));
    EXPECT_LT(after, before);
    before = after;
  }
}

TEST_F(LessonLossTest, DoesNotLookAtSeats) {
  const Members members{{{1.0, &novice_, 0.7, 0.7}}, {{1.0, &expert_, 0.9, 0.9}}};
  auto one = loss_of(members, {5, 9});
  auto other = loss_of({members[1], members[0]}, {9, 5});
  EXPECT_EQ(after_everything(one), after_everything(other));
}

TEST_F(LessonLossTest, WeighsHypotheses) {
  const auto alone = [&](const ParticleBelief& belief) {
    auto loss = loss_of({{{1.0, &belief, 0.8, 0.8}}}, {1});
    return loss.of(loss.before());
  };
  auto mixed = loss_of({{{1.0, &novice_, 0.8, 0.8}, {3.0, &expert_, 0.8, 0.8}}}, {1});
  EXPECT_NEAR(mixed.of(mixed.before()), 0.25 * alone(novice_) + 0.75 * alone(expert_), 0.2);
}

TEST_F(LessonLossTest, HasThreeObjectives) {
  const auto of = [&](TeachingObjective objective) {
    auto loss = loss_of({{{1.0, &novice_, 0.8, 0.8}}, {{1.0, &expert_, 0.8, 0.8}}}, {1, 2},
                        {.objective = objective, .points = 500});
    return loss.of(loss.before());
  };
  EXPECT_GT(of(TeachingObjective::kWorstMember), of(TeachingObjective::kRegret));
  EXPECT_LT(of(TeachingObjective::kRight), 0.0);  // a logarithm of a share
}

// What imitators get wrong does not depend on what they believe.
TEST_F(LessonLossTest, CountsImitation) {
  MemberHypothesis imitator{1.0, &novice_, 0.8, 0.8, {.probability = 1.0, .temperature = 2.0}};
  auto loss = loss_of({{imitator}}, {1});
  EXPECT_EQ(after_everything(loss), loss.of(loss.before()));
  EXPECT_LT(loss.of(loss.before(), 0.5), loss.of(loss.before(), 1.0));
  EXPECT_EQ(loss.imitation().temperature, 2.0);
}

TEST_F(LessonLossTest, GradesASampleWhereNothingIsTabulated) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  TeachingCache cache{atlas};
  const auto of = [&](const ParticleBelief& belief) {
    const Members members{{{1.0, &belief, 0.8, 0.8}}};
    LessonLoss loss{cache, kAll, members, std::vector<std::uint64_t>{1}, {.points = 100}, RandomStream{8}};
    return loss.of(loss.before());
  };
  EXPECT_LT(of(expert_), of(novice_));
  auto exact = loss_of({{{1.0, &novice_, 0.8, 0.8}}}, {1});
  EXPECT_NEAR(of(novice_), exact.of(exact.before()), 0.5);
}

}  // namespace
}  // namespace kith
