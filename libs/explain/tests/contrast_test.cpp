#include "kith/explain/contrast.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "atlases.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

using testing::atlas_of;

// What a path counts, action by action; a failure if it is none of the MDP's.
IntegerVector counts_of(const Domain& domain, MdpIndex world, const Trajectory& path) {
  const auto& mdp = domain.mdp(world);
  IntegerVector counts(domain.num_features());
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    bool found = false;
    for (const auto& choice : mdp.choices(path.states[t])) {
      if (choice.action != path.actions[t]) continue;
      found = true;
      counts += mdp.integer_features(mdp.outcomes(choice).front());
      EXPECT_EQ(mdp.outcomes(choice).front().next, path.states[t + 1]);
    }
    EXPECT_TRUE(found) << "step " << t;
  }
  EXPECT_TRUE(mdp.is_terminal(path.states.back()));
  return counts;
}

TEST(ContrastWith, FollowsTheRobotAsLongAsItCanAndThenEndsAsTheVertexSays) {
  for (const auto& name : testing::kSmallDomains) {
    const auto& atlas = atlas_of(name);
    for (std::size_t d = 0; d < atlas.num_states(); d += 37) {
      const StartIndex start{d};
      for (const auto& vertex : atlas.tables().coverage_set(start)) {
        if (vertex == atlas.feature_counts(start)) continue;
        const auto contrast = contrast_with(atlas, start, 0, vertex);
        const auto world = atlas.id(start).mdp;
        EXPECT_EQ(counts_of(atlas.domain(), world, contrast.alternative), vertex);
        EXPECT_EQ(contrast.alternative_counts, vertex);
        EXPECT_EQ(counts_of(atlas.domain(), world, contrast.robot), contrast.robot_counts);
        ASSERT_LT(contrast.decisive, contrast.robot.actions.size());
        for (std::size_t t = 0; t < contrast.decisive; ++t) {
          EXPECT_EQ(contrast.robot.actions[t], contrast.alternative.actions[t]);
        }
        EXPECT_NE(contrast.robot.actions[contrast.decisive], contrast.alternative.actions[contrast.decisive]);
      }
    }
  }
}

