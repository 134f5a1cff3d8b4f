#include "kith/mdp/mdp.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <concepts>
#include <limits>
#include <stdexcept>

#include "small_mdps.hpp"

namespace kith {
namespace {

using testing::make_mdp;
using Transitions = std::vector<MdpBuilder::Transition>;

static_assert(!std::convertible_to<int, StateIndex>);
static_assert(!std::equality_comparable_with<StateIndex, ActionIndex>);

// 0 -> 1 -> terminal 3, 1 -> 0, and 2 is a dead end that 0 can enter.
Mdp forked_chain() {
  return make_mdp(3, 1, {{0, 0, 1, {1, 0}}, {0, 2, 2, {0, 0}}, {1, 0, 3, {1, 0}}, {1, 1, 0, {0, 2}}});
}

TEST(Mdp, KeepsChoicesByStateInActionOrder) {
  const Mdp mdp = forked_chain();
  EXPECT_EQ(mdp.num_states(), 3u);
  EXPECT_EQ(mdp.num_terminals(), 1u);
  ASSERT_EQ(mdp.choices(StateIndex{0}).size(), 2u);
  EXPECT_EQ(mdp.choices(StateIndex{0})[1].action, ActionIndex{2});
  EXPECT_TRUE(mdp.choices(StateIndex{2}).empty());
  const Outcome& back = testing::outcome(mdp, StateIndex{1}, 1);
  EXPECT_EQ(back.next, StateIndex{0});
  EXPECT_THAT(mdp.features(back), ::testing::ElementsAre(0.0, 2.0));
  EXPECT_EQ(mdp.integer_features(back), (IntegerVector{0, 2}));
}

TEST(Mdp, SharesEqualFeatureRows) {
  const Mdp mdp = forked_chain();
  EXPECT_EQ(mdp.num_feature_rows(), 3u);
  EXPECT_EQ(testing::outcome(mdp, StateIndex{0}, 0).feature_row, testing::outcome(mdp, StateIndex{1}, 0).feature_row);
  const Mdp zeros = make_mdp(1, 1, {{0, 0, 1, {0.0}}, {0, 1, 1, {-0.0}}});
  EXPECT_EQ(zeros.num_feature_rows(), 1u);
}

TEST(Mdp, KnowsWhichFeaturesOccur) {
  const Mdp mdp = make_mdp(1, 1, {{0, 0, 1, {0, -2, 0}}, {0, 1, 1, {0, 0, 0.5}}});
  EXPECT_FALSE(mdp.has_feature(0));
  EXPECT_TRUE(mdp.has_feature(1));
  EXPECT_TRUE(mdp.has_feature(2));
}

TEST(Mdp, IsIntegralOnlyWithoutFractionsAndHugeNumbers) {
  EXPECT_TRUE(make_mdp(1, 1, {{0, 0, 1, {-3}}}).is_integral());
  EXPECT_FALSE(make_mdp(1, 1, {{0, 0, 1, {0.5}}}).is_integral());
  EXPECT_FALSE(make_mdp(1, 1, {{0, 0, 1, {0x1p31}}}).is_integral());
  const Mdp fractional = make_mdp(1, 1, {{0, 0, 1, {0.5}}});
  EXPECT_THROW((void)fractional.integer_feature_row(0), std::invalid_argument);
}

TEST(Mdp, IsDeterministicUntilAChoiceHasTwoOutcomes) {
  MdpBuilder builder{1, 2, 1, 1, 1.0};
  builder.add_choice(StateIndex{0}, ActionIndex{0},
                     Transitions{{StateIndex{1}, 0.25, {1}}, {StateIndex{2}, 0.75, {0}}});
  EXPECT_FALSE(std::move(builder).build().is_deterministic());
  EXPECT_TRUE(forked_chain().is_deterministic());
}

TEST(Mdp, ListsEveryWayIntoAState) {
  RandomStream random{4};
  for (int i = 0; i < 100; ++i) {
    const Mdp mdp = testing::random_mdp(6, random);
    std::size_t num_arrivals = 0;
    for (std::size_t s = 0; s < mdp.num_states() + mdp.num_terminals(); ++s) {
      for (const Arrival& arrival : mdp.arrivals(StateIndex{s})) {
        const Outcome& step = testing::outcome(mdp, arrival.from, arrival.choice);
        EXPECT_EQ(step.next, StateIndex{s});
        EXPECT_EQ(step.feature_row, arrival.feature_row);
        ++num_arrivals;
      }
    }
    std::size_t num_choices = 0;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) num_choices += mdp.choices(StateIndex{s}).size();
    EXPECT_EQ(num_arrivals, num_choices);
  }
}

TEST(Mdp, OrdersStatesByStepsToATerminalStateAndOmitsStrandedOnes) {
  EXPECT_THAT(forked_chain().by_distance(), ::testing::ElementsAre(StateIndex{1}, StateIndex{0}));
}

TEST(Mdp, RefusesStatesAndRowsThatItDoesNotHave) {
  const Mdp mdp = forked_chain();
  EXPECT_THROW((void)mdp.choices(StateIndex{3}), std::invalid_argument);
  EXPECT_THROW((void)mdp.arrivals(StateIndex{4}), std::invalid_argument);
  EXPECT_THROW((void)mdp.integer_feature_row(3), std::invalid_argument);
}

TEST(MdpBuilder, RejectsBadSizes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double discount : {0.0, -0.5, 1.01, nan}) {
    EXPECT_THROW((MdpBuilder{1, 1, 1, 1, discount}), std::invalid_argument) << discount;
  }
  EXPECT_THROW((MdpBuilder{1, 1, 1, 0, 1.0}), std::invalid_argument);
  EXPECT_THROW((MdpBuilder{1, 1, 1, 9, 1.0}), std::invalid_argument);
  EXPECT_THROW((MdpBuilder{std::size_t{1} << 32, 1, 1, 1, 1.0}), std::invalid_argument);
  EXPECT_NO_THROW((MdpBuilder{1, 1, 1, 8, 0.001}));
}

