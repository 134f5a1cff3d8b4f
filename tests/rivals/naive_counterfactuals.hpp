#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith::rivals {

/// The rival of the atlas: what demonstrations convey to people of given reward weights, by planning for each of
/// them in every MDP with value iteration.
class NaiveCounterfactuals {
 public:
  /// Plans the robot's paths, once. The atlas must outlive it, and is used for the numbering of
  /// demonstrations and the robot's paths only.
  explicit NaiveCounterfactuals(const Atlas& atlas);

  /// For every demonstration the normals of mu_robot(s_t) - mu_person(s_t), other than 0, over the states s_t of the
  /// robot's path and the persons that have a finite optimum in the MDP; sorted, each once.
  [[nodiscard]] std::vector<std::vector<HalfSpace>> conveyed(std::span<const Eigen::Vector3d> persons) const;

  /// Only plans for them, with value iteration, in every MDP; returns in how many (person, MDP) there is an optimum.
  [[nodiscard]] std::size_t plans(std::span<const Eigen::Vector3d> persons) const;

 private:
  // What the states of MDP m convey to a person, by state, from the one state on; nothing where behaviour is alike.
  void add_conveyed(MdpIndex m, const Eigen::Vector3d& weights, std::vector<std::vector<IntegerVector>>& by_demo) const;

  const Atlas& atlas_;
  std::vector<std::vector<StartIndex>> paths_;  // per demonstration, all states of the robot's path
};

}  // namespace kith::rivals