TEST(ContrastWith, RefusesTheRobotsOwnPathAndVectorsOfNobody) {
  const auto& atlas = atlas_of("item-delivery");
  const StartIndex start{0};
  EXPECT_THROW(static_cast<void>(contrast_with(atlas, start, 0, atlas.feature_counts(start))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(contrast_with(atlas, start, 0, {9, 9, 9})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(contrast_with(atlas, start, 999, atlas.feature_counts(start))), std::invalid_argument);
}

TEST(ContrastFor, ConveysTheConstraint) {
  const auto& atlas = atlas_of("item-delivery");
  std::size_t found = 0;
  for (std::size_t d = 0; d < atlas.num_states(); d += 53) {
    for (const auto c : atlas.tables().robot_cell_facets(StartIndex{d}).members()) {
      const auto& constraint = atlas.constraints()[c];
      const auto contrast = contrast_for(atlas, StartIndex{d}, constraint);
      if (!contrast) continue;
      ++found;
      EXPECT_EQ(constraint_of(contrast->robot_counts, contrast->alternative_counts), constraint);
    }
  }
  EXPECT_GT(found, 20u);
}

// One other action at the decisive step, and the robot's own way before and after it.
void expect_one_other_action(const Atlas& atlas, const Contrast& contrast) {
  const auto world = atlas.id(contrast.start).mdp;
  const auto& mdp = atlas.domain().mdp(world);
  const auto& states = contrast.alternative.states;
  const auto& actions = contrast.alternative.actions;
  const auto t = contrast.decisive;
  EXPECT_EQ(contrast.robot, atlas.trajectory(contrast.start));
  ASSERT_LT(t, contrast.robot.actions.size());
  ASSERT_LT(t, actions.size());
  const auto parting = static_cast<std::ptrdiff_t>(t);
  EXPECT_TRUE(std::equal(actions.begin(), actions.begin() + parting, contrast.robot.actions.begin()));
  EXPECT_TRUE(std::equal(states.begin(), states.begin() + parting + 1, contrast.robot.states.begin()));
  EXPECT_NE(actions[t], contrast.robot.actions[t]);
  if (mdp.is_terminal(states[t + 1])) {
    EXPECT_EQ(states.size(), t + 2);
    return;
  }
  const auto rest = atlas.trajectory(atlas.index({world, states[t + 1]}));
  EXPECT_EQ((std::vector<StateIndex>{states.begin() + parting + 1, states.end()}), rest.states);
  EXPECT_EQ((std::vector<ActionIndex>{actions.begin() + parting + 1, actions.end()}), rest.actions);
}

// The first step of the robot's path at which one other action conveys the constraint, if any.
std::optional<std::size_t> first_step_that_conveys(const Atlas& atlas, StartIndex start, const HalfSpace& constraint) {
  const auto path = atlas.path(start);
  for (std::size_t t = 0; t < path.size(); ++t) {
    const auto [world, s] = atlas.id(path[t]);
    for (std::size_t c = 0; c < atlas.domain().mdp(world).choices(s).size(); ++c) {
      const auto loss = atlas.feature_counts(path[t]) - atlas.deviation_counts(path[t], c);
      if (preference_of_robot(atlas.domain(), loss) == constraint) return t;
    }
  }
  return std::nullopt;
}

void expect_contrast_without_tables(const Atlas& atlas, StartIndex start, const HalfSpace& constraint) {
  const auto& domain = atlas.domain();
  const auto contrast = contrast_for(atlas, start, constraint);
  ASSERT_TRUE(contrast.has_value());
  EXPECT_EQ(contrast->start, start);
  EXPECT_EQ(conveyed_by(domain, *contrast), constraint);
  EXPECT_EQ(contrast->decisive, first_step_that_conveys(atlas, start, constraint));
  expect_one_other_action(atlas, *contrast);
  const auto said = reason(atlas, *contrast);
  EXPECT_TRUE(said.ends_with(told(domain, constraint))) << said;
  if (!domain.is_exact()) return;
  EXPECT_EQ(counts_of(domain, atlas.id(start).mdp, contrast->alternative), contrast->alternative_counts);
}

// Every constraint of a demonstration, which is a comparison with one other action. Returns how many there were.
std::size_t expect_contrasts_without_tables(const Atlas& atlas, std::size_t stride) {
  EXPECT_FALSE(atlas.find_tables());
  std::size_t tried = 0;
  for (std::size_t d = 0; d < atlas.num_states(); d += stride) {
    if (!atlas.is_candidate(StartIndex{d})) continue;
    for (const auto& constraint : atlas.constraints().half_spaces(atlas.one_step(StartIndex{d}))) {
      expect_contrast_without_tables(atlas, StartIndex{d}, constraint);
      ++tried;
    }
  }
  return tried;
}

TEST(ContrastFor, ComparesWithOneOtherActionWhereThereAreNoTables) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  EXPECT_GT(expect_contrasts_without_tables(atlas, 97), 100u);
}

TEST(ContrastFor, WorksWithSevenFeaturesWithChanceAndWithoutAMap) {
  for (const auto& name : testing::domains_without_tables()) {
    SCOPED_TRACE(name);
    EXPECT_GT(expect_contrasts_without_tables(atlas_of(name), name == "navigation" ? 211 : 1), 20u);
  }
}

TEST(ContrastFor, IsNothingWhereNoOtherActionConveysTheConstraint) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  for (std::size_t d = 0; d < atlas.num_states(); d += 997) {
    EXPECT_FALSE(contrast_for(atlas, StartIndex{d}, HalfSpace{IntegerVector{-100, 0, 299}}).has_value());
  }
}

TEST(ContrastFor, ComparesWithOneOtherActionWhereNobodyExpectsSuch) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  Behaviours behaviours{atlas};
  const StartIndex start{5000};
  for (const auto& constraint : atlas.constraints().half_spaces(atlas.one_step(start))) {
    const auto alone = contrast_for(atlas, start, constraint);
    const auto contrast = contrast_for(behaviours, start, constraint, {});
    ASSERT_TRUE(alone && contrast);
    EXPECT_EQ(contrast->alternative, alone->alternative);
  }
}