class MdpBuilderRejects : public ::testing::Test {
 protected:
  void expect_rejected(std::size_t s, std::size_t action, const Transitions& transitions) {
    EXPECT_THROW(builder_.add_choice(StateIndex{s}, ActionIndex{action}, transitions), std::invalid_argument);
  }

  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  MdpBuilder builder_{3, 1, 2, 2, 1.0};  // states 0, 1, 2 and the terminal 3
  Transitions good_{{StateIndex{3}, 1.0, {1, 0}}};
};

TEST_F(MdpBuilderRejects, IndicesOutOfRange) {
  expect_rejected(3, 0, good_);
  expect_rejected(0, 2, good_);
  expect_rejected(0, 0, {{StateIndex{4}, 1.0, {1, 0}}});
}

TEST_F(MdpBuilderRejects, StatesAndActionsOutOfOrder) {
  builder_.add_choice(StateIndex{1}, ActionIndex{1}, good_);
  expect_rejected(0, 0, good_);
  expect_rejected(1, 0, good_);
  expect_rejected(1, 1, good_);
  EXPECT_NO_THROW(builder_.add_choice(StateIndex{2}, ActionIndex{0}, good_));
}

TEST_F(MdpBuilderRejects, BadFeatures) {
  expect_rejected(0, 0, {{StateIndex{3}, 1.0, {1}}});
  expect_rejected(0, 0, {{StateIndex{3}, 1.0, {1, 0, 0}}});
  expect_rejected(0, 0, {{StateIndex{3}, 1.0, {1, kNan}}});
  expect_rejected(0, 0, {{StateIndex{3}, 1.0, {kInfinity, 0}}});
}

TEST_F(MdpBuilderRejects, BadProbabilities) {
  expect_rejected(0, 0, {});
  expect_rejected(0, 0, {{StateIndex{3}, 0.9, {1, 0}}});
  expect_rejected(0, 0, {{StateIndex{3}, kNan, {1, 0}}});
  expect_rejected(0, 0, {{StateIndex{3}, 1.5, {1, 0}}, {StateIndex{1}, -0.5, {1, 0}}});
  expect_rejected(0, 0, {{StateIndex{3}, 1.0, {1, 0}}, {StateIndex{1}, 0.0, {1, 0}}});
  expect_rejected(0, 0, {{StateIndex{3}, 1.0 - 2e-9, {1, 0}}});
  EXPECT_NO_THROW(
      builder_.add_choice(StateIndex{0}, ActionIndex{0}, Transitions{{StateIndex{3}, 1.0 - 5e-10, {1, 0}}}));
}

TEST_F(MdpBuilderRejects, ActionsThatChangeNothing) {
  expect_rejected(0, 0, {{StateIndex{0}, 1.0, {1, 0}}});
  EXPECT_NO_THROW(builder_.add_choice(StateIndex{0}, ActionIndex{0},
                                      Transitions{{StateIndex{0}, 0.5, {1, 0}}, {StateIndex{3}, 0.5, {1, 0}}}));
}

TEST_F(MdpBuilderRejects, ButARejectedChoiceLeavesNoTrace) {
  expect_rejected(0, 0, {{StateIndex{3}, 0.5, {1, 7}}});
  builder_.add_choice(StateIndex{0}, ActionIndex{0}, good_);
  const Mdp mdp = std::move(builder_).build();
  EXPECT_EQ(mdp.choices(StateIndex{0}).size(), 1u);
  EXPECT_FALSE(mdp.has_feature(1));
  EXPECT_TRUE(mdp.is_deterministic());
}

}  // namespace
}  // namespace kith
