#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "kith/bec/state_action_cover.hpp"
#include "kith/random/distributions.hpp"

namespace kith::testing {

/// A grid world without an end as in [brown2019machine]: 9 x 9 cells, each with one of eight features that counts in
/// every step that leaves the cell, four directions, a discount of 0.95.
struct RandomGridWorld {
  static constexpr std::size_t kSide = 9;
  static constexpr std::size_t kCells = kSide * kSide;
  static constexpr std::size_t kFeatures = 8;

  Mdp mdp;
  std::vector<double> weights;    ///< Uniform among those whose sizes add up to 1.
  std::vector<StateIndex> cells;  ///< Every cell once.
};

/// Walking into the border leaves one where one is. An Mdp has no such choice, so each border cell has a twin with the
/// same feature, to which one goes instead and from which everything goes on as from the cell itself.
[[nodiscard]] inline RandomGridWorld random_grid_world(RandomStream random) {
  constexpr auto kSide = RandomGridWorld::kSide;
  constexpr auto kCells = RandomGridWorld::kCells;
  std::array<std::size_t, kCells> feature{}, twin{};
  std::vector<std::size_t> states(kCells);  // the cell of every state
  std::iota(states.begin(), states.end(), std::size_t{0});
  for (std::size_t s = 0; s < kCells; ++s) {
    feature[s] = uniform_index(RandomGridWorld::kFeatures, random);
    const bool is_border = s % kSide == 0 || s % kSide == kSide - 1 || s < kSide || s >= kCells - kSide;
    twin[s] = is_border ? states.size() : s;
    if (is_border) states.push_back(s);
  }
  MdpBuilder builder{states.size(), 0, 4, RandomGridWorld::kFeatures, 0.95};
  for (std::size_t state = 0; state < states.size(); ++state) {
    const auto s = states[state];
    const auto x = s % kSide;
    const auto stay = state == s ? twin[s] : s;
    const std::array<std::size_t, 4> next{s >= kSide ? s - kSide : stay, s + kSide < kCells ? s + kSide : stay,
                                          x > 0 ? s - 1 : stay, x + 1 < kSide ? s + 1 : stay};
    std::vector<double> features(RandomGridWorld::kFeatures, 0.0);
    features[feature[s]] = 1.0;
    for (std::size_t a = 0; a < next.size(); ++a) {
      const std::vector<MdpBuilder::Transition> way{{StateIndex{next[a]}, 1.0, features}};
      builder.add_choice(StateIndex{state}, ActionIndex{a}, way);
    }
  }
  RandomGridWorld world{std::move(builder).build(), {}, {}};
  double sum = 0.0;
  for (std::size_t k = 0; k < RandomGridWorld::kFeatures; ++k) {
    const double size = -std::log1p(-uniform01(random));
    world.weights.push_back(uniform01(random) < 0.5 ? -size : size);
    sum += size;
  }
  for (auto& weight : world.weights) weight /= sum;
  for (StateIndex s{0}; s.value() < kCells; ++s) world.cells.push_back(s);
  return world;
}

/// Draws weights that satisfy half-spaces, uniformly among the directions: hit-and-run in the part of the unit ball
/// that satisfies them.
class ConsistentLearner {
 public:
  /// @param normals  unit vectors, shape [d, n].
  /// @param inside  weights that satisfy all of them, shape [d], where the walk begins.
  ConsistentLearner(Eigen::MatrixXd normals, Eigen::VectorXd inside)
      : normals_{std::move(normals)}, point_{std::move(inside)} {
    point_ *= 0.5 / point_.norm();
  }

  [[nodiscard]] std::vector<double> next(RandomStream& random) {
    constexpr int kSteps = 100;  // between draws
    for (int i = 0; i < kSteps; ++i) step(random);
    return {point_.data(), point_.data() + point_.size()};
  }

 private:
  void step(RandomStream& random) {
    Eigen::VectorXd direction(point_.size());
    for (auto& entry : direction) entry = standard_normal(random);
    direction.normalize();
    const double along = point_.dot(direction);
    const double reach = std::sqrt(std::max(0.0, along * along + 1.0 - point_.squaredNorm()));
    double from = -along - reach, to = -along + reach;
    const Eigen::VectorXd height = normals_.transpose() * point_;
    const Eigen::VectorXd slope = normals_.transpose() * direction;
    for (Eigen::Index i = 0; i < height.size(); ++i) {
      if (slope[i] > 0.0) from = std::max(from, -height[i] / slope[i]);
      if (slope[i] < 0.0) to = std::min(to, -height[i] / slope[i]);
    }
    if (to <= from) return;
    point_ += (from + (to - from) * uniform01(random)) * direction;
  }

  Eigen::MatrixXd normals_;
  Eigen::VectorXd point_;
};

/// The share of the cells where what a learner does is not optimal for the robot, in [0, 1].
[[nodiscard]] inline double share_wrong(const RandomGridWorld& world, const Behaviour& robot,
                                        const std::vector<double>& learner) {
  const auto behaviour = behave(world.mdp, learner);
  if (!behaviour) return 1.0;
  std::size_t wrong = 0;
  for (const auto s : world.cells) {
    wrong += is_optimal(world.mdp, robot, world.weights, s, behaviour->choice[s.value()]) ? 0U : 1U;
  }
  return static_cast<double>(wrong) / static_cast<double>(world.cells.size());
}

}  // namespace kith::testing
