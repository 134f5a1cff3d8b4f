#include "kith/bec/state_action_cover.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "random_grid_world.hpp"

namespace kith {
namespace {

using testing::ConsistentLearner;
using testing::random_grid_world;
using testing::share_wrong;

Eigen::MatrixXd unit_columns(std::initializer_list<std::initializer_list<double>> columns) {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(columns.begin()->size()), static_cast<Eigen::Index>(columns.size()));
  Eigen::Index j = 0;
  for (const auto& column : columns) {
    Eigen::Index i = 0;
    for (const double entry : column) all(i++, j) = entry;
    all.col(j++).normalize();
  }
  return all;
}

TEST(IrredundantNormals, LeavesOutWhatTheOthersImply) {
  using Positions = std::vector<std::size_t>;
  EXPECT_EQ(irredundant_normals(unit_columns({{1, 0}, {1, 1}, {0, 1}})), (Positions{0, 2}));
  EXPECT_EQ(irredundant_normals(unit_columns({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, -1}})), (Positions{0, 1, 2, 3}));
  // The third is the sum of the first two; the last of all others.
  EXPECT_EQ(irredundant_normals(unit_columns({{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 1, 2}, {2, 3, 2}})),
            (Positions{0, 1, 3}));
  EXPECT_EQ(irredundant_normals(unit_columns({{1, 0}})), (Positions{0}));
}

// Random normals: what is left implies the rest, and each is needed. A point that violates only it shows that.
TEST(IrredundantNormals, KeepsTheConeWhole) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random{seed};
    const Eigen::Index d = 3 + static_cast<Eigen::Index>(seed % 6);
    Eigen::MatrixXd normals(d, 40);
    for (Eigen::Index j = 0; j < normals.cols(); ++j) {
      for (Eigen::Index i = 0; i < d; ++i) normals(i, j) = standard_normal(random);
      if (normals(0, j) < 0.0) normals.col(j) *= -1.0;  // so that the cone contains the first axis
      normals.col(j).normalize();
    }
    const auto kept = irredundant_normals(normals);
    ASSERT_FALSE(kept.empty());
    Eigen::MatrixXd facets(d, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      facets.col(static_cast<Eigen::Index>(i)) = normals.col(static_cast<Eigen::Index>(kept[i]));
    }
    ConsistentLearner learner{facets, Eigen::VectorXd::Unit(d, 0)};
    for (int draw = 0; draw < 200; ++draw) {
      const auto w = learner.next(random);
      const Eigen::Map<const Eigen::VectorXd> point{w.data(), d};
      EXPECT_GE((normals.transpose() * point).minCoeff(), -1e-9);
    }
    EXPECT_EQ(irredundant_normals(facets).size(), kept.size());
  }
}

TEST(StateActionCover, ShowsTheWholePolicyInFewStates) {
  std::size_t pairs = 0;
  constexpr std::uint64_t kWorlds = 4;
  for (std::uint64_t i = 0; i < kWorlds; ++i) {
    const auto world = random_grid_world(RandomStream{2019}.split(i));
    const auto cover = cover_state_actions(world.mdp, world.weights, world.cells);
    ASSERT_TRUE(cover.has_value());
    pairs += cover->states.size();
    const Eigen::Map<const Eigen::VectorXd> own{world.weights.data(), 8};
    EXPECT_GE((cover->facets.transpose() * own).minCoeff(), -1e-9);
    EXPECT_GE(cover->num_comparisons, static_cast<std::size_t>(cover->facets.cols()));
    // Every learner who agrees with what is shown does what the robot does.
    auto random = RandomStream{7}.split(i);
    ConsistentLearner learner{cover->conveyed, own};
    for (int draw = 0; draw < 10; ++draw) EXPECT_EQ(share_wrong(world, cover->robot, learner.next(random)), 0.0);
  }
  EXPECT_GT(pairs, 8 * kWorlds);  // every feature trades off against another somewhere
  EXPECT_LT(pairs, 40 * kWorlds);
}

TEST(StateActionCover, RefusesTerminalStates) {
  MdpBuilder builder{1, 1, 1, 2, 0.9};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, std::vector<MdpBuilder::Transition>{{StateIndex{1}, 1.0, {1, 0}}});
  const auto mdp = std::move(builder).build();
  const std::vector<double> weights{1.0, -1.0};
  const std::vector<StateIndex> terminal{StateIndex{1}}, start{StateIndex{0}};
  EXPECT_THROW(static_cast<void>(cover_state_actions(mdp, weights, terminal)), std::invalid_argument);
  const auto cover = cover_state_actions(mdp, weights, start);
  ASSERT_TRUE(cover.has_value());
  EXPECT_TRUE(cover->states.empty());  // there is nothing else to do
}

}  // namespace
}  // namespace kith
