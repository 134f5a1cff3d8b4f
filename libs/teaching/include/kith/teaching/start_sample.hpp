#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/belief/particle_belief.hpp"

namespace kith {

/// Some starts of a knowledge component, each with the half-spaces of the weights under which people predict the robot
/// right there: Atlas::tested_constraints(). With tables that is exact for weights with a finite optimum. Elsewhere
/// they are the constraints that the robot's path shows: who satisfies them agrees with the robot about every single
/// step, but may see a better path where two steps differ and no comparison of whole paths tells. Without a finite
/// optimum people are wrong: it is an upper bound.
///
/// Nothing is planned: grading a belief takes one product per particle and half-space. Immutable.
class StartSample {
 public:
  /// At most 60 candidate starts of the component, each as likely as any other; the same in every run.
  [[nodiscard]] static StartSample spread_over_starts(const Atlas& atlas, std::size_t component);
  /// For every facet of the component's region at most 6 of the starts that test it, the facets weighing the same; the
  /// same in every run.
  [[nodiscard]] static StartSample spread_over_facets(const Atlas& atlas, std::size_t component);

  [[nodiscard]] std::size_t size() const noexcept { return starts_.size(); }
  [[nodiscard]] StartIndex start(std::size_t i) const { return starts_[i].index; }
  /// Of a start; they sum to 1.
  [[nodiscard]] double weight(std::size_t i) const { return starts_[i].weight; }

  /// Per point the share of the starts that people with these weights predict right, in [0, 1]; 1 without starts.
  /// @param axes  the points, shape [d][n].
  [[nodiscard]] std::vector<double> share_right(std::span<const std::span<const double>> axes) const;
  /// Per start the probability that somebody with this belief predicts the robot right, shape [size()].
  [[nodiscard]] std::vector<double> probabilities_right(const ParticleBelief& belief) const;
  /// The expected share right under a belief.
  [[nodiscard]] double share_right(const ParticleBelief& belief) const;

 private:
  struct Start {
    StartIndex index;
    double weight = 0.0;
    std::vector<std::uint32_t> cell;  // positions in half_spaces_
  };
  StartSample() = default;
  [[nodiscard]] std::vector<std::vector<char>> misses(std::span<const std::span<const double>> axes) const;
  void add(const Atlas& atlas, StartIndex start_index, double weight);
  void finish(const Atlas& atlas);

  std::vector<Start> starts_;
  std::vector<ConstraintIndex> constraints_;  // while it is made
  std::vector<HalfSpace> half_spaces_;        // each once
};

}  // namespace kith
