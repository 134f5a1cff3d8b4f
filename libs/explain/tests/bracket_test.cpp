#include "kith/explain/bracket.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>
#include <utility>

#include "atlases.hpp"
#include "discounted_domains.hpp"
#include "kith/core/distributions.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

using testing::atlas_of;

// { w : denominator * sign * w_k <= numerator * sign * |w_r| }, the reference being of a known sign.
HalfSpace beyond(const Domain& domain, const Bracket& bracket, const Ratio& end, int side, int sign_of_reference) {
  IntegerVector normal(domain.num_features());
  normal[bracket.feature] = side * end.denominator;
  normal[bracket.reference] = -side * end.numerator * sign_of_reference;
  return HalfSpace{normal};
}

// `scale` times finer and one step further in.
Ratio inside(const Ratio& end, int side, std::int64_t scale) {
  return {end.numerator * scale + side, end.denominator * scale};
}

// An end follows from the region, and nothing beyond it does; where there is no end, no number is one.
void expect_exact(const Domain& domain, const Cone& region, const Bracket& bracket) {
  const int sign = domain.weights().integer[bracket.reference] < 0 ? -1 : 1;
  constexpr std::int64_t kFine = 1000;
  for (const int side : {1, -1}) {  // 1: the low end
    const auto& end = side > 0 ? bracket.low : bracket.high;
    if (end) {
      EXPECT_TRUE(region.implies(beyond(domain, bracket, *end, side, sign)));
      EXPECT_FALSE(region.implies(beyond(domain, bracket, inside(*end, side, kFine), side, sign)));
    } else {
      EXPECT_FALSE(region.implies(beyond(domain, bracket, {-side * kFine, 1}, side, sign)));
    }
  }
}

TEST(Bracket, EndsAreThoseOfTheRegion) {
  RandomStream random{38};
  std::size_t closed = 0;
  for (const std::string name : {"item-delivery", "skateboard", "cookie-crumb", "navigation", "warehouse"}) {
    const auto& atlas = atlas_of(name);
    const auto& domain = atlas.domain();
    const auto& components = atlas.knowledge_components();
    const auto reference = reference_feature(domain, components);
    const auto& features = components.back().features;
    const auto all = atlas.policy_bec_half_spaces();
    for (int round = 0; round < 40; ++round) {
      auto known = domain.prior();
      for (const auto& half_space : all) {
        if (uniform_index(2, random) == 0) known.push_back(half_space);
      }
      Cone region{domain.num_features()};
      ASSERT_TRUE(region.clip(known));
      const auto found = brackets(domain, known, features, reference);
      for (const auto& bracket : found) {
        expect_exact(domain, region, bracket);
        closed += bracket.low && bracket.high ? 1u : 0u;
        EXPECT_FALSE(bracket_in_words(domain, bracket).empty());
        const double truth = domain.weights().raw[bracket.feature] / std::abs(domain.weights().raw[reference]);
        EXPECT_LE(bracket.low ? bracket.low->value() : truth, truth + 1e-9);
        EXPECT_GE(bracket.high ? bracket.high->value() : truth, truth - 1e-9);
      }
    }
  }
  EXPECT_GT(closed, 50u);
}

TEST(Bracket, ClosesAsALessonGoesOn) {
  const auto& atlas = atlas_of("item-delivery");
  const auto curriculum = make_curriculum(atlas);
  std::vector<std::string> said;
  for (const auto& component : curriculum.components) {
    for (const auto& shown : component.demonstrations) {
      for (const auto& bracket : shown.brackets) said.push_back(bracket_in_words(atlas.domain(), bracket));
    }
  }
  EXPECT_EQ(said,
            (std::vector<std::string>{
                "crossing rubble costs more than 2 steps", "crossing rubble costs 2 to 4 steps",
                "stopping at the charger is worth more than 2 steps", "stopping at the charger is worth 2 to 4 steps",
                "crossing rubble costs 2 to 4 steps", "stopping at the charger is worth 2 to 4 steps"}));
}

