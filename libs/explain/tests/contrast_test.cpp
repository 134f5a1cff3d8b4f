#include "kith/explain/contrast.hpp"

#include <gtest/gtest.h>

#include "atlases.hpp"
#include "kith/explain/reason.hpp"

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
    for (std::size_t d = 0; d < atlas.num_demos(); d += 37) {
      const DemoIndex demo{d};
      for (const auto& vertex : atlas.coverage_set(demo)) {
        if (vertex == atlas.feature_counts(demo)) continue;
        const auto contrast = contrast_with(atlas, demo, 0, vertex);
        const auto world = atlas.id(demo).mdp;
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
  const DemoIndex demo{0};
  EXPECT_THROW(static_cast<void>(contrast_with(atlas, demo, 0, atlas.feature_counts(demo))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(contrast_with(atlas, demo, 0, {9, 9, 9})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(contrast_with(atlas, demo, 999, atlas.feature_counts(demo))), std::invalid_argument);
}

TEST(ContrastFor, ConveysTheConstraint) {
  const auto& atlas = atlas_of("item-delivery");
  std::size_t found = 0;
  for (std::size_t d = 0; d < atlas.num_demos(); d += 53) {
    for (const auto c : atlas.robot_cell_facets(DemoIndex{d}).members()) {
      const auto& constraint = atlas.constraints()[c];
      const auto contrast = contrast_for(atlas, DemoIndex{d}, constraint);
      if (!contrast) continue;
      ++found;
      EXPECT_EQ(constraint_of(contrast->robot_counts, contrast->alternative_counts), constraint);
    }
  }
  EXPECT_GT(found, 20u);
}

// The robot of one world, planned anew.
class Planned {
 public:
  Planned(const Domain& domain, MdpIndex world)
      : mdp_{domain.mdp(world)},
        weights_{domain.weights().integer},
        values_{plan_exactly(mdp_, weights_).solution.value().values} {}

  [[nodiscard]] std::optional<StateIndex> next(StateIndex s, ActionIndex a) const {
    const auto outcome = outcome_of(s, a);
    return outcome ? std::optional{outcome->next} : std::nullopt;
  }
  [[nodiscard]] bool is_best(StateIndex s, ActionIndex a) const {
    const auto outcome = outcome_of(s, a);
    return outcome &&
           dot(weights_, mdp_.integer_features(*outcome)) + values_[outcome->next.value()] == values_[s.value()];
  }
  // Whether the robot decides there as the alternative does, after the same steps, and not as the robot here.
  [[nodiscard]] bool flips(StateIndex start, const Contrast& contrast) const {
    auto s = start;
    for (std::size_t t = 0; t < contrast.decisive; ++t) {
      if (!is_best(s, contrast.robot.actions[t])) return false;
      s = next(s, contrast.robot.actions[t]).value();
    }
    return is_best(s, contrast.alternative.actions[contrast.decisive]) &&
           !is_best(s, contrast.robot.actions[contrast.decisive]);
  }

 private:
  [[nodiscard]] std::optional<Outcome> outcome_of(StateIndex s, ActionIndex a) const {
    if (mdp_.is_terminal(s)) return std::nullopt;
    for (const auto& choice : mdp_.choices(s)) {
      if (choice.action == a) return mdp_.outcomes(choice).front();
    }
    return std::nullopt;
  }

  const Mdp& mdp_;
  const IntegerVector& weights_;
  std::vector<std::int64_t> values_;
};

void expect_flips(const Atlas& atlas, const Contrast& contrast, const Flip& flip) {
  const auto& domain = atlas.domain();
  const auto [here, start_here] = atlas.id(contrast.demo);
  const auto [there, start_there] = atlas.id(flip.demo);
  EXPECT_NE(here, there);
  EXPECT_EQ(domain.state(here, start_here).robot, domain.state(there, start_there).robot);
  const Planned planned{domain, there};
  EXPECT_TRUE(planned.flips(start_there, contrast));
  ASSERT_LT(contrast.decisive, flip.robot.actions.size());
  for (std::size_t t = 0; t < flip.robot.actions.size(); ++t) {
    EXPECT_TRUE(planned.is_best(flip.robot.states[t], flip.robot.actions[t])) << t;
  }
  for (std::size_t t = 0; t < contrast.decisive; ++t) EXPECT_EQ(flip.robot.actions[t], contrast.robot.actions[t]);
  EXPECT_EQ(domain.state(there, flip.robot.states[contrast.decisive]).robot,
            domain.state(here, contrast.robot.states[contrast.decisive]).robot);
  EXPECT_EQ(flip.robot.actions[contrast.decisive], contrast.alternative.actions[contrast.decisive]);
  EXPECT_EQ(toggled_groups(domain, here, there), flip.toggled);
}

TEST(NearestFlip, ReallyFlipsAndNoNearerWorldDoes) {
  for (const auto& name : testing::kSmallDomains) {
    const auto& atlas = atlas_of(name);
    const auto& domain = atlas.domain();
    std::size_t flips = 0;
    for (std::size_t d = 0; d < atlas.num_demos(); d += 61) {
      const auto contrast = best_contrast(atlas, DemoIndex{d}, [](const Contrast&) { return true; });
      if (!contrast) continue;
      const auto flip = nearest_flip(atlas, *contrast);
      const auto here = atlas.id(contrast->demo).mdp;
      if (flip) {
        ++flips;
        expect_flips(atlas, *contrast, *flip);
      }
      for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
        const auto distance = toggled_groups(domain, here, m).size();
        if (m == here || (flip && distance >= flip->toggled.size())) continue;
        const auto start = same_start(atlas, contrast->demo, m);
        EXPECT_FALSE(start && Planned(domain, m).flips(atlas.id(*start).start, *contrast)) << name << " " << d;
      }
    }
    EXPECT_GT(flips, 0u) << name;
  }
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
  ASSERT_EQ(domain.items_in(with_board).size(), 1u);
  MdpIndex without_board{with_board.value() ^ 1u};
  ASSERT_TRUE(domain.items_in(without_board).empty());
  for (StateIndex s{0}; s.value() < domain.mdp(with_board).num_states(); ++s) {
    const auto there = same_start(atlas, atlas.index({with_board, s}), without_board);
    if (domain.state(with_board, s).carried.front()) {
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
