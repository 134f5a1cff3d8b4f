#include "kith/explain/target.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "atlases.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/variation.hpp"
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
      const auto rank = [&](StartIndex demo) {
        return std::pair{atlas.domain().complexity(atlas.id(demo)), atlas.trajectory(demo).actions.size()};
      };
      for (StartIndex demo{0}; demo.value() < atlas.num_states(); ++demo) {
        if (!same_weights(atlas, atlas.constraints().half_spaces(atlas.one_step(demo)), {isolated.constraint}))
          continue;
        ++n;
        if (!best || rank(demo) < rank(*best)) best = demo;
      }
      EXPECT_EQ(n, isolated.teaching);
      EXPECT_EQ(simplest_isolating(atlas, isolated.constraint, Purpose::kTeach), best);
      if (best) {
        EXPECT_TRUE(isolates(atlas, *best, isolated.constraint, Purpose::kTeach));
      }
    }
  }
}

TEST(SimplestIsolating, FindsTestsThatDiscriminateTheConstraintAlone) {
  const auto& atlas = atlas_of("item-delivery");
  std::size_t tests = 0;
  for (const auto& isolated : isolated_constraints(atlas)) {
    const auto demo = simplest_isolating(atlas, isolated.constraint, Purpose::kTest);
    EXPECT_EQ(demo.has_value(), isolated.testing > 0);
    if (!demo) continue;
    ++tests;
    EXPECT_TRUE(same_weights(atlas, atlas.constraints().half_spaces(atlas.tables().robot_cell_facets(*demo)),
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

// Item delivery in a room without rubble and charger, which nothing can be taught about.
std::string empty_room() {
  const auto& built_in = built_in_domains();
  const auto text =
      std::find_if(built_in.begin(), built_in.end(), [](const auto& one) { return one.name == "item-delivery"; })->text;
  return with_one_map(text, "empty-room", {"#...", "#...", "G..S"}).value();
}

TEST(MakeWorld, ChangesFewCellsUntilOneConstraintIsLeft) {
  const auto text = empty_room();
  const Atlas atlas{parse_domain(text, "empty-room").domain.value()};
  const HalfSpace constraint{IntegerVector{-1, 0, 2}};
  ASSERT_FALSE(simplest_isolating(atlas, constraint, Purpose::kTeach).has_value());
  const auto made = make_world(atlas, text, constraint, Purpose::kTeach);
  ASSERT_TRUE(made.has_value());
  ASSERT_EQ(made->changes.size(), 1u) << "one heap of rubble is enough";
  EXPECT_EQ(made->changes[0].to, 'r');
  EXPECT_TRUE(isolates(made->atlas, made->demo, constraint, Purpose::kTeach));
  EXPECT_EQ(made->atlas.domain().num_mdps(), 1u);
  EXPECT_LE(made->changes.size(), 2u);
  // The text is the world, and the changes are what differs.
  const auto reading = parse_domain(made->text, "made");
  ASSERT_TRUE(reading.domain.has_value());
  auto rows = atlas.domain().map()->draw(made->base, std::nullopt);
  for (const auto& change : made->changes) {
    char& symbol =
        rows[rows.size() - static_cast<std::size_t>(change.cell.y)][static_cast<std::size_t>(change.cell.x - 1)];
    EXPECT_EQ(symbol, change.from);
    symbol = change.to;
    EXPECT_NE(change_in_words(*atlas.domain().map(), change).find(" becomes "), std::string::npos);
  }
  EXPECT_EQ(reading.domain->map()->draw(MdpIndex{0}, std::nullopt), rows);
}

TEST(MakeWorld, IsNothingWithoutAMapAndWhereCountsAreExpectations) {
  const auto& icy = atlas_of(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  EXPECT_FALSE(can_make_worlds(icy.domain()));
  EXPECT_FALSE(make_world(icy, "", HalfSpace{IntegerVector{-1, 0, 2}}, Purpose::kTeach).has_value());
  auto text = empty_room();
  const auto line = text.find("discount");
  ASSERT_NE(line, std::string::npos);
  text.replace(line, text.find('\n', line) - line, "discount = 0.95");
  const Atlas atlas{parse_domain(text, "discounted").domain.value()};
  EXPECT_FALSE(can_make_worlds(atlas.domain()));
  EXPECT_FALSE(make_world(atlas, text, HalfSpace{IntegerVector{-1, 0, 2}}, Purpose::kTeach).has_value());
  EXPECT_TRUE(can_make_worlds(atlas_of("item-delivery").domain()));
}

TEST(MakeWorld, IsNothingWhereNoWorldWithinTheOptionsWillDo) {
  const auto text = empty_room();
  const Atlas atlas{parse_domain(text, "empty-room").domain.value()};
  MakeWorldOptions options;
  options.max_states = 2000;
  EXPECT_FALSE(make_world(atlas, text, HalfSpace{IntegerVector{-100, 0, 299}}, Purpose::kTeach, options).has_value());
  options.max_changes = 0;
  EXPECT_THROW(static_cast<void>(make_world(atlas, text, HalfSpace{IntegerVector{-2, 0, 5}}, Purpose::kTeach, options)),
               std::invalid_argument);
}

}  // namespace
}  // namespace kith
