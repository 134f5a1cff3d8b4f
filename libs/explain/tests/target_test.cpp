#include "kith/explain/target.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "atlases.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

using testing::atlas_of;

// Whether two sets leave the same weights of the prior, by implication both ways.
bool same_weights(const Atlas& atlas, const std::vector<HalfSpace>& a, const std::vector<HalfSpace>& b) {
  auto left = atlas.prior_cone();
  auto right = atlas.prior_cone();
  if (!left.clip(a) || !right.clip(b)) return false;
  return std::all_of(b.begin(), b.end(), [&](const HalfSpace& one) { return left.implies(one); }) &&
         std::all_of(a.begin(), a.end(), [&](const HalfSpace& one) { return right.implies(one); });
}

TEST(SimplestIsolating, IsTheSimplestOfAllThatConveyExactlyTheConstraint) {
  for (const auto* name : {"item-delivery", "skateboard"}) {
    const auto& atlas = atlas_of(name);
    for (const auto& isolated : isolated_constraints(atlas)) {
      SCOPED_TRACE(std::string{name} + ": " + described(atlas.domain(), isolated.constraint));
      std::size_t n = 0;
      std::optional<StartIndex> best;
      const auto rank = [&](StartIndex start) {
        return std::pair{atlas.domain().complexity(atlas.id(start)), atlas.trajectory(start).actions.size()};
      };
      for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
        if (!same_weights(atlas, atlas.constraints().half_spaces(atlas.one_step(start)), {isolated.constraint}))
          continue;
        ++n;
        if (!best || rank(start) < rank(*best)) best = start;
      }
      EXPECT_EQ(n, isolated.teaching);
      EXPECT_EQ(simplest_isolating(atlas, isolated.constraint, Purpose::kTeach), best);
    }
  }
}

TEST(SimplestIsolating, FindsTestsThatDiscriminateTheConstraintAlone) {
  const auto& atlas = atlas_of("item-delivery");
  std::size_t tests = 0;
  for (const auto& isolated : isolated_constraints(atlas)) {
    const auto start = simplest_isolating(atlas, isolated.constraint, Purpose::kTest);
    EXPECT_EQ(start.has_value(), isolated.testing > 0);
    if (!start) continue;
    ++tests;
    EXPECT_TRUE(same_weights(atlas, atlas.constraints().half_spaces(atlas.tables().robot_cell_facets(*start)),
                             {isolated.constraint}));
  }
  EXPECT_GT(tests, 0u);
}

TEST(IsolatedConstraints, HoldAtTheRobotsWeightsAndAreNotKnownBeforehand) {
  for (const auto& name : testing::kSmallDomains) {
    const auto& atlas = atlas_of(name);
    const auto all = isolated_constraints(atlas);
    EXPECT_FALSE(all.empty()) << name;
    for (const auto& one : all) {
      EXPECT_GE(sign_of_dot(one.constraint.normal(), atlas.domain().weights().integer), 0);
      EXPECT_FALSE(atlas.prior_cone().implies(one.constraint));
    }
  }
}

TEST(ParseConstraint, TakesNormalsAndSentences) {
  const auto& atlas = atlas_of("item-delivery");
  const HalfSpace two_steps{IntegerVector{-1, 0, 2}};
  for (const auto* text : {"(-1,0,2)", "-1, 0, 2", " -2 0 4 ", "crossing rubble costs more than 2 steps",
                           "Crossing rubble  costs more than 2 steps."}) {
    EXPECT_EQ(parse_constraint(atlas, text), two_steps) << text;
  }
}

std::string id_of(const Atlas& atlas, const std::string& text) {
  try {
    static_cast<void>(parse_constraint(atlas, text));
  } catch (const Error& error) {
    return error.diagnostics().front().id + (error.kind() == ErrorKind::kInfeasible ? " infeasible" : "");
  }
  return "none";
}

TEST(ParseConstraint, RefusesWhatIsNoneOrCannotBeTaught) {
  const auto& atlas = atlas_of("item-delivery");
  for (const auto* text : {"", "(1,2)", "(0,0,0)", "(1,2,3,4)", "(-1,0,x)", "(99999999999,0,1)", "rubble is bad"}) {
    EXPECT_EQ(id_of(atlas, text), "E1109") << text;
  }
  EXPECT_EQ(id_of(atlas, "(1,0,-2)"), "E1110 infeasible") << "contradicts the robot";
  EXPECT_EQ(id_of(atlas, "(0,0,-1)"), "E1110 infeasible") << "known beforehand";
}

}  // namespace
}  // namespace kith