// Four features; the only paths past the people are longer ones, too.
TEST(Question, IsNeverAnsweredWithADetour) {
  for (const auto& name : testing::kSmallDomains) {
    const auto& atlas = atlas_of(name);
    const auto& domain = atlas.domain();
    for (const auto& feature : domain.feature_names()) {
      for (const std::string form : {"why ", "why not ", "when "}) {
        for (const auto& example : answer_question(atlas, form + feature).examples) {
          EXPECT_EQ(example.text.find(" not cross rubble and "), std::string::npos) << example.text;
          if (example.text.find("would rather") == std::string::npos) continue;
          ASSERT_TRUE(example.alternative.has_value());
          // "A than B" compares costs or gains of both ways.
          if (example.text.find(" than ") == std::string::npos) continue;
          Contrast contrast;
          contrast.robot_counts = counts_of(domain, atlas.id(example.start).mdp, example.path);
          contrast.alternative_counts = counts_of(domain, atlas.id(example.start).mdp, *example.alternative);
          const auto more = contrast.alternative_counts - contrast.robot_counts;
          const auto differing = std::count_if(more.begin(), more.end(), [](auto n) { return n != 0; });
          EXPECT_TRUE(differing == 1 || !is_detour(domain, contrast)) << example.text;
        }
      }
    }
  }
}

TEST(IsDetour, HasNothingInItsFavour) {
  const auto& domain = atlas_of("item-delivery").domain();
  const auto with = [](const IntegerVector& robot, const IntegerVector& alternative) {
    Contrast contrast;
    contrast.robot_counts = robot;
    contrast.alternative_counts = alternative;
    return contrast;
  };
  EXPECT_TRUE(is_detour(domain, with({0, 0, 5}, {1, 0, 7})));
  EXPECT_TRUE(is_detour(domain, with({0, 1, 5}, {0, 0, 7})));
  EXPECT_FALSE(is_detour(domain, with({0, 0, 7}, {1, 0, 5}))) << "it saves steps";
  EXPECT_FALSE(is_detour(domain, with({0, 0, 5}, {0, 1, 9}))) << "it gains the charger";
}

TEST(Reason, RefusesContrastsThatTellNothing) {
  const auto& icy = atlas_of(testing::domains_without_tables()[1]);
  Contrast same;
  same.robot_counts = icy.feature_counts(StartIndex{0});
  same.alternative_counts = same.robot_counts;
  EXPECT_FALSE(conveyed_by(icy.domain(), same).has_value());
  EXPECT_THROW(static_cast<void>(reason(icy, same)), std::invalid_argument);
  same.robot_counts = same.alternative_counts = {1, 0, 2};
  EXPECT_THROW(static_cast<void>(reason(atlas_of("item-delivery"), same)), std::invalid_argument);
}

TEST(SameStart, KeepsRobotAndItemsAndTakesWhatTheWorldHas) {
  const auto& atlas = atlas_of("item-delivery");
  const auto& domain = atlas.domain();
  const auto all = atlas.index({MdpIndex{63}, domain.initial_state(MdpIndex{63})});
  const auto bare = same_start(atlas, all, MdpIndex{0});
  ASSERT_TRUE(bare.has_value());
  EXPECT_EQ(atlas.id(*bare).start, domain.initial_state(MdpIndex{0}));
  const auto back = same_start(atlas, *bare, MdpIndex{63});
  EXPECT_EQ(back, all);
}

TEST(SameStart, DoesNotExistWhereTheCarriedThingDoesNot) {
  const auto& atlas = atlas_of("skateboard");
  const auto& domain = atlas.domain();
  const MdpIndex with_board{domain.num_mdps() - 1};
  ASSERT_EQ(domain.map()->items_in(with_board).size(), 1u);
  MdpIndex without_board{with_board.value() ^ 1u};
  ASSERT_TRUE(domain.map()->items_in(without_board).empty());
  for (StateIndex s{0}; s.value() < domain.mdp(with_board).num_states(); ++s) {
    const auto there = same_start(atlas, atlas.index({with_board, s}), without_board);
    if (domain.map()->state(with_board, s).carried.front()) {
      EXPECT_FALSE(there.has_value());
    }
  }
}

TEST(DifferenceInWords, NamesThingsAndCells) {
  const auto domain = load_domain("item-delivery");
  EXPECT_EQ(difference_in_words(domain, MdpIndex{0}, std::vector<std::size_t>{0}), "without the rubble at (3,1)");
  EXPECT_EQ(difference_in_words(domain, MdpIndex{63}, std::vector<std::size_t>{0, 5}),
            "with the rubble at (3,1) and the charger at (4,1)");
  const auto board = load_domain("skateboard");
  EXPECT_EQ(difference_in_words(board, MdpIndex{0}, std::vector<std::size_t>{0}),
            "without the path from (1,4) to (4,4)");
}

}  // namespace
}  // namespace kith
