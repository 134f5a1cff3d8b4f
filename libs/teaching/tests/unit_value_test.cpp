#include "kith/teaching/unit_value.hpp"

#include <gtest/gtest.h>

#include "item_delivery.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

using testing::item_delivery;

class UnitValueTest : public ::testing::Test {
 protected:
  [[nodiscard]] UnitValue value(std::span<const std::vector<MemberHypothesis>> members,
                                std::span<const std::uint64_t> tie_breaks,
                                const UnitValue::Options& options = {.points = 500}) {
    return UnitValue{cache_, 0, members, tie_breaks, options, RandomStream{8}};
  }
  // What a component conveys when it is understood.
  [[nodiscard]] ConstraintSet all_of_component() const {
    return item_delivery().knowledge_components()[0].constraints.without(item_delivery().prior());
  }

  TeachingCache cache_{item_delivery()};
  ParticleBelief novice_{item_delivery().prior_cone(), FilterOptions{.particles = 500}};
  ParticleBelief expert_ = [] {
    ParticleBelief belief{item_delivery().prior_cone(), FilterOptions{.particles = 500}};
    belief.observe(item_delivery().policy_bec_half_spaces(), HalfSpaceLikelihood{0.95}, RandomStream{1});
    return belief;
  }();
};

TEST_F(UnitValueTest, OfNothingIsWhatMembersKnow) {
  const std::vector<std::vector<MemberHypothesis>> members{{{1.0, &novice_, 0.8, 0.8}}};
  const std::vector<std::uint64_t> ties{1};
  double expected = 0.0;
  for (std::size_t i = 0; i < novice_.size(); ++i) {
    expected +=
        novice_.weights()[i] * cache_.exam().table()->tests_right(cache_.behaviours().locate(novice_.point(i)), 0);
  }
  EXPECT_NEAR(value(members, ties).of_nothing(), expected, 1e-9);
}

TEST_F(UnitValueTest, GrowsWithWhatIsShownAndWithAbility) {
  const std::vector<std::uint64_t> ties{1};
  double before = 0.0;
  for (const double ability : {0.6, 0.8, 0.95}) {
    const std::vector<std::vector<MemberHypothesis>> members{{{1.0, &novice_, ability, ability}}};
    auto units = value(members, ties);
    const std::vector<ConstraintSet> shown{all_of_component()};
    const double after = units.of(shown, all_of_component());
    EXPECT_GT(after, units.of_nothing());
    EXPECT_GT(after, before);
    before = after;
  }
}

TEST_F(UnitValueTest, DoesNotLookAtSeats) {
  const std::vector<std::vector<MemberHypothesis>> members{{{1.0, &novice_, 0.7, 0.7}}, {{1.0, &expert_, 0.9, 0.9}}};
  const std::vector<std::vector<MemberHypothesis>> swapped{members[1], members[0]};
  const std::vector<ConstraintSet> shown{all_of_component()};
  EXPECT_EQ(value(members, std::vector<std::uint64_t>{5, 9}).of(shown, all_of_component()),
            value(swapped, std::vector<std::uint64_t>{9, 5}).of(shown, all_of_component()));
}

TEST_F(UnitValueTest, WeighsHypotheses) {
  const std::vector<std::uint64_t> ties{1};
  const auto alone = [&](const ParticleBelief& belief) {
    const std::vector<std::vector<MemberHypothesis>> members{{{1.0, &belief, 0.8, 0.8}}};
    return value(members, ties).of_nothing();
  };
  const std::vector<std::vector<MemberHypothesis>> mixed{{{1.0, &novice_, 0.8, 0.8}, {3.0, &expert_, 0.8, 0.8}}};
  EXPECT_NEAR(value(mixed, ties).of_nothing(), 0.25 * alone(novice_) + 0.75 * alone(expert_), 0.02);
}

TEST_F(UnitValueTest, HasThreeObjectives) {
  const std::vector<std::vector<MemberHypothesis>> members{{{1.0, &novice_, 0.8, 0.8}}, {{1.0, &expert_, 0.8, 0.8}}};
  const std::vector<std::uint64_t> ties{1, 2};
  const auto of = [&](TeachingObjective objective) {
    return value(members, ties, {.objective = objective, .points = 500}).of_nothing();
  };
  EXPECT_LT(of(TeachingObjective::kWorstMember), of(TeachingObjective::kRight));
  EXPECT_LT(of(TeachingObjective::kRegret), 0.0);
}

TEST_F(UnitValueTest, CountsSatisfiedFacetsWhereNothingIsTabulated) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  TeachingCache cache{atlas};
  const std::vector<std::vector<MemberHypothesis>> members{{{1.0, &expert_, 0.8, 0.8}}};
  UnitValue units{cache, 2, members, std::vector<std::uint64_t>{1}, {.points = 500}, RandomStream{8}};
  EXPECT_GT(units.of_nothing(), 0.5);
  EXPECT_LE(units.of_nothing(), 1.0 + 1e-9);
}

}  // namespace
}  // namespace kith
