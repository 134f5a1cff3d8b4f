// Lessons where behaviours are not tabulated: what is brought up, and what is examined.
#include <gtest/gtest.h>

#include <algorithm>

#include "item_delivery.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/teaching/session.hpp"

namespace kith {
namespace {

const Atlas& delivery_on_demand() {
  static const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  return atlas;
}

// The first lesson about all features, for a team of two.
Lesson first_lesson(const Atlas& atlas, std::string_view strategy, std::size_t max_demonstrations) {
  TeachingCache cache{atlas};
  const auto random = RandomStream{8};
  TeachingOptions options;
  options.filter.particles = 200;
  options.scaffold = Scaffold::kNone;
  options.max_demonstrations = max_demonstrations;
  Session session{
      cache, options, strategy_named(strategy), {random.split(1), random.split(2)}, random.split("teacher")};
  EXPECT_TRUE(session.propose(cache));
  return session.lesson();
}

bool implies(const Atlas& atlas, std::vector<HalfSpace> half_spaces, const HalfSpace& facet) {
  const auto prior = atlas.constraints().half_spaces(atlas.prior());
  half_spaces.insert(half_spaces.end(), prior.begin(), prior.end());
  const auto region = Cone::intersection(half_spaces);
  return region && region->implies(facet);
}

std::vector<HalfSpace> covered_by_tests(const Lesson& lesson) {
  std::vector<HalfSpace> covered;
  for (const auto& test : lesson.tests) covered.insert(covered.end(), test.covered.begin(), test.covered.end());
  return covered;
}

// One demonstration does not convey everything.
TEST(OnDemandLessons, ExamineTheWholeComponentWhateverTheLessonLeavesOut) {
  const auto& facets = delivery_on_demand().policy_bec_half_spaces();
  const auto lesson = first_lesson(delivery_on_demand(), "joint", 1);
  EXPECT_EQ(lesson.untested, 0u);
  std::size_t left_out = 0;
  for (const auto& facet : facets) {
    left_out += implies(delivery_on_demand(), lesson.taught, facet) ? 0u : 1u;
    EXPECT_TRUE(implies(delivery_on_demand(), covered_by_tests(lesson), facet)) << to_string(facet.normal());
  }
  EXPECT_GT(left_out, 0u);
}

// By a strategy that chooses its tests itself.
TEST(OnDemandLessons, ExamineWhatWasTaughtAlone) {
  for (const auto* atlas : {&testing::item_delivery(), &delivery_on_demand()}) {
    const auto lesson = first_lesson(*atlas, "plan", 1);
    ASSERT_FALSE(lesson.tests.empty());
    for (const auto& covered : covered_by_tests(lesson)) {
      EXPECT_NE(std::find(lesson.taught.begin(), lesson.taught.end(), covered), lesson.taught.end());
    }
  }
}

}  // namespace
}  // namespace kith