TEST(Bracket, IsSaidInWholeNumbers) {
  const auto& domain = atlas_of("item-delivery").domain();
  const auto cost = [&](std::optional<Ratio> low, std::optional<Ratio> high) {
    return bracket_in_words(domain, {0, 2, low, high});
  };
  EXPECT_EQ(cost(Ratio{-2, 1}, Ratio{-5, 3}), "crossing rubble costs 1 to 2 steps");
  EXPECT_EQ(cost(Ratio{-7, 3}, Ratio{-2, 1}), "crossing rubble costs 2 to 3 steps");
  EXPECT_EQ(cost(Ratio{-168, 1000}, Ratio{-167, 1000}), "crossing rubble costs less than a step");
  EXPECT_EQ(cost(Ratio{-303, 100}, Ratio{-294, 100}), "crossing rubble costs about 3 steps");
  EXPECT_EQ(cost({}, Ratio{-1, 1000}), "crossing rubble costs something");
  EXPECT_EQ(cost(Ratio{-41, 4}, Ratio{-10, 1}), "crossing rubble costs 10 to 11 steps");
  EXPECT_EQ(cost(Ratio{0, 1}, Ratio{0, 1}), "crossing rubble costs nothing");
  EXPECT_EQ(cost({}, Ratio{1, 3}), "crossing rubble is worth less than a step");
}

// Whatever the ends: what is printed contains them, or is the one number that both are within a tenth of.
TEST(Bracket, RoundsItsEndsOutwards) {
  const auto& exact = atlas_of("item-delivery").domain();
  const auto rounded = testing::discounted_domain("item-delivery", 0.9);
  auto random = RandomStream{16};
  for (int trial = 0; trial < 5000; ++trial) {
    const auto draw = [&] {
      const auto bits = static_cast<int>(uniform_index(40, random));
      const auto numerator =
          static_cast<std::int64_t>(uniform_index(std::size_t{1} << static_cast<unsigned>(bits), random));
      const auto denominator = static_cast<std::int64_t>(1 + uniform_index(std::size_t{1} << 20u, random));
      const auto divisor = std::gcd(numerator, denominator);
      return Ratio{numerator / divisor, denominator / divisor};
    };
    auto low = draw(), high = trial % 3 == 0 ? Ratio{low.numerator + 1, low.denominator} : draw();
    if (high.value() < low.value()) std::swap(low, high);
    const auto ends = ends_of(trial % 2 == 0 ? exact : rounded, {0, 2, low, high});
    const double from = std::stod(ends.from), to = std::stod(ends.to), near = from == to ? 0.1 + 1e-12 : 0.0;
    EXPECT_LE(from, low.value() + near);
    EXPECT_GE(to, high.value() - near);
    EXPECT_TRUE(from != to || (from >= low.value() - near && to <= high.value() + near));
    EXPECT_EQ(ends.to == "0", high.numerator == 0);
  }
}

TEST(Bracket, SaysNothingWhereTheReferenceIsUnknown) {
  const auto& domain = atlas_of("item-delivery").domain();
  EXPECT_TRUE(brackets(domain, {}, std::vector<std::size_t>{0, 1}, 2).empty());
}

// Just inside of an end nothing changes; just outside the robot does something else somewhere.
TEST(WhileOthersStay, EndsWhereThePolicyChanges) {
  const std::string file = std::string{KITH_SOURCE_DIR} + "/domains/item_delivery.toml";
  std::ifstream stream{file};
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  const auto& atlas = testing::atlas_of("item-delivery");
  const auto counts_with = [&](std::size_t k, double weight) {
    auto changed = text;
    const std::string from = k == 0 ? "rubble = -3.0" : "recharge = 3.5";
    const auto at = changed.find(from);
    changed.replace(at, from.size(), (k == 0 ? "rubble = " : "recharge = ") + std::to_string(weight));
    const Atlas other{parse_domain(changed, "changed").domain.value()};
    std::vector<IntegerVector> counts;
    for (StartIndex start{0}; start.value() < other.num_states(); ++start)
      counts.push_back(other.feature_counts(start));
    return counts;
  };
  const auto own = counts_with(0, -3.0);
  for (const std::size_t k : {0u, 1u}) {
    const auto same = while_others_stay(atlas.domain(), atlas.policy_bec_half_spaces(), k, 2);
    constexpr double kLittle = 0.01;
    ASSERT_TRUE(same.low || same.high);
    for (const auto& [end, outside] : {std::pair{same.low, -kLittle}, std::pair{same.high, kLittle}}) {
      if (!end) continue;
      EXPECT_EQ(counts_with(k, end->value() - outside), own) << k << " inside of " << end->value();
      EXPECT_NE(counts_with(k, end->value() + outside), own) << k << " outside of " << end->value();
    }
  }
}

}  // namespace
}  // namespace kith
