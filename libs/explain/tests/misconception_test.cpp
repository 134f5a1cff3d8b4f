#include "kith/explain/misconception.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "atlases.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

const Domain& delivery() { return testing::atlas_of("item-delivery").domain(); }
constexpr std::size_t kStep = 2;

// What somebody thinks who violates the constraint but agrees with it for `n` fewer or more steps; 0: no limit.
std::string thinks(const IntegerVector& violated, std::int64_t n = 0) {
  const HalfSpace constraint{violated};
  if (n == 0) return in_words(delivery(), Misbelief{.violated = constraint, .limit = {}, .unit = kStep});
  return in_words(delivery(), weakened(delivery(), constraint, kStep, n).value());
}

TEST(Misbelief, IsToldOfWhatIsWorthMoreThanPeopleThink) {
  EXPECT_EQ(thinks({-1, 0, 2}), "crossing rubble costs at most 2 steps");
  EXPECT_EQ(thinks({-1, 0, 2}, 1), "crossing rubble costs more than a step, but at most 2 steps");
  EXPECT_EQ(thinks({-1, 0, 2}, 2), "crossing rubble costs something, but at most 2 steps");
  EXPECT_EQ(thinks({-1, 0, 2}, 3), "crossing rubble costs at most 2 steps");
  EXPECT_EQ(thinks({-1, 0, 0}), "crossing rubble costs nothing");
  EXPECT_EQ(thinks({0, 1, 2}), "stopping at the charger is worth at most what 2 steps cost");
  EXPECT_EQ(thinks({0, 1, 2}, 1),
            "stopping at the charger is worth more than what a step costs, but at most what 2 steps cost");
  EXPECT_EQ(thinks({1, 1, 0}), "stopping at the charger is worth at most what crossing rubble costs");
}

TEST(Misbelief, IsToldOfWhatIsWorthLessThanPeopleThink) {
  EXPECT_EQ(thinks({1, 0, -4}), "crossing rubble costs at least 4 steps");
  EXPECT_EQ(thinks({1, 0, -4}, 2), "crossing rubble costs at least 4 steps, but less than 6 steps");
  EXPECT_EQ(thinks({0, -1, -4}, 1),
            "stopping at the charger is worth at least what 4 steps cost, but less than what 5 steps cost");
  EXPECT_EQ(thinks({-1, -1, -2}, 2),
            "stopping at the charger is worth at least what crossing rubble and 2 steps cost, but less than what "
            "crossing rubble and 4 steps cost");
}

TEST(Misbelief, IsTheOppositeWhereWordsDoNotFit) {
  EXPECT_EQ(thinks({-1, 0, -2}), in_words(delivery(), HalfSpace{{1, 0, 2}}));
}

TEST(Misbelief, IsSaidCarefullyWhereTheRobotIsIndifferent) {
  EXPECT_EQ(thinks({-1, 0, 3}), "crossing rubble costs less than 3 steps");
  EXPECT_EQ(thinks({1, 0, -3}), "crossing rubble costs more than 3 steps");
}

TEST(Misbelief, KnowsWhatThePersonSatisfies) {
  const HalfSpace constraint{{-1, 0, 2}};
  EXPECT_EQ(weakened(delivery(), constraint, kStep, 1)->satisfied(), (HalfSpace{{-1, 0, 1}}));
  EXPECT_EQ(weakened(delivery(), HalfSpace{{1, 0, -4}}, kStep, 2)->satisfied(), (HalfSpace{{1, 0, -6}}));
  EXPECT_FALSE(weakened(delivery(), HalfSpace{{0, 0, 1}}, kStep, 1).has_value());
  EXPECT_FALSE((Misbelief{.violated = constraint, .limit = {}, .unit = kStep}.satisfied().has_value()));
}

TEST(Predictions, AreToldAsReasonsAre) {
  const auto& domain = delivery();
  EXPECT_EQ(prediction_in_words(domain, {1, 0, 6}, {0, 0, 8}), "it would rather cross rubble than take 2 more steps");
  EXPECT_EQ(prediction_in_words(domain, {0, 0, 8}, {0, 1, 10}), "it will not take 2 more steps to stop at the charger");
  EXPECT_EQ(prediction_in_words(domain, {0, 0, 8}, {0, 0, 6}), "it would take 2 more steps for nothing");
  EXPECT_EQ(prediction_in_words(domain, {0, 0, 6}, {0, 1, 6}),
            "it would not stop at the charger, although that costs nothing");
  EXPECT_THROW(static_cast<void>(prediction_in_words(domain, {0, 0, 6}, {0, 0, 8})), std::invalid_argument);
}

}  // namespace
}  // namespace kith
