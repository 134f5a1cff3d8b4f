#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kith/core/index.hpp"
#include "kith/core/integer_vector.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

using HullIndex = Index<struct HullTag>;
using PolicyCellIndex = Index<struct PolicyCellTag>;

/// What a coverage set looks like from the robot's own path: the losses
/// mu_robot - v of its vertices v, and the weights for which it holds. Start
/// states with equal hulls are one and the same question to every learner.
struct Hull {
  Cone finite_region;
  std::vector<IntegerVector> losses;  ///< Sorted by loss under the robot's weights: ties favour the robot.
  friend bool operator==(const Hull&, const Hull&) = default;
};

/// Every reward weight's policy cell: weights lie in one cell iff they choose
/// the same vertex in every hull, so a cell is what can be told of a person's
/// belief by watching behaviour. Cells are found once, exactly, by splitting the sphere
/// along the planes on which some choice changes; a weight is located by
/// walking down that binary space partition, about log2(#cells) dot products.
class PolicyCells {
 public:
  /// What hull h does in a cell: the position in losses, or kNone where no finite optimum exists.
  using Choice = std::uint16_t;
  static constexpr Choice kNone = 0xFFFF;

  PolicyCells() = default;
  explicit PolicyCells(std::span<const Hull> hulls);

  [[nodiscard]] std::size_t size() const noexcept { return num_cells_; }
  [[nodiscard]] PolicyCellIndex locate(const Eigen::Vector3d& weights) const noexcept;
  /// The numbers of the cells of many points; faster than one by one, as several walk down together.
  /// @param x, y, z  of length n. @return shape [n].
  [[nodiscard]] std::vector<std::uint32_t> locate(std::span<const double> x, std::span<const double> y,
                                                  std::span<const double> z) const;
  [[nodiscard]] Choice choice(PolicyCellIndex cell, HullIndex hull) const {
    return choices_[cell.value() * num_hulls_ + hull.value()];
  }

 private:
  friend class PolicyCellBuilder;
  // A split (child[1] on the side where normal . w >= 0) or, with child[0] == kLeaf, a leaf with its cell.
  struct Node {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::uint32_t child[2] = {kLeaf, kLeaf};
    std::uint32_t cell = 0;
  };
  static constexpr std::uint32_t kLeaf = 0xFFFFFFFF;

  std::size_t num_hulls_ = 0;
  std::size_t num_cells_ = 0;
  std::vector<Node> nodes_;
  std::vector<Choice> choices_;  // row-major, shape [num_cells, num_hulls]
};

}  // namespace kith
